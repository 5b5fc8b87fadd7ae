// SPDX-License-Identifier: MIT
#include "scarp/field/ground_points.h"

#include <fmt/format.h>

#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/field/ground_points_simd.h"

namespace scarp {
namespace {

constexpr std::int64_t kPointsPerPiece = 4096;

}  // namespace

std::optional<GroundPoint> ground_point(const HeightField& field, double x, double y) {
  // The common case with one decision about the sample type, by the operations of height() and normal().
  const HeightField::GridScales scales = field.grid_scales();
  const HeightFieldSettings& settings = field.settings();
  const double col = x * scales.per_cell_x, row = (field.rows() - 1) - y * scales.per_cell_y;
  const int cols = field.cols() - 1, rows = field.rows() - 1;
  if (col >= 0 && row >= 0 && col < cols && row < rows && !field.wraps() && field.nodata_count() == 0) {
    const int c = static_cast<int>(col), r = static_cast<int>(row);
    const CellHeights h = field.visit([&](const auto& grid) { return grid.cell(c, r); });
    const double u = col - c, v = row - r, metres = settings.scale * settings.exaggeration;
    const bool flat = settings.surface == Surface::triangles;
    const double side = u + v > 1 ? 1.0 : 0.0, at_u = flat ? side : u, at_v = flat ? side : v;
    const double along_row = (h.h10 - h.h00) + at_v * ((h.h11 - h.h01) - (h.h10 - h.h00));
    const double along_col = (h.h01 - h.h00) + at_u * ((h.h11 - h.h10) - (h.h01 - h.h00));
    const double nx = -(along_row * metres * scales.per_cell_x), ny = along_col * metres * scales.per_cell_y;
    const double per_length = 1 / std::sqrt(nx * nx + ny * ny + 1);
    return GroundPoint{field.height_from_sample(height_in_cell(settings.surface, h, u, v)),
                       {nx * per_length, ny * per_length, per_length}};
  }
  GroundPoint point;
  look_up_point(field, x, y, point.height, &point.normal);
  if (std::isnan(point.height)) return {};
  return point;
}

void heights_at(const HeightField& field, std::span<const double> xs, std::span<const double> ys,
                std::span<double> heights, std::span<dvec3> normals) {
  if (ys.size() != xs.size() || heights.size() != xs.size() || (!normals.empty() && normals.size() != xs.size())) {
    throw Error(
        fmt::format("heights: {} x, {} y, room for {} heights and {} normals (the same number of each, or no "
                    "normals)",
                    xs.size(), ys.size(), heights.size(), normals.size()));
  }
  const auto look_up = [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin);
    look_up_points(field, xs.data() + first, ys.data() + first, static_cast<std::size_t>(end) - first,
                   heights.data() + first, normals.empty() ? nullptr : normals.data() + first);
  };
  const auto count = static_cast<std::int64_t>(xs.size());
  if (count <= kPointsPerPiece) return look_up(0, count);
  parallel_for(count, kPointsPerPiece, look_up);
}

}  // namespace scarp
