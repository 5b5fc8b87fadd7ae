// SPDX-License-Identifier: MIT
// The settings of all marches: default, unit and range on each line.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace scarp {

/// `naive`: t += max(step_factor * |h|, min_step * t_exit), stops where h < tolerance * t; both t counted
/// from t_min.
struct NaiveSettings {
  double step_factor = 0.7;     ///< of the vertical distance h, > 0
  double min_step = 1.0 / 512;  ///< least step, as a share of the ray's length to the field's border, > 0
  double tolerance = 0.001;     ///< height above ground that counts as a hit, per unit of distance, >= 0
  int max_steps = 1024;         ///< >= 1
};

/// `fixed-step`: a sample every `step`, a hit where one is no longer above the ground.
struct FixedStepSettings {
  double step = 0.5;        ///< cells, their shorter side, > 0
  bool interpolate = true;  ///< whether Refinement::none means `secant` here
  int max_steps = 16384;    ///< >= 1
};

/// `relaxed`: t += step_factor * h, stops where |h| < tolerance * t; t counted from t_min.
struct RelaxedSettings {
  double step_factor = 0.4;   ///< of the vertical distance h, > 0
  double tolerance = 0.0015;  ///< height off the ground that counts as a hit, per unit of distance, > 0
  int max_steps = 300;        ///< >= 1
};

/// `lipschitz`: t += shrink * h, stops where shrink * h <= tolerance * t; t counted from t_min.
struct LipschitzSettings {
  double shrink = 0;  ///< of the vertical distance h, above 0 and at most 1; 0: 1 / sqrt(1 + c^2), c the slope bound
  double tolerance = 0.0005;  ///< distance to the ground that counts as a hit, per unit of distance travelled, >= 0
  int max_steps = 1024;       ///< >= 1
};

/// `max-mip-bisect`: halvings of the interval in the finest cell.
struct BisectSettings {
  int halvings = 16;  ///< 1..60
};

/// `lipschitz-local`.
struct LipschitzLocalSettings {
  double tolerance = 1e-6;  ///< length of the last interval, per unit of distance travelled, >= 0
  int max_steps = 1024;     ///< >= 1
};

/// `sphere-trace`: t += distance, closes in on the surface by bounds of segments.
struct SphereTraceSettings {
  double tolerance = 1e-6;  ///< length of the last interval, per unit of distance travelled, >= 0
  int max_steps = 1024;     ///< >= 1
};

/// What naive, fixed-step and relaxed do with their last interval: from the sample before, where the test for a hit
/// failed, to the one where it holds.
enum class Refinement : std::uint8_t {
  none,    ///< the hit is the last sample
  secant,  ///< where the straight line through the two clearances meets the test's limit
  bisect,  ///< the interval is halved by the test
};

/// "none", "secant", "bisect".
std::string_view name_of(Refinement refinement);
/// Throws Error listing the names when there is no such refinement.
Refinement find_refinement(std::string_view name);

/// Settings that naive, fixed-step and relaxed share.
struct SamplingSettings {
  Refinement refinement = Refinement::none;
  int halvings = 24;  ///< of `bisect`, 1..60
  /// Metres off the ground that count as a hit of naive and relaxed at any distance, >= 0. Rays of naive that start on
  /// the surface begin within it: they hit only what is deeper below the ground.
  double tolerance = 0;
};

/// Settings of marches over terrain functions alone, which have no cells to measure by and no end.
struct FunctionMarchSettings {
  double reach = std::numeric_limits<double>::infinity();  ///< of all: metres that a ray is followed, > 0
  double step = 5;                                         ///< of fixed-step, in the place of its cells: metres, > 0
  double step_share = 0;  ///< of fixed-step: steps are at least this share of the distance travelled, >= 0
};

struct MarchSettings {
  NaiveSettings naive;
  FixedStepSettings fixed_step;
  RelaxedSettings relaxed;
  LipschitzSettings lipschitz;
  BisectSettings bisect;
  LipschitzLocalSettings lipschitz_local;
  SamplingSettings sampling;
  FunctionMarchSettings function;
  SphereTraceSettings sphere_trace;
};

/// The refinement of fixed-step: its own `interpolate` is a secant.
inline Refinement refinement_of_fixed_step(const MarchSettings& settings) {
  if (settings.sampling.refinement != Refinement::none) return settings.sampling.refinement;
  return settings.fixed_step.interpolate ? Refinement::secant : Refinement::none;
}

/// Throws Error naming the first setting out of its range.
void validate(const MarchSettings& settings);

}  // namespace scarp
