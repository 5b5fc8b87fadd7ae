// SPDX-License-Identifier: MIT
// Any bytes as the beginning of a .npy file, and as the dictionary in it: parsed, or rejected with an Error.
#include "scarp/source/npy_header.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"

namespace {

void parse(std::string_view bytes) {
  try {
    const scarp::NpyHeader header = scarp::parse_npy_header(bytes);
    if (header.data_begin != scarp::npy_data_begin(bytes.substr(0, scarp::kNpyPreambleBytes))) std::abort();
    if (header.data_begin < 0 || header.data_begin > static_cast<std::int64_t>(bytes.size())) std::abort();
    for (const std::int64_t extent : header.shape) {
      if (extent < 0) std::abort();
    }
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_message(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  parse({reinterpret_cast<const char*>(data), size});
  // A valid length is hard to guess. The header ends at the end of its memory, so that reading a byte too many is
  // found.
  const std::string_view dictionary(reinterpret_cast<const char*>(data), std::min<std::size_t>(size, 0xffff));
  std::vector<char> file{'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0};
  file.push_back(static_cast<char>(dictionary.size() & 255));
  file.push_back(static_cast<char>(dictionary.size() >> 8));
  file.insert(file.end(), dictionary.begin(), dictionary.end());
  const std::vector<char> exact(file.begin(), file.end());
  parse({exact.data(), exact.size()});
  return 0;
}
