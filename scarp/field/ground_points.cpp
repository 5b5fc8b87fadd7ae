// SPDX-License-Identifier: MIT
#include "scarp/field/ground_points.h"

#include <fmt/format.h>

#include <limits>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr std::int64_t kPointsPerPiece = 4096;

}  // namespace

void heights_at(const HeightField& field, std::span<const double> xs, std::span<const double> ys,
                std::span<double> heights, std::span<dvec3> normals) {
  if (ys.size() != xs.size() || heights.size() != xs.size() || (!normals.empty() && normals.size() != xs.size())) {
    throw Error(
        fmt::format("heights: {} x, {} y, room for {} heights and {} normals (the same number of each, or no "
                    "normals)",
                    xs.size(), ys.size(), heights.size(), normals.size()));
  }
  parallel_for(static_cast<std::int64_t>(xs.size()), kPointsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const auto height = field.height(xs[i], ys[i]);
      heights[i] = height.value_or(std::numeric_limits<double>::quiet_NaN());
      if (normals.empty()) continue;
      normals[i] = dvec3(0.0);
      if (!height) continue;
      const auto [cell, u, v] = field.ground_at(field.place(xs[i], ys[i]).value());
      normals[i] = field.normal(cell, u, v);
    }
  });
}

}  // namespace scarp
