// SPDX-License-Identifier: MIT
// `scarp replay` from outside.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.h"

namespace scarp {
namespace {

using test::run;

const std::string kField = "scarp-rays 1\nfield float32 3 2\nrow 0 4 0\nrow 0 4 0\n";

TEST(Replay, ComparesAllMarches) {
  const test::Scratch scratch;
  const std::string file =
      scratch.write("rays.txt", kField +
                                    "ray\norigin -1 0.5 3\ndirection 1 0 0\nrange 0 9\nexpected a hit\nanswered miss\n"
                                    "ray\norigin 1 0.5 9\ndirection 0 0 0x1p+0\n");
  const auto result = run({"replay", file});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const std::string part :
       {"ray 1 over 3 x 2 samples of float32", "expected: a hit", "answered: miss",
        "exhaustive      exact         hit     1.75 ", "max-mip         exact         hit     1.75 ", "naive",
        "relaxed", "max-mip-bisect", "ray 2 over", "miss"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " is not in:\n" << result.out;
  }
}

TEST(Replay, ReportsBadInputInOneLine) {
  const test::Scratch scratch;
  const auto expect_refused = [&](const std::string& text, const std::string& fragment) {
    const auto result = run({"replay", scratch.write("rays.txt", text)});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
  };
  expect_refused("", "line 1: the first line must be");
  expect_refused(kField, "there is no ray in it");
  expect_refused(kField + "ray\norigin 1 2 east\n", "line 6: origin 'east' is no number");
  expect_refused(kField + "ray\ndirection 0 0 0\n", "ray: its direction is zero");
  expect_refused("scarp-rays 1\nfield float32 3000000 3000000\nray\n", "0 of 3000000 rows");
  EXPECT_EQ(run({"replay", scratch.path("none.txt")}).status, 1);
  EXPECT_NE(run({"replay", scratch.path("")}).err.find("is a directory"), std::string::npos);
  EXPECT_EQ(run({"replay"}).status, 2);
}

}  // namespace
}  // namespace scarp
