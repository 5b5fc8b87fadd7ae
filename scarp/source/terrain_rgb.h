// SPDX-License-Identifier: MIT
// Heights written into the colours of an image, as web maps pass them on: three bytes make one whole number
//
//   n = red * 65536 + green * 256 + blue,   0 <= n < 2^24
//
//   terrain-rgb   height = n / 10 - 10000 m      -10000 to 1667721.5 m in steps of 0.1 m
//   terrarium     height = n / 256 - 32768 m     -32768 to 32768 m in steps of 1/256 m
//
// The colours themselves must never be interpolated: between red 1, green 0 and red 0, green 255 lies no height. So the
// samples become whole numbers here, which float32 holds exactly, and the field interpolates these.
//
// Source: Mapbox, "Mapbox Terrain-RGB v1"; Mapzen, "Terrain tiles", formats, terrarium.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace scarp {

enum class HeightEncoding : std::uint8_t { none, terrain_rgb, terrarium };

/// "none", "terrain-rgb" or "terrarium".
std::string_view name_of(HeightEncoding encoding);
/// The encoding of that name, or nothing.
std::optional<HeightEncoding> height_encoding(std::string_view name);

/// height in metres = n * scale + offset
struct EncodingScale {
  double scale;
  double offset;
};
EncodingScale scale_of(HeightEncoding encoding);

/// Writes n of `count` pixels to `out`. A pixel is `bands` bytes: red, green, blue and, where bands is 4, alpha; alpha
/// 0 gives NaN, a hole. `bands` must be 3 or 4.
void decode_rgb(const std::uint8_t* pixels, std::size_t count, int bands, float* out);

}  // namespace scarp
