// SPDX-License-Identifier: MIT
// Private to scarp/analysis: what Horizons keeps, shared by the questions about the sky.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/horizon_ground.h"
#include "scarp/analysis/horizon_scan.h"
#include "scarp/analysis/horizon_sweep.h"

namespace scarp {

/// Heights as an engine needs them.
struct HorizonRelief {
  /// `sign`: 1, or -1 for the ground upside down. `eye_height`: metres above the ground. Throws Interrupted.
  HorizonRelief(const HeightField& field, HorizonEngine engine, int sign, float eye_height, const Progress& progress);

  std::optional<HorizonGround> ground;                // exact
  std::optional<HorizonHeights> heights, transposed;  // sweep
  float eye;

  /// Heights in the rows and columns of the field.
  const HorizonHeights& of_nodes() const { return ground ? ground->heights() : *heights; }
};

struct Horizons::State {
  HeightField field;
  HorizonSettings settings;
  dvec2 cells;  ///< lengths in metres, which may differ from those of the field
  std::shared_ptr<const HorizonRelief> relief;

  HorizonCrossings crossings(double azimuth) const {
    return HorizonCrossings(field, azimuth, settings.max_distance, settings.curvature, cells);
  }
};

const Horizons::State& state_of(const Horizons& horizons);

/// The slopes of the horizons of a block of nodes in one of the azimuths, rows of the block's width.
struct HorizonBlock {
  NodeRect nodes;
  std::size_t azimuth;  ///< index
  const float* slopes;
  const std::int32_t* entries;  ///< for distances; -1 without ground
  const float* distances;       ///< of entries; horizontal metres
};

/// Throws Error for a rectangle without nodes and one that is not inside the field.
void require_nodes(const HeightField& field, const NodeRect& nodes);

/// Finds the horizons of a block of nodes for each azimuth (radians from grid north), on all threads: body(block) for
/// blocks that cover all nodes for each azimuth; those of a node come in the order of the azimuths, one at a time.
/// `relief` is that of the state, or the same upside down. Throws as require_nodes() does; Interrupted.
void for_each_horizon(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                      const NodeRect& nodes, const std::function<void(const HorizonBlock&)>& body,
                      const Progress& progress);

}  // namespace scarp
