// SPDX-License-Identifier: MIT
// Shared by the fuzz targets. A target is one file that defines LLVMFuzzerTestOneInput() and aborts on errors;
// libFuzzer calls it with generated inputs, replay.cpp with those of test/fuzz/corpus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace scarp::fuzz {

inline void require(bool good) {
  if (!good) std::abort();
}

/// Aborts when the message is not one line.
inline void expect_line(const std::exception& error) {
  const std::string_view text = error.what();
  require(!text.empty() && text.find_first_of("\r\n") == std::string_view::npos);
}

/// Aborts when the message is empty. (Bytes of the input may be in it: the command line makes it one line.)
inline void expect_message(const std::exception& error) { require(!std::string_view(error.what()).empty()); }

}  // namespace scarp::fuzz
