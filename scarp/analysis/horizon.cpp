// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/analysis/horizon_state.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr int kBlockRows = 128;

}  // namespace

const Horizons::State& state_of(const Horizons& horizons) { return *horizons.state_; }

void require_rows(const HeightField& field, int first, int last) {
  if (first < 0 || first > last || last > field.rows())
    throw Error(fmt::format("horizon: rows {} to {} of a field of {} rows", first, last, field.rows()));
}

void validate(const HorizonSettings& settings) {
  require_setting("horizon", settings.eye_height >= 0 && std::isfinite(settings.eye_height), "eye height",
                  settings.eye_height, "finite, at least 0");
  require_setting("horizon", settings.max_distance > 0, "maximum distance", settings.max_distance, "above 0");
  validate(settings.curvature);
}

void for_each_block(int cols, int first, int last, const std::function<void(const NodeRect&)>& body,
                    const Progress& progress) {
  const std::int64_t across = (cols + kStripCols - 1) / kStripCols, down = (last - first + kBlockRows - 1) / kBlockRows;
  parallel_for(
      across * down, 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
          const int col = static_cast<int>(i % across) * kStripCols;
          const int row = first + static_cast<int>(i / across) * kBlockRows;
          body({col, row, std::min(col + kStripCols, cols), std::min(row + kBlockRows, last)});
        }
      },
      progress);
}

Horizons::Horizons(const HeightField& field, const HorizonSettings& settings, const Progress& progress) {
  validate(settings);
  const SightGround checked(field);  // throws for fields that this station refuses
  state_ = std::make_shared<const State>(
      State{field, settings, HorizonGround(field, 1, static_cast<float>(settings.eye_height), progress)});
}

HorizonRows Horizons::rows(double azimuth, int first, int last, bool distances, const Progress& progress) const {
  require_setting("horizon", std::isfinite(azimuth), "azimuth", azimuth, "finite");
  require_rows(state_->field, first, last);
  const HorizonCrossings crossings = state_->crossings(azimuth);
  const HorizonTable table(state_->ground, crossings);
  const std::ptrdiff_t cols = state_->field.cols();
  HorizonRows found;
  found.angle.resize(static_cast<std::size_t>(cols * (last - first)));
  std::vector<std::int32_t> entries(distances ? found.angle.size() : 0);
  if (distances) found.distance.resize(found.angle.size());
  for_each_block(
      static_cast<int>(cols), first, last,
      [&](const NodeRect& block) {
        const std::ptrdiff_t corner = (block.row_begin - first) * cols + block.col_begin;
        scan_horizon(state_->ground, table, state_->eye(), block, found.angle.data() + corner,
                     distances ? entries.data() + corner : nullptr, cols);
        const int width = block.col_end - block.col_begin;
        for (int row = 0; row < block.row_end - block.row_begin; ++row) {
          float* angle = found.angle.data() + corner + row * cols;
          for (int col = 0; col < width; ++col) angle[col] = std::atan(angle[col]);
          if (!distances) continue;
          const std::int32_t* entry = entries.data() + corner + row * cols;
          float* distance = found.distance.data() + corner + row * cols;
          for (int col = 0; col < width; ++col) {
            distance[col] = entry[col] < 0
                                ? std::numeric_limits<float>::quiet_NaN()
                                : static_cast<float>(crossings.all()[static_cast<std::size_t>(entry[col])].steps *
                                                     crossings.step());
          }
        }
      },
      progress);
  return found;
}

std::optional<HorizonView> horizon_from(const HeightField& field, double col, double row, double azimuth,
                                        const HorizonSettings& settings) {
  validate(settings);
  require_setting("horizon", std::isfinite(azimuth), "azimuth", azimuth, "finite");
  const SightGround ground(field, col, row, settings.curvature);
  const auto here = ground.height_at(col, row);
  if (!here) return std::nullopt;
  const double eye = *here + settings.eye_height;
  // Cells per metre.
  const dvec2 step(std::sin(azimuth) / field.settings().cell_x, -std::cos(azimuth) / field.settings().cell_y);
  double best = -std::numeric_limits<double>::infinity();
  HorizonView view;
  const auto cross_lines = [&](bool of_columns) {
    const double from = of_columns ? col : row, beside = of_columns ? row : col;
    const double ahead = of_columns ? step.x : step.y, aside = of_columns ? step.y : step.x;
    const int lines = of_columns ? field.cols() : field.rows(), across = of_columns ? field.rows() : field.cols();
    // Only rounding of the angle makes a line that runs along an axis cross the lines of that axis.
    if (std::abs(ahead) < 0x1p-40 * std::abs(aside)) return;
    const int sign = ahead > 0 ? 1 : -1;
    const int first = sign > 0 ? static_cast<int>(std::floor(from)) + 1 : static_cast<int>(std::ceil(from)) - 1;
    for (int line = first; line >= 0 && line < lines; line += sign) {
      const double distance = (line - from) / ahead;
      double place = beside + aside * distance;
      // Within rounding of a node, it is the node.
      if (std::abs(place - std::round(place)) <= HeightField::rounding_of_line(place, across + lines))
        place = std::round(place);
      if (distance > settings.max_distance || place < 0 || place > across - 1) break;
      const int low = static_cast<int>(place);
      const double w = place - low;
      const auto lowered = [&](int at) { return ground.lowered(of_columns ? Node{line, at} : Node{at, line}); };
      const auto a = lowered(low), b = w > 0 ? lowered(low + 1) : a;
      if (!a || !b) continue;
      const double slope = (*a + w * (*b - *a) - eye) / distance;
      if (slope > best || (slope == best && view.distance && distance < *view.distance))
        best = slope, view.distance = distance;
    }
  };
  cross_lines(true), cross_lines(false);
  view.angle = std::atan(best);
  return view;
}

}  // namespace scarp
