// SPDX-License-Identifier: MIT
// Colours for values. Colour arithmetic is in linear light; tables and pictures are sRGB.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "scarp/base/vec.h"
#include "scarp/source/table/ramp_file.h"

namespace scarp {

/// A range of heights, in metres of world z.
struct ReliefRange {
  double low = 0, high = 0;
};

/// Names of all ramps: viridis, magma, inferno, plasma, grey, hypsometric.
std::span<const std::string_view> ramp_names();

/// A ramp over a range of values. `hypsometric` has a break at sea level: blues up to 0 (elevation models store the sea
/// as 0), land colours above, each scaled to its own part of the range; the others span the whole range.
class Ramp {
 public:
  /// low <= high. Throws Error listing the names if the ramp is unknown.
  Ramp(std::string_view name, double low, double high);
  /// A ramp from a file; its absolute values are multiplied by `scale` (for exaggerated heights).
  Ramp(const RampStops& stops, double low, double high, double scale = 1);

  /// In linear light, 0..1. Values outside the range have the colour of its nearer end.
  vec3 operator()(double value) const;

  struct Piece {
    double low, high;
    std::vector<vec3> colours;  ///< evenly spaced from low to high, at least two
  };
  /// From low to high; a value belongs to the first piece that ends at or above it, or to the last.
  std::span<const Piece> pieces() const { return pieces_; }

 private:
  std::vector<Piece> pieces_;
};

/// sRGB 0..1 to linear light, and back to a byte (rounded, clamped).
vec3 linear_from_srgb(vec3 srgb);
unsigned char srgb_byte(float linear);

}  // namespace scarp
