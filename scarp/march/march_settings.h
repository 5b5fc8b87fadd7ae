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
  double step_factor = 0.7;     ///< step as a fraction of the vertical distance h, > 0
  double min_step = 1.0 / 512;  ///< minimum step as a fraction of the ray's length to the field's border, > 0
  double tolerance = 0.001;     ///< height above ground that counts as a hit, per unit of distance, >= 0
  int max_steps = 1024;         ///< >= 1

  bool operator==(const NaiveSettings&) const = default;
};

/// `fixed-step`: one sample every `step`; hits at the first sample that is no longer above the ground.
struct FixedStepSettings {
  double step = 0.5;        ///< in units of a cell's shorter side, > 0
  bool interpolate = true;  ///< whether Refinement::none means `secant` here
  int max_steps = 16384;    ///< >= 1

  bool operator==(const FixedStepSettings&) const = default;
};

/// `relaxed`: t += step_factor * h, stops where |h| < tolerance * t; t counted from t_min.
struct RelaxedSettings {
  double step_factor = 0.4;   ///< step as a fraction of the vertical distance h, > 0
  double tolerance = 0.0015;  ///< height off the ground that counts as a hit, per unit of distance, > 0
  int max_steps = 300;        ///< >= 1

  bool operator==(const RelaxedSettings&) const = default;
};

/// `lipschitz`: t += shrink * h, stops where shrink * h <= tolerance * t; t counted from t_min.
struct LipschitzSettings {
  double shrink = 0;  ///< step as a fraction of h, above 0 and at most 1; 0: 1 / sqrt(1 + c^2), c the slope bound
  double tolerance = 0.0005;  ///< distance to the ground that counts as a hit, per unit of distance travelled, >= 0
  int max_steps = 1024;       ///< >= 1

  bool operator==(const LipschitzSettings&) const = default;
};

/// `max-mip-bisect`: halvings of the interval in the finest cell.
struct BisectSettings {
  int halvings = 16;  ///< 1..60

  bool operator==(const BisectSettings&) const = default;
};

/// `lipschitz-local`.
struct LipschitzLocalSettings {
  double tolerance = 1e-6;  ///< length of the last interval, per unit of distance travelled, >= 0
  int max_steps = 1024;     ///< >= 1

  bool operator==(const LipschitzLocalSettings&) const = default;
};

/// `sphere-trace`: t += distance, closes in on the surface by segment bounds.
struct SphereTraceSettings {
  double tolerance = 1e-6;  ///< length of the last interval, per unit of distance travelled, >= 0
  int max_steps = 1024;     ///< >= 1

  bool operator==(const SphereTraceSettings&) const = default;
};

/// How naive, fixed-step and relaxed refine their last interval: from the last sample where the hit test failed to the
/// first where it holds.
enum class Refinement : std::uint8_t {
  none,    ///< the hit is the last sample
  secant,  ///< where the straight line through the two clearances crosses the limit of the test
  bisect,  ///< the interval is halved by the test
};

/// "none", "secant", "bisect".
std::string_view name_of(Refinement refinement);
/// Throws Error listing the names if the refinement is unknown.
Refinement find_refinement(std::string_view name);

/// Settings that naive, fixed-step and relaxed share.
struct SamplingSettings {
  Refinement refinement = Refinement::none;
  int halvings = 24;  ///< for `bisect`, 1..60
  /// Height in metres that counts as a hit for naive and relaxed at any distance, >= 0. Naive rays that start on the
  /// surface start within it: they hit only where they are deeper below ground.
  double tolerance = 0;

  bool operator==(const SamplingSettings&) const = default;
};

/// Settings that apply only to marches over terrain functions, which have neither cells nor borders.
struct FunctionMarchSettings {
  double reach = std::numeric_limits<double>::infinity();  ///< all marches: maximum length of a ray in metres, > 0
  double step = 5;                                         ///< fixed-step: step in metres, in place of cells, > 0
  double step_share = 0;  ///< fixed-step: minimum step as a fraction of the distance travelled, >= 0

  bool operator==(const FunctionMarchSettings&) const = default;
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

  bool operator==(const MarchSettings&) const = default;
};

/// The refinement of fixed-step: `interpolate` means a secant.
inline Refinement refinement_of_fixed_step(const MarchSettings& settings) {
  if (settings.sampling.refinement != Refinement::none) return settings.sampling.refinement;
  return settings.fixed_step.interpolate ? Refinement::secant : Refinement::none;
}

/// Throws Error naming the first setting out of range.
void validate(const MarchSettings& settings);

}  // namespace scarp
