// SPDX-License-Identifier: MIT
// Any bytes as a binvox file: voxels that survive a round trip, or an Error of one line.
#include "scarp/source/voxel/binvox.h"

#include <string>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"

namespace {

using scarp::fuzz::require;

void parse(std::string_view bytes) {
  try {
    const scarp::Binvox binvox = scarp::parse_binvox(bytes);
    require(scarp::parse_binvox(scarp::binvox_bytes(binvox)) == binvox);
    for (int axis = 0; axis < 3; ++axis)
      require(binvox.size[axis] >= 1 && binvox.size[axis] <= scarp::Binvox::kMaxSide);
    require(binvox.bits.size() <= bytes.size() * 2 + 1);  // a pair of bytes encodes 255 voxels at most
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_line(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  parse(bytes);
  // A valid header is hard to guess.
  if (size >= 3) {
    const auto side = [&](std::size_t i) { return std::to_string(1 + data[i] % 24); };
    parse("#binvox 1\ndim " + side(0) + " " + side(1) + " " + side(2) + "\ntranslate 0 0 0\nscale 1\ndata\n" +
          std::string(bytes.substr(3)));
  }
  return 0;
}
