// SPDX-License-Identifier: MIT
#include "scarp/field/ground_holes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

int wrapped(int i, int count) { return i < 0 ? i + count : i < count ? i : i - count; }

}  // namespace

// A cell that is not adjacent to this one is at least a whole cell away.
OverHole over_hole(const HeightField& field, dvec2 place, double radius) {
  const HeightFieldSettings& s = field.settings();
  const double far = std::min(s.cell_x, s.cell_y);
  const auto at = field.place(place.x, place.y);
  if (!at) return {far, dvec2(0.0), false};
  const auto [col, row] = at->cell;
  const bool hole = !field.cell_heights(at->cell);
  // Distances to the lines on each side, metres: west, none, east; north, none, south.
  const double to_x[] = {at->u * s.cell_x, 0, (1 - at->u) * s.cell_x};
  const double to_y[] = {at->v * s.cell_y, 0, (1 - at->v) * s.cell_y};
  double nearest = far;  // distance to the nearest cell of the other kind (ground or hole)
  int side_x = 0, side_y = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      int c = col + dx, r = row + dy;
      if (field.wraps()) {
        c = wrapped(c, field.cell_cols()), r = wrapped(r, field.cell_rows());
      } else if (c < 0 || r < 0 || c >= field.cell_cols() || r >= field.cell_rows()) {
        continue;
      }
      if ((dx == 0 && dy == 0) || !field.cell_heights({c, r}) == hole) continue;
      const double away = std::hypot(to_x[dx + 1], to_y[dy + 1]);
      // At equal distances, sides take precedence over corners.
      if (away < nearest || (away == nearest && dx * dy == 0 && side_x * side_y != 0)) {
        nearest = away, side_x = dx, side_y = dy;
      }
    }
  }
  OverHole out{hole ? nearest : -nearest, dvec2(0.0), false};
  if (side_x == 0 && side_y == 0) return out;
  // Away from the nearest point of the ground, or towards the nearest point of the hole; rows run southwards.
  dvec2 to(side_x * to_x[side_x + 1], -side_y * to_y[side_y + 1]);
  if (!(length(to) > 0)) to = dvec2(side_x, -side_y);
  out.gradient = (hole ? -1.0 : 1.0) * normalize(to);
  if (side_x * side_y != 0) return out;
  // True if only a straight rim is within the radius: neither its ends nor another rim are.
  const bool across = side_x != 0;
  const double ends = across ? std::min(to_y[0], to_y[2]) : std::min(to_x[0], to_x[2]);
  const double behind = across ? to_x[1 - side_x] : to_y[1 - side_y];
  out.flat = ends >= nearest + 2 * radius && behind >= nearest + 2 * radius && nearest + 2 * radius <= 0.5 * far;
  return out;
}

HeightField filled_holes(const HeightField& field, double slope) {
  if (field.all_nodata())
    throw Error("height field: all samples are nodata (a solid ground needs at least one height)");
  const HeightFieldSettings& s = field.settings();
  const int cols = field.cols(), rows = field.rows();
  const double per_metre = 1 / (s.scale * s.exaggeration), drop = slope * per_metre;
  const auto fall_x = static_cast<float>(drop * s.cell_x), fall_y = static_cast<float>(drop * s.cell_y);
  const auto fall_both = static_cast<float>(drop * std::hypot(s.cell_x, s.cell_y));
  const auto lowest = static_cast<float>(field.min_sample());
  std::vector<float> samples(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  std::vector<std::uint8_t> open(samples.size());
  const auto index = [cols](int col, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
  };
  field.visit([&](const auto& grid) {
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < cols; ++col) {
        const std::size_t i = index(col, row);
        const auto sample = grid.at(col, row);
        open[i] = grid.is_nodata(sample);
        samples[i] = open[i] ? lowest : static_cast<float>(sample);
      }
    }
  });
  // Two passes, down the rows and back, as in distance transforms: one carries heights east and south, the other west
  // and north. Heights are not carried across the seam of wrapped fields, which is correct but slower there.
  const auto raise = [&](int col, int row, int dc, int dr, float fall) {
    const int c = col + dc, r = row + dr;
    if (c < 0 || r < 0 || c >= cols || r >= rows) return;
    float& at = samples[index(col, row)];
    at = std::max(at, samples[index(c, r)] - fall);
  };
  for (const int way : {-1, 1}) {
    for (int k = 0; k < rows; ++k) {
      const int row = way < 0 ? k : rows - 1 - k;
      for (int j = 0; j < cols; ++j) {
        const int col = way < 0 ? j : cols - 1 - j;
        if (!open[index(col, row)]) continue;
        raise(col, row, way, 0, fall_x), raise(col, row, 0, way, fall_y);
        raise(col, row, -1, way, fall_both), raise(col, row, 1, way, fall_both);
      }
    }
  }
  HeightFieldSettings settings = s;
  settings.nodata.reset();
  return HeightField::own(std::move(samples), cols, rows, settings);
}

}  // namespace scarp
