// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "scarp/analysis/horizon_measures.h"
#include "scarp/analysis/horizon_state.h"
#include "scarp/base/array_files.h"
#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {
const Horizons::State& state_of(const Horizons& horizons) { return *horizons.state_; }

void validate(const HorizonSettings& settings) {
  require_setting("horizon", settings.eye_height >= 0 && std::isfinite(settings.eye_height), "eye height",
                  settings.eye_height, "finite, at least 0");
  require_setting("horizon", settings.max_distance > 0, "maximum distance", settings.max_distance, "above 0");
  require_setting("horizon", settings.memory > 0, "memory", settings.memory, "above 0");
  if (settings.engine == HorizonEngine::sweep && std::isfinite(settings.max_distance))
    throw Error("horizon: the engine sweep has no maximum distance (choose exact, or an infinite distance)");
  validate(settings.curvature);
}

Horizons::Horizons(const HeightField& field, const HorizonSettings& settings, const Progress& progress) {
  validate(settings);
  const SightGround checked(field);  // throws for fields that this station refuses
  state_ = std::make_shared<const State>(
      State{field,
            settings,
            {field.settings().cell_x, field.settings().cell_y},
            std::make_shared<const HorizonRelief>(field, settings.engine, 1, static_cast<float>(settings.eye_height),
                                                  settings.memory, progress)});
}

Horizons Horizons::with_cells(double cell_x, double cell_y) const {
  for (const double length : {cell_x, cell_y})
    require_setting("horizon", length > 0 && std::isfinite(length), "cell length", length, "finite, above 0");
  State state = *state_;
  state.cells = {cell_x, cell_y};
  return Horizons(std::make_shared<const State>(std::move(state)));
}

HorizonRows Horizons::rows(double azimuth, int first, int last, bool distances, const Progress& progress) const {
  return block(azimuth, {0, first, state_->field.cols(), last}, distances, progress);
}

HorizonRows Horizons::block(double azimuth, const NodeRect& nodes, bool distances, const Progress& progress) const {
  require_setting("horizon", std::isfinite(azimuth), "azimuth", azimuth, "finite");
  require_nodes(state_->field, nodes);
  const std::ptrdiff_t cols = nodes.col_end - nodes.col_begin;
  HorizonRows found;
  found.angle.resize(nodes.count());
  if (distances) found.distance.resize(found.angle.size());
  const auto keep = [&](const HorizonBlock& block) {
    const auto width = static_cast<std::size_t>(block.nodes.col_end - block.nodes.col_begin);
    const float* slopes = block.slopes;
    const std::int32_t* entries = block.entries;
    for (int row = block.nodes.row_begin; row < block.nodes.row_end; ++row, slopes += width, entries += width) {
      const auto at =
          static_cast<std::size_t>((row - nodes.row_begin) * cols + block.nodes.col_begin - nodes.col_begin);
      find_angles(slopes, width, ArrayPiece(&found.angle[at], width).data());
      if (!distances) continue;
      ArrayPiece to(&found.distance[at], width);
      for (std::size_t i = 0; i < width; ++i)
        to[i] = entries[i] < 0 ? std::numeric_limits<float>::quiet_NaN() : block.distances[entries[i]];
    }
  };
  for_each_horizon(*state_, *state_->relief, {&azimuth, 1}, nodes, keep, progress);
  return found;
}

HorizonView horizon_over(const HeightField& field, const dvec2& cells, double col, double row, double azimuth,
                         double eye, double max_distance, const std::function<std::optional<double>(Node)>& lowered) {
  // Cells per metre.
  const dvec2 step(std::sin(azimuth) / cells.x, -std::cos(azimuth) / cells.y);
  double best = -std::numeric_limits<double>::infinity();
  HorizonView view;
  const auto cross_lines = [&](bool of_columns) {
    const double from = of_columns ? col : row, beside = of_columns ? row : col;
    const double ahead = of_columns ? step.x : step.y, aside = of_columns ? step.y : step.x;
    const int lines = of_columns ? field.cols() : field.rows(), across = of_columns ? field.rows() : field.cols();
    // Only rounding of the angle makes a line that runs along an axis cross the lines of that axis.
    if (std::abs(ahead) < kNoDirection * std::abs(aside)) return;
    const int sign = ahead > 0 ? 1 : -1;
    const int first = sign > 0 ? static_cast<int>(std::floor(from)) + 1 : static_cast<int>(std::ceil(from)) - 1;
    for (int line = first; line >= 0 && line < lines; line += sign) {
      const double distance = (line - from) / ahead;
      double place = beside + aside * distance;
      // Within rounding of a node, it is the node.
      if (std::abs(place - std::round(place)) <= HeightField::rounding_of_line(place, across + lines))
        place = std::round(place);
      if (distance > max_distance || place < 0 || place > across - 1) break;
      const int low = static_cast<int>(place);
      const double w = place - low;
      const auto at = [&](int beside_line) {
        return lowered(of_columns ? Node{line, beside_line} : Node{beside_line, line});
      };
      const auto a = at(low), b = w > 0 ? at(low + 1) : a;
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

std::optional<HorizonView> horizon_from(const HeightField& field, double col, double row, double azimuth,
                                        const HorizonSettings& settings, const std::optional<dvec2>& cells) {
  validate(settings);
  require_setting("horizon", std::isfinite(azimuth), "azimuth", azimuth, "finite");
  const SightGround ground(field, col, row, settings.curvature, cells);
  const auto here = ground.height_at(col, row);
  if (!here) return std::nullopt;
  return horizon_over(field, ground.cells(), col, row, azimuth, *here + settings.eye_height, settings.max_distance,
                      [&](Node node) { return ground.lowered(node); });
}

}  // namespace scarp
