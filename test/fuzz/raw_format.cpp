// SPDX-License-Identifier: MIT
// Any text as --raw: accepted values are in range and survive a round trip, the rest is rejected.
#include "scarp/source/raster/raw_format.h"

#include <cstdlib>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const scarp::RawFormat format = scarp::parse_raw_format(text);
    if (format.cols < 1 || format.rows < 1 || format.offset < 0) std::abort();
    if (format.bytes != 1 && format.bytes != 2 && format.bytes != 4 && format.bytes != 8) std::abort();
    const std::string own = scarp::text_of(format);
    if (scarp::text_of(scarp::parse_raw_format(own)) != own) std::abort();
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_message(error);
  }
  return 0;
}
