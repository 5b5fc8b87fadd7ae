// SPDX-License-Identifier: MIT
#include "scarp/analysis/sky_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "scarp/analysis/horizon_state.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr float kQuarterTurn = static_cast<float>(std::numbers::pi / 2);

// The tangent plane of a node: cos b, and sin b times the direction of the aspect.
struct Tilt {
  float level = 0, east = 0, north = 0;
};

// All 0 on a hole.
Tilt tilt_of(const SightGround& ground, int col, int row) {
  const HeightField& field = ground.field();
  const auto height = [&](int c, int r) -> std::optional<double> {
    if (c < 0 || r < 0 || c >= field.cols() || r >= field.rows()) return std::nullopt;
    return ground.height({c, r});
  };
  const auto here = height(col, row);
  if (!here) return {};
  const auto slope = [&](std::optional<double> before, std::optional<double> after, double cell) {
    if (before && after) return (*after - *before) / (2 * cell);
    if (after) return (*after - *here) / cell;
    return before ? (*here - *before) / cell : 0;
  };
  const double x = slope(height(col - 1, row), height(col + 1, row), field.settings().cell_x);
  const double y = slope(height(col, row + 1), height(col, row - 1), field.settings().cell_y);
  const double level = 1 / std::sqrt(1 + x * x + y * y);
  return {static_cast<float>(level), static_cast<float>(-x * level), static_cast<float>(-y * level)};
}

// One azimuth's share of a measure, for slopes of horizons. NaN stays.
void add_sky_fraction(const float* slope, int count, float* sum) {
  for (int i = 0; i < count; ++i) {
    const float s = slope[i] < 0 ? 0 : slope[i];
    sum[i] += 1 - s / std::sqrt(1 + s * s);
  }
}
void add_sky_view_factor(const float* slope, const Tilt* tilt, float east, float north, int count, float* sum) {
  for (int i = 0; i < count; ++i) {
    const float s = slope[i] < 0 ? 0 : slope[i], h = std::atan(s), zenith = kQuarterTurn - h;
    const float square = 1 / (1 + s * s);  // sin^2 H
    sum[i] += tilt[i].level * square + (tilt[i].east * east + tilt[i].north * north) * (zenith - s * square);
  }
}
void add_openness(const float* slope, int count, float* sum) {
  for (int i = 0; i < count; ++i) {
    const float s = slope[i] == -std::numeric_limits<float>::infinity() ? 0 : slope[i];
    sum[i] += kQuarterTurn - std::atan(s);
  }
}

}  // namespace

SkyView::SkyView(const HeightField& field, const HorizonSettings& settings, int azimuths, const Progress& progress)
    : horizons_(field, settings, progress), azimuths_(azimuths) {
  require_setting("sky view", azimuths >= 1 && azimuths <= 3600, "number of azimuths", azimuths, "1 to 3600");
}

std::vector<std::vector<float>> SkyView::rows(std::span<const SkyMeasure> measures, int first, int last,
                                              const Progress& progress) const {
  const auto& state = state_of(horizons_);
  require_rows(state.field, first, last);
  const std::ptrdiff_t cols = state.field.cols();
  const auto asks = [&](SkyMeasure measure) {
    return std::find(measures.begin(), measures.end(), measure) != measures.end();
  };
  std::optional<HorizonGround> inverted;
  if (asks(SkyMeasure::negative_openness)) inverted.emplace(state.field, -1, 0.0f, progress);

  std::vector<HorizonTable> tables;
  std::vector<std::pair<float, float>> directions;  // east, north
  for (int i = 0; i < azimuths_; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / azimuths_;
    tables.emplace_back(state.ground, state.crossings(azimuth));
    directions.emplace_back(static_cast<float>(std::sin(azimuth)), static_cast<float>(std::cos(azimuth)));
  }
  const SightGround samples(state.field);
  std::vector<std::vector<float>> maps(measures.size());
  for (auto& map : maps) map.assign(static_cast<std::size_t>(cols * (last - first)), 0.0f);
  for_each_block(
      static_cast<int>(cols), first, last,
      [&](const NodeRect& block) {
        const int width = block.col_end - block.col_begin, height = block.row_end - block.row_begin,
                  count = width * height;
        std::vector<float> slopes(static_cast<std::size_t>(count));
        std::vector<std::vector<float>> sums(measures.size(), std::vector<float>(slopes.size()));
        std::vector<Tilt> tilts;
        if (asks(SkyMeasure::sky_view_factor)) {
          for (int row = block.row_begin; row < block.row_end; ++row) {
            for (int col = block.col_begin; col < block.col_end; ++col) tilts.push_back(tilt_of(samples, col, row));
          }
        }
        const auto add_all = [&](const HorizonGround& ground, int azimuth, bool upside_down) {
          scan_horizon(ground, tables[static_cast<std::size_t>(azimuth)], upside_down ? 0 : state.eye(), block,
                       slopes.data(), nullptr, width);
          const auto [east, north] = directions[static_cast<std::size_t>(azimuth)];
          for (std::size_t m = 0; m < measures.size(); ++m) {
            if ((measures[m] == SkyMeasure::negative_openness) != upside_down) continue;
            float* sum = sums[m].data();
            if (measures[m] == SkyMeasure::sky_fraction) {
              add_sky_fraction(slopes.data(), count, sum);
            } else if (measures[m] == SkyMeasure::sky_view_factor) {
              add_sky_view_factor(slopes.data(), tilts.data(), east, north, count, sum);
            } else {
              add_openness(slopes.data(), count, sum);
            }
          }
        };
        const bool upright = std::any_of(measures.begin(), measures.end(),
                                         [](SkyMeasure m) { return m != SkyMeasure::negative_openness; });
        for (int i = 0; i < azimuths_; ++i) {
          if (upright) add_all(state.ground, i, false);
          if (inverted) add_all(*inverted, i, true);
        }
        for (std::size_t m = 0; m < measures.size(); ++m) {
          const float share = 1 / static_cast<float>(azimuths_);
          for (int row = 0; row < height; ++row) {
            const float* from = sums[m].data() + static_cast<std::ptrdiff_t>(row) * width;
            float* to = maps[m].data() + (block.row_begin - first + row) * cols + block.col_begin;
            for (int col = 0; col < width; ++col) to[col] = from[col] * share;
          }
        }
      },
      progress);
  return maps;
}

}  // namespace scarp
