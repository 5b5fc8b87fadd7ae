// SPDX-License-Identifier: MIT
// Any bytes as the beginning of a .npy file: understood, or refused with an Error.
#include "scarp/source/npy_header.h"

#include <cstdlib>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const scarp::NpyHeader header = scarp::parse_npy_header(bytes);
    if (header.data_begin != scarp::npy_data_begin(bytes.substr(0, scarp::kNpyPreambleBytes))) std::abort();
    if (header.data_begin < 0 || header.data_begin > static_cast<std::int64_t>(size)) std::abort();
    for (const std::int64_t extent : header.shape) {
      if (extent < 0) std::abort();
    }
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_message(error);
  }
  return 0;
}
