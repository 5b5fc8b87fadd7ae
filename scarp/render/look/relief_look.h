// SPDX-License-Identifier: MIT
// The looks `slope`, `aspect` and `multidirectional`: numbers of the ground from the sample nearest to each pixel's hit
// and its eight neighbours, as gdaldem computes them. Where a hit is not on a height field, its normal is used.
//
//   slope             degrees, 0 to 90
//   aspect            azimuth of the steepest descent in degrees clockwise from grid north, 0 up to 360; none if flat
//
//   multidirectional  grey levels 1 to 255 of light from 225, 270, 315 and 360 degrees, 45 degrees high, each weighted
//                     by the cosine squared of its angle to the aspect, as gdaldem does; sin 45 degrees if flat
//
// Sources: B. K. P. Horn, "Hill shading and the reflectance map", Proceedings of the IEEE 69, 1981 (the gradient);
// R. K. Mark, "Multidirectional, oblique-weighted, shaded-relief image of the Island of Hawaii", USGS OFR 92-422, 1992.
#pragma once

#include <optional>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/base/vec.h"
#include "scarp/field/height_field.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/film/film.h"
#include "scarp/render/look/look.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the rise to the east and to the north at a sample, metres per metre; nullopt at the border and beside holes.
std::optional<dvec2> horn_gradient(const HeightField& field, int col, int row);

float slope_of(const dvec2& gradient);                  ///< degrees
std::optional<float> aspect_of(const dvec2& gradient);  ///< degrees; nullopt where flat
float multidirectional_of(const dvec2& gradient);       ///< 1 to 255

/// Returns the numbers of one of these looks, a pixel each, rows from the top; NaN: none. Cameras that look straight
/// down on one height field show the nearest sample up to half a cell beyond the outermost ones.
std::vector<float> relief_numbers(const Scene& scene, const Camera& camera, ImageSize size, Look look,
                                  const Progress& progress);

}  // namespace scarp
