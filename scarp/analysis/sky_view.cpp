// SPDX-License-Identifier: MIT
#include "scarp/analysis/sky_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "scarp/analysis/horizon_measures.h"
#include "scarp/analysis/horizon_state.h"
#include "scarp/analysis/tangent_planes.h"
#include "scarp/base/array_files.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

// Measures of the ground upside down need other horizons.
bool is_inverted(SkyMeasure measure) { return measure == SkyMeasure::negative_openness; }

}  // namespace

struct SkyView::State {
  Horizons horizons;
  std::vector<double> azimuths;
  std::vector<SkyMeasure> measures;
  std::shared_ptr<const HorizonRelief> inverted;
};

SkyView::SkyView(const HeightField& field, const HorizonSettings& settings, int azimuths,
                 std::vector<SkyMeasure> measures, const Progress& progress) {
  require_setting("sky view", azimuths >= 1 && azimuths <= 3600, "number of azimuths", azimuths, "1 to 3600");
  const bool inverted = std::any_of(measures.begin(), measures.end(), is_inverted);
  const double parts = inverted ? 2 : 1;
  // Both share the memory.
  HorizonSettings each = settings;
  each.memory /= parts;
  auto state = std::make_unique<State>(
      State{Horizons(field, each, progress_part(progress, 0, parts)), {}, std::move(measures), {}});
  for (int i = 0; i < azimuths; ++i) state->azimuths.push_back(2 * std::numbers::pi * i / azimuths);
  if (inverted)
    state->inverted = std::make_shared<const HorizonRelief>(field, settings.engine, -1, 0.0f, each.memory,
                                                            progress_part(progress, 1, parts));
  state_ = std::move(state);
}

SkyView::~SkyView() = default;
SkyView::SkyView(SkyView&&) noexcept = default;
SkyView::SkyView(std::unique_ptr<const State> state) : state_(std::move(state)) {}

SkyView SkyView::with_cells(double cell_x, double cell_y) const {
  auto state = std::make_unique<State>(*state_);
  state->horizons = state->horizons.with_cells(cell_x, cell_y);
  return SkyView(std::move(state));
}

std::vector<std::vector<float>> SkyView::rows(int first, int last, const Progress& progress) const {
  return block({0, first, state_of(state_->horizons).field.cols(), last}, progress);
}

std::vector<std::vector<float>> SkyView::block(const NodeRect& nodes, const Progress& progress) const {
  const auto& state = state_of(state_->horizons);
  require_nodes(state.field, nodes);
  const std::ptrdiff_t cols = nodes.col_end - nodes.col_begin;
  std::vector<std::vector<float>> maps(state_->measures.size());
  for (auto& map : maps) map.assign(nodes.count(), 0.0f);
  TangentPlanes planes;
  if (std::find(state_->measures.begin(), state_->measures.end(), SkyMeasure::sky_view_factor) !=
      state_->measures.end())
    planes = TangentPlanes(state.field, nodes, state.cells);
  const float *const planes_east = planes.east.data(), *const planes_north = planes.north.data(),
                     *const planes_level = planes.level.data();
  const auto add = [&](const HorizonRelief& relief, bool inverted, const Progress& of_pass) {
    const auto add_block = [&](const HorizonBlock& block) {
      const auto width = static_cast<std::size_t>(block.nodes.col_end - block.nodes.col_begin);
      const double azimuth = state_->azimuths[block.azimuth];
      const auto east = static_cast<float>(std::sin(azimuth)), north = static_cast<float>(std::cos(azimuth));
      const float* slopes = block.slopes;
      for (int row = block.nodes.row_begin; row < block.nodes.row_end; ++row, slopes += width) {
        const auto at =
            static_cast<std::size_t>((row - nodes.row_begin) * cols + block.nodes.col_begin - nodes.col_begin);
        for (std::size_t m = 0; m < maps.size(); ++m) {
          if (is_inverted(state_->measures[m]) != inverted) continue;
          ArrayPiece piece(maps[m].data() + at, width);
          float* sums = piece.data();
          if (state_->measures[m] == SkyMeasure::sky_fraction) {
            add_sky_fraction(slopes, width, sums);
          } else if (state_->measures[m] == SkyMeasure::sky_view_factor) {
            ArrayPiece to_east(&planes_east[at], width), to_north(&planes_north[at], width),
                level(&planes_level[at], width);
            add_sky_view_factor(slopes, {to_east.data(), to_north.data(), level.data()}, east, north, width, sums);
          } else {
            add_openness(slopes, width, sums);
          }
        }
      }
    };
    for_each_horizon(state, relief, state_->azimuths, nodes, add_block, of_pass);
  };
  const bool upright = !std::all_of(state_->measures.begin(), state_->measures.end(), is_inverted);
  const double passes = upright && state_->inverted ? 2 : 1;
  if (upright) add(*state.relief, false, progress_part(progress, 0, passes));
  if (state_->inverted) add(*state_->inverted, true, progress_part(progress, passes - 1, passes));
  const float share = 1 / static_cast<float>(state_->azimuths.size());
  for (auto& map : maps) {
    for (float& value : map) value *= share;
  }
  return maps;
}

}  // namespace scarp
