// SPDX-License-Identifier: MIT
// What a subcommand prints when it refuses its input.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "cli/program.h"

namespace scarp::test {

/// One line on stderr that contains the fragment, nothing on stdout, and the status of a failure or of wrong usage.
inline void expect_refused(const Result& result, const std::string& fragment) {
  EXPECT_TRUE(result.status == 1 || result.status == 2) << result.status;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(lines(result.err), 1) << result.err;
  EXPECT_EQ(result.err.find("scarp: error: "), 0u) << result.err;
  EXPECT_NE(result.err.find(fragment), std::string::npos) << "'" << fragment << "' is not in: " << result.err;
}

/// The same of a call, which leaves the folder as it was.
inline void expect_refused(const Scratch& scratch, const Names& arguments, const std::string& fragment) {
  const Names before = scratch.files();
  expect_refused(run(arguments), fragment);
  EXPECT_EQ(scratch.files(), before) << fragment;
}

}  // namespace scarp::test
