// SPDX-License-Identifier: MIT
// Heights without a stated scale: samples of pictures, and relief out of proportion to the ground.
//
// A picture without a georeference has cells of 1 m, and its samples fill the range of their type. At 1 m per unit, 16
// bits are 65 km of relief over a few kilometres of ground.
#pragma once

#include <optional>
#include <string>

#include "scarp/source/raster/raster.h"

namespace scarp {

/// Relief of the whole range of a picture's samples, as a fraction of the picture's longer side: common for game height
/// maps, whose terrain is about eight times as wide as it is high.
inline constexpr double kPictureRelief = 1.0 / 8;

/// Information from a file and its reader about the heights of the samples.
struct HeightsStated {
  bool picture = false;              ///< an image format, such as PNG
  bool scaled = false;               ///< the file or the caller states a scale, an offset or a unit
  std::optional<double> greatest{};  ///< largest value of unsigned samples; nullopt: other samples
  double longer_side_m = 0;          ///< of the whole file; the raster may be a window of it
};

/// Returns whether settle_default_scale() may change the scale of a raster without georeference.
bool depends_on_samples(const HeightsStated& stated);

/// For a raster without georeference or scale whose relief exceeds its longer side: sets the scale for a picture with
/// unsigned samples, otherwise leaves the raster unchanged. Returns a note in both cases, or an empty text if nothing
/// is out of proportion.
std::string settle_default_scale(Raster& raster, const HeightsStated& stated);

}  // namespace scarp
