// SPDX-License-Identifier: MIT
#include "scarp/source/raster/terrain_rgb.h"

#include <limits>

namespace scarp {
namespace {

struct Encoding {
  std::string_view name;
  EncodingScale scale;
};
constexpr Encoding kEncodings[] = {
    {"none", {1, 0}}, {"terrain-rgb", {0.1, -10000}}, {"terrarium", {1.0 / 256, -32768}}};

}  // namespace

std::string_view name_of(HeightEncoding encoding) { return kEncodings[static_cast<std::size_t>(encoding)].name; }

std::optional<HeightEncoding> height_encoding(std::string_view name) {
  for (const HeightEncoding e : {HeightEncoding::none, HeightEncoding::terrain_rgb, HeightEncoding::terrarium}) {
    if (name_of(e) == name) return e;
  }
  return {};
}

EncodingScale scale_of(HeightEncoding encoding) { return kEncodings[static_cast<std::size_t>(encoding)].scale; }

void decode_rgb(const std::uint8_t* pixels, std::size_t count, int bands, float* out) {
  for (std::size_t i = 0; i < count; ++i, pixels += bands) {
    const std::int32_t n = pixels[0] * 65536 + pixels[1] * 256 + pixels[2];
    out[i] = bands == 4 && pixels[3] == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(n);
  }
}

}  // namespace scarp
