// SPDX-License-Identifier: MIT
// Heights encoded in image colours, as in web maps: three bytes form one integer
//
//   n = red * 65536 + green * 256 + blue,   0 <= n < 2^24
//
//   terrain-rgb   height = n / 10 - 10000 m      -10000 to 1667721.5 m in steps of 0.1 m
//   terrarium     height = n / 256 - 32768 m     -32768 to 32768 m in steps of 1/256 m
//
// The colours themselves must never be interpolated: there is no height between red 1, green 0 and red 0, green 255.
// Samples are decoded to integers here, which float32 represents exactly, and the field interpolates between these
// integers.
//
// Source: Mapbox, "Mapbox Terrain-RGB v1"; Mapzen, "Terrain tiles", formats, terrarium.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace scarp {

enum class HeightEncoding : std::uint8_t { none, terrain_rgb, terrarium };

/// Returns "none", "terrain-rgb" or "terrarium".
std::string_view name_of(HeightEncoding encoding);
/// Returns the encoding with that name, or nullopt.
std::optional<HeightEncoding> height_encoding(std::string_view name);

/// Height in metres = n * scale + offset.
struct EncodingScale {
  double scale;
  double offset;
};
EncodingScale scale_of(HeightEncoding encoding);

/// Writes n of `count` pixels to `out`. A pixel is `bands` bytes (3 or 4): red, green, blue and, for 4, alpha; alpha 0
/// gives NaN, a hole.
void decode_rgb(const std::uint8_t* pixels, std::size_t count, int bands, float* out);

}  // namespace scarp
