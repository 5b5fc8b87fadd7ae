// SPDX-License-Identifier: MIT
// The looks of a picture: a table of names and properties, like that of the marches. A look maps the hits of camera
// rays to colours.
//
//   shaded    materials lit by sun and sky, with exact hard shadows (or, with `samples`, soft shadows and ambient
//             occlusion); water, haze or fog, sky
//   hillshade grey by the angle to the sun, without shadows, see hillshade_look.h
//   height    grey, linear in height, see height_look.h
//   steps     steps of the march per ray, as a colour ramp from the minimum to the maximum in the picture, or over a
//             given range
//   cost      heights, nodes and voxels that the march reads per ray, in the same way, see cost_look.h
//   error     errors of the march, see error_look.h
//   comanche  like `shaded`, in few large pixels, see comanche.h
//   level     maxima of a level of the pyramid, see level_look.h
//   slope, aspect, multidirectional
//             gradients of the samples and shading by them, as in gdaldem, see relief_look.h
//
// `shaded` takes several samples per pixel. `hillshade`, `height`, `steps`, `cost`, `error`, `level`, `slope`,
// `aspect` and `multidirectional` trace one ray through the centre of each pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace scarp {

enum class Look : std::uint8_t {
  shaded,
  hillshade,
  height,
  steps,
  cost,
  error,
  comanche,
  level,
  slope,
  aspect,
  multidirectional
};
constexpr std::size_t kLookCount = 11;

/// A row of the table.
struct LookEntry {
  Look look;
  std::string_view name;
  bool lit = false;           ///< sun, sky, water and fog
  bool antialiased = false;   ///< several samples per pixel
  bool large_pixels = false;  ///< rendered in few pixels and scaled up
  bool measures = false;      ///< shows numbers of the march or of its structures, which averaged samples would change
};

/// Counts of the first and last colour of a ramp: steps, or reads; 0 <= low < high.
struct StepScale {
  double low = 0, high = 0;
};

/// Minimum, maximum and mean number of steps or reads per ray, and the scale of the colours.
struct StepRange {
  std::uint32_t least = 0;
  std::uint32_t most = 0;
  double mean = 0;
  StepScale scale{};
  std::string of{};  ///< what is counted: "samples", "blocks and cells", "heights"
};

/// Returns all looks, in the order of the enumeration.
std::span<const LookEntry> looks();
/// Returns the row of a look.
const LookEntry& entry_of(Look look);
/// Returns the name of a look, such as "shaded".
std::string_view name_of(Look look);
/// Returns the look with this name. Throws Error listing the names if `name` is unknown.
Look find_look(std::string_view name);

}  // namespace scarp
