// SPDX-License-Identifier: MIT
// The ONE table of marching techniques. Command line, benchmarks, tests and documentation all read it: a technique that
// is listed here is tested against the oracle from that moment on.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "scarp/accel/max_pyramid.h"
#include "scarp/base/ray.h"
#include "scarp/field/distance_field.h"
#include "scarp/field/height_field.h"
#include "scarp/field/height_function.h"
#include "scarp/march/voxel/voxel_packet.h"
#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

/// What a march promises about the surface that the field defines.
enum class Guarantee {
  exact,         ///< the first hit, never lost, within the rounding that doc/dev/numerics.md derives
  conservative,  ///< never passes through the surface; may stop before it or give up (exhausted)
  approximate,   ///< may pass through the surface or stop before it
};

std::string_view name_of(Guarantee guarantee);

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
  bool interpolate = true;  ///< whether the hit is put between the last two samples, or on the last
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

/// What an approximate march over a terrain function does with its last interval: from the sample before, where its
/// test for a hit failed, to the one where it holds.
enum class Refinement : std::uint8_t {
  none,    ///< the hit is the last sample
  secant,  ///< where the straight line through the two clearances meets the test's limit
  bisect,  ///< the interval is halved by the test
};

/// "none", "secant", "bisect".
std::string_view name_of(Refinement refinement);
/// Throws Error listing the names when there is no such refinement.
Refinement find_refinement(std::string_view name);

/// Of marches over terrain functions alone, which have no cells to measure by and no end.
struct FunctionMarchSettings {
  double reach = std::numeric_limits<double>::infinity();  ///< of all: metres that a ray is followed, > 0
  double step = 5;                                         ///< of fixed-step, in the place of its cells: metres, > 0
  double step_share = 0;  ///< of fixed-step: steps are at least this share of the distance travelled, >= 0
  double tolerance = 0;   ///< of naive and relaxed: metres off the ground that are a hit at any distance, >= 0
  Refinement refinement = Refinement::none;
  int halvings = 24;  ///< of `bisect`, 1..60
};

struct MarchSettings {
  NaiveSettings naive;
  FixedStepSettings fixed_step;
  RelaxedSettings relaxed;
  LipschitzSettings lipschitz;
  BisectSettings bisect;
  LipschitzLocalSettings lipschitz_local;
  FunctionMarchSettings function;
  SphereTraceSettings sphere_trace;
};

/// Throws Error naming the first setting out of its range.
void validate(const MarchSettings& settings);

/// What is marched. The pyramid may be null for marches that do not need one.
struct HeightTarget {
  const HeightField* field = nullptr;
  const MaxPyramid* pyramid = nullptr;
  /// slope_bound(*field), metres per metre; needed by marches with needs_slope.
  double slope = std::numeric_limits<double>::quiet_NaN();
};

/// A ray in world space against a height field: the closest hit. `stats`, when given, is overwritten.
using HeightMarch = Hit (*)(const HeightTarget& target, const Ray& ray, const MarchSettings& settings,
                            MarchStats* stats);

/// Whether the closest hit is a hit, without computing where.
using HeightOcclusion = bool (*)(const HeightTarget& target, const Ray& ray);

/// The two above for many rays, on the calling thread, answers bit for bit those for single rays. The spans have one
/// length.
using HeightMarchBatch = void (*)(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits);
using HeightOcclusionBatch = void (*)(const HeightTarget& target, std::span<const Ray> rays,
                                      std::span<std::uint8_t> blocked);

/// A ray against a terrain function: the closest hit. `stats`, when given, is overwritten.
using FunctionMarch = Hit (*)(const HeightFunction& function, const Ray& ray, const MarchSettings& settings,
                              MarchStats* stats, FunctionUse use);

/// The same for many rays, on the calling thread, answers bit for bit those for single rays; `steps`, when not empty,
/// are what each cost: its steps and cell tests. The spans have one length.
using FunctionMarchBatch = void (*)(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits,
                                    const MarchSettings& settings, std::span<std::uint32_t> steps, FunctionUse use);

/// A ray in world space against a distance field: the closest hit, and whether it is one.
using DistanceMarch = Hit (*)(const DistanceField& field, const Ray& ray, const MarchSettings& settings,
                              MarchStats* stats);
using DistanceOcclusion = bool (*)(const DistanceField& field, const Ray& ray, const MarchSettings& settings);

/// What a voxel march needs of VoxelTarget besides the grid.
enum class VoxelAccelerator { none, spheres, cubes, octants, bricks };

/// A row of the table.
struct MarchEntry {
  std::string_view name;    ///< as typed: "max-mip"
  std::string_view fields;  ///< kinds of field that it takes: "height field", "function", "voxel grid"
  Guarantee guarantee;
  bool needs_pyramid;
  bool needs_slope;                            ///< whether it asks for HeightTarget::slope
  HeightMarch cpu;                             ///< scalar C++; null: takes no height fields
  HeightOcclusion cpu_occluded;                ///< null: none of its own, ask cpu
  HeightMarchBatch simd;                       ///< many rays at once in vectors; null: none
  HeightOcclusionBatch simd_occluded;          ///< null: none
  bool gpu;                                    ///< whether a Vulkan realisation exists
  std::string_view parameters;                 ///< its settings with their defaults, for people
  std::string_view description;                ///< one line
  FunctionMarch function_cpu = nullptr;        ///< scalar C++ over terrain functions; null: takes none
  FunctionMarchBatch function_simd = nullptr;  ///< many rays at once in vectors; null: none
  // Those of voxel grids, which have none of the functions above.
  VoxelMarch voxel_cpu = nullptr;  ///< scalar C++
  VoxelOcclusion voxel_cpu_occluded = nullptr;
  VoxelPacketMarch voxel_simd = nullptr;  ///< up to 64 rays at once in vectors; null: none
  VoxelAccelerator voxel_accelerator = VoxelAccelerator::none;
  // Those of distance fields likewise.
  DistanceMarch distance_cpu = nullptr;
  DistanceOcclusion distance_cpu_occluded = nullptr;
};

/// The whole table: those of height fields alone, of height fields and functions, of functions alone, of voxel grids,
/// of distance fields.
std::span<const MarchEntry> marches();
/// The part of it that takes height fields, the oracle first.
std::span<const MarchEntry> height_marches();
/// The part of it that takes terrain functions; their judge is function_exhaustive.h.
std::span<const MarchEntry> function_marches();
/// The part that takes voxel grids, the oracle first.
std::span<const MarchEntry> voxel_marches();
/// The part that takes distance fields.
std::span<const MarchEntry> distance_marches();
/// Of height_marches(). Throws Error listing their names when there is no such march.
const MarchEntry& find_march(std::string_view name);
/// Of function_marches(), likewise.
const MarchEntry& find_function_march(std::string_view name);
/// Of voxel_marches(), likewise.
const MarchEntry& find_voxel_march(std::string_view name);
/// Of distance_marches(), likewise.
const MarchEntry& find_distance_march(std::string_view name);

}  // namespace scarp
