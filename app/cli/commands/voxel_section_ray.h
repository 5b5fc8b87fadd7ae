// SPDX-License-Identifier: MIT
// `scarp section --ray`: what voxel marches do along a ray in one layer, as SVG.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scarp/field/voxel_grid.h"
#include "scarp/march/voxel/voxel_ray.h"

namespace scarp::cli {

/// A ray in the layer of a section.
struct SectionRay {
  VoxelRay ray;  ///< in voxels of the box around the model's voxels
  int axis;      ///< perpendicular to the layer
  int at;        ///< index of the layer
};

/// Parses X,Y,Z,DX,DY,DZ. `axis`: "x", "y" or "z"; empty: an axis along which the ray does not travel. Throws Error for
/// a ray that travels along the axis.
SectionRay typed_section_ray(const std::string& text, const std::string& axis);

struct SectionDrawing {
  std::string svg;
  std::vector<std::string> lines;  ///< steps and result of each march
};

/// Draws the marches, each in a panel. `grid()` returns the model with `margin` empty voxels around it. Throws Error if
/// the ray does not pass through it.
SectionDrawing draw_section(const std::function<VoxelGrid()>& grid, int margin, const SectionRay& ray,
                            const std::vector<std::string>& marches);

/// Names of the marches that can be drawn.
std::vector<std::string> section_marches();

}  // namespace scarp::cli
