// SPDX-License-Identifier: MIT
// Private to scarp/analysis: what Horizons keeps, shared by the questions about the sky.
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/horizon_ground.h"
#include "scarp/analysis/horizon_scan.h"

namespace scarp {

struct Horizons::State {
  HeightField field;
  HorizonSettings settings;
  HorizonGround ground;

  float eye() const { return static_cast<float>(settings.eye_height); }
  HorizonCrossings crossings(double azimuth) const {
    return HorizonCrossings(field, azimuth, settings.max_distance, settings.curvature);
  }
};

const Horizons::State& state_of(const Horizons& horizons);

/// Throws Error for rows outside the field.
void require_rows(const HeightField& field, int first, int last);

/// Columns of a strip: its rows of samples stay in the cache from one row of nodes to the next.
inline constexpr int kStripCols = 256;

/// Calls body(rect) for blocks of kStripCols columns that cover rows [first, last), on all threads. Each is large
/// enough for the warm start of horizon_scan.h to pay.
void for_each_block(int cols, int first, int last, const std::function<void(const NodeRect&)>& body,
                    const Progress& progress);

}  // namespace scarp
