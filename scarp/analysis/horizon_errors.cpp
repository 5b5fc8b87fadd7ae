// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "scarp/analysis/horizon_measures.h"
#include "scarp/analysis/horizon_state.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp {
namespace {

// A node, and its place among those that were drawn.
struct DrawnNode {
  int row, col;
  std::size_t number;
  bool operator<(const DrawnNode& other) const { return std::pair(row, col) < std::pair(other.row, other.col); }
};

// The horizons of some nodes of a band. Those of the others are not kept: they may not fit into memory.
std::vector<float> angles_of(const Horizons& horizons, double azimuth, const RowBand& band,
                             const std::vector<DrawnNode>& nodes, const Progress& progress) {
  const Horizons::State& state = state_of(horizons);
  std::vector<DrawnNode> sorted = nodes;
  std::sort(sorted.begin(), sorted.end());
  std::vector<float> angles(nodes.size());
  const auto keep = [&](const HorizonBlock& block) {
    const NodeRect& of = block.nodes;
    const std::ptrdiff_t width = of.col_end - of.col_begin;
    for (int row = of.row_begin; row < of.row_end; ++row) {
      for (auto at = std::lower_bound(sorted.begin(), sorted.end(), DrawnNode{row, of.col_begin, 0});
           at != sorted.end() && at->row == row && at->col < of.col_end; ++at)
        find_angles(block.slopes + (row - of.row_begin) * width + (at->col - of.col_begin), 1, &angles[at->number]);
    }
  };
  for_each_horizon(state, *state.relief, {&azimuth, 1}, {0, band.first, state.field.cols(), band.last}, keep, progress);
  return angles;
}

// The horizon of a node by every crossing. Tiles are read one at a time, while a field in a file would become part of
// the program's memory page by page; their heights are floats.
std::optional<HorizonView> true_horizon(const Horizons& horizons, const DrawnNode& node, double azimuth) {
  const Horizons::State& state = state_of(horizons);
  if (!state.relief->tiles) return horizon_from(state.field, node.col, node.row, azimuth, state.settings, state.cells);
  HorizonSamples samples(*state.relief->tiles);
  const SightGround ground(state.field, node.col, node.row, state.settings.curvature, state.cells);
  const auto height = static_cast<double>(samples.at(node.col, node.row));
  if (std::isnan(height)) return std::nullopt;
  const auto lowered = [&](Node at) -> std::optional<double> {
    const auto found = static_cast<double>(samples.at(at.col, at.row));
    return std::isnan(found) ? std::nullopt : std::optional(ground.lowered(found, at.col, at.row));
  };
  return horizon_over(state.field, state.cells, node.col, node.row, azimuth, height + state.settings.eye_height,
                      state.settings.max_distance, lowered);
}

}  // namespace

HorizonErrors sampled_horizon_errors(const HeightField& field, const HorizonSettings& settings,
                                     std::span<const double> azimuths, const RowBand& band, int angles,
                                     const Progress& progress) {
  if (azimuths.empty() || band.rows() <= 0) return {};
  constexpr std::size_t kMostAzimuths = 8;
  const std::size_t chosen = std::min(azimuths.size(), kMostAzimuths);
  const Horizons horizons(field, settings);
  const auto cols = static_cast<std::size_t>(field.cols()), all = cols * static_cast<std::size_t>(band.rows());
  std::mt19937 random(1);
  std::vector<double> errors;
  for (std::size_t a = 0; a < chosen; ++a) {
    // Azimuths of the grid, in which a sweep is exact, are often every eighth.
    const double azimuth = azimuths[(a * azimuths.size() / chosen + a) % azimuths.size()];
    std::vector<DrawnNode> nodes(static_cast<std::size_t>(angles) / chosen);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t node = random() % all;
      nodes[i] = {static_cast<int>(node / cols) + band.first, static_cast<int>(node % cols), i};
    }
    const std::vector<float> found = angles_of(
        horizons, azimuth, band, nodes, progress_part(progress, static_cast<double>(a), static_cast<double>(chosen)));
    std::vector<double> differences(nodes.size(), std::numeric_limits<double>::quiet_NaN());
    parallel_for(static_cast<std::int64_t>(nodes.size()), 16, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        const auto truth = true_horizon(horizons, nodes[i], azimuth);
        if (truth) differences[i] = std::abs(truth->angle - static_cast<double>(found[i]));
      }
    });
    std::copy_if(differences.begin(), differences.end(), std::back_inserter(errors),
                 [](double difference) { return !std::isnan(difference); });
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  return {at(0.5), at(0.99), errors.back(), static_cast<int>(errors.size())};
}

}  // namespace scarp
