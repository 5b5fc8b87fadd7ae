// SPDX-License-Identifier: MIT
// Heights that no one scaled: samples of pictures, and relief out of proportion to the ground.
//
// A picture without a georeference has cells of 1 m, and its samples fill the range of their type. At 1 m per unit, 16
// bits are 65 km of relief over a few kilometres of ground.
#pragma once

#include <optional>
#include <string>

#include "scarp/source/raster/raster.h"

namespace scarp {

/// The heights of the whole range of a picture's samples, as a fraction of the picture's longer side: a usual
/// proportion of height maps for games, whose terrain is some eight times as wide as high.
inline constexpr double kPictureRelief = 1.0 / 8;

/// Statements of a file and its reader about the heights of its samples.
struct HeightsStated {
  bool picture = false;              ///< a format of pictures, such as PNG
  bool scaled = false;               ///< the file or the caller states a scale, an offset or a unit
  std::optional<double> greatest{};  ///< largest value of unsigned samples; nullopt: other samples
  double longer_side_m = 0;          ///< of the whole file, of which the raster may be a window
};

/// For a raster without georeference or scale whose relief exceeds its longer side: sets the scale of a picture of
/// unsigned samples, otherwise leaves it. Returns a note in either case; empty: nothing is out of proportion.
std::string settle_default_scale(Raster& raster, const HeightsStated& stated);

}  // namespace scarp
