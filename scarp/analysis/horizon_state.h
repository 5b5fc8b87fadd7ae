// SPDX-License-Identifier: MIT
// Private to scarp/analysis: what Horizons keeps, shared by the questions about the sky.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/horizon_ground.h"
#include "scarp/analysis/horizon_scan.h"
#include "scarp/analysis/map_part.h"

namespace scarp {

struct Horizons::State {
  HeightField field;
  HorizonSettings settings;
  HorizonGround ground;

  HorizonCrossings crossings(double azimuth) const {
    return HorizonCrossings(field, azimuth, settings.max_distance, settings.curvature);
  }
};

const Horizons::State& state_of(const Horizons& horizons);

/// The slopes of the horizons of a block of nodes in one of the azimuths, rows of the block's width, and the crossings
/// that won. Both may be changed.
struct HorizonBlock {
  NodeRect nodes;
  std::size_t azimuth;  ///< index
  float* slopes;
  const std::int32_t* entries;
};

/// Finds the horizons of a band of rows for each azimuth (radians from grid north), on all threads: body(block) for
/// each block of nodes and each azimuth, those of a block in order and one at a time. `ground` is that of the state, or
/// the same upside down; `eye` in metres. Throws Error for an empty band and one beside the field; Interrupted.
void for_each_horizon(const Horizons::State& state, const HorizonGround& ground, float eye,
                      std::span<const double> azimuths, const RowBand& band,
                      const std::function<void(const HorizonBlock&)>& body, const Progress& progress);

}  // namespace scarp
