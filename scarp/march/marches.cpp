// SPDX-License-Identifier: MIT
#include "scarp/march/marches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scarp/base/error.h"
#include "scarp/march/fixed_step.h"
#include "scarp/march/function/function_marches.h"
#include "scarp/march/function/lipschitz_local.h"
#include "scarp/march/function/lipschitz_local_simd.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_simd.h"
#include "scarp/march/lipschitz.h"
#include "scarp/march/naive.h"
#include "scarp/march/relaxed.h"
#include "scarp/march/shape/sphere_trace.h"
#include "scarp/march/voxel/voxel_bricks.h"
#include "scarp/march/voxel/voxel_cubes.h"
#include "scarp/march/voxel/voxel_exhaustive.h"
#include "scarp/march/voxel/voxel_octants.h"
#include "scarp/march/voxel/voxel_planes.h"
#include "scarp/march/voxel/voxel_spheres.h"

namespace scarp {
namespace {

// Kinds of field, as the table names them.
constexpr std::string_view kHeights = "height field", kFunctions = "function";
constexpr std::string_view kBoth = "height field, function";

// One that takes height fields by sampling, and terrain functions as well.
constexpr MarchEntry sampling_march(std::string_view name, Guarantee guarantee, bool by_slope, HeightMarch cpu,
                                    FunctionMarch function_cpu, std::string_view parameters,
                                    std::string_view description) {
  return {.name = name,
          .fields = kBoth,
          .guarantee = guarantee,
          .needs_pyramid = by_slope,
          .needs_slope = by_slope,
          .cpu = cpu,
          .cpu_occluded = nullptr,
          .simd = nullptr,
          .simd_occluded = nullptr,
          .gpu = true,
          .parameters = parameters,
          .description = description,
          .function_cpu = function_cpu};
}

constexpr MarchEntry function_march(std::string_view name, Guarantee guarantee, FunctionMarch cpu,
                                    FunctionMarchBatch simd, std::string_view parameters,
                                    std::string_view description) {
  MarchEntry entry{};
  entry.name = name, entry.fields = kFunctions, entry.guarantee = guarantee;
  entry.parameters = parameters, entry.description = description;
  entry.function_cpu = cpu, entry.function_simd = simd;
  entry.gpu = true;
  return entry;
}

constexpr MarchEntry voxel_march(std::string_view name, VoxelAccelerator needs, VoxelMarch cpu, VoxelOcclusion occluded,
                                 VoxelPacketMarch simd, std::string_view description) {
  MarchEntry entry{};
  entry.name = name, entry.fields = "voxel grid", entry.guarantee = Guarantee::exact;
  entry.description = description;
  entry.voxel_cpu = cpu, entry.voxel_cpu_occluded = occluded, entry.voxel_simd = simd, entry.voxel_accelerator = needs;
  return entry;
}

constexpr MarchEntry distance_march(std::string_view name, Guarantee guarantee, DistanceMarch cpu,
                                    DistanceOcclusion occluded, std::string_view parameters,
                                    std::string_view description) {
  MarchEntry entry{};
  entry.name = name, entry.fields = "distance field", entry.guarantee = guarantee;
  entry.parameters = parameters, entry.description = description;
  entry.distance_cpu = cpu;
  entry.distance_cpu_occluded = occluded;
  entry.gpu = true;
  return entry;
}

constexpr std::array kMarches = {
    MarchEntry{"exhaustive", kHeights, Guarantee::exact, false, false, march_exhaustive, nullptr, nullptr, nullptr,
               false, "", "every cell under the ray on its own, in double: the judge of the others, slow"},
    MarchEntry{"max-mip", kHeights, Guarantee::exact, true, false, march_max_mip, occluded_max_mip,
               closest_hits_max_mip_simd, occluded_max_mip_simd, true, "",
               "hierarchical walk through a maximum mipmap, closed form in the bilinear cell"},
    MarchEntry{"max-mip-bisect", kHeights, Guarantee::approximate, true, false, march_max_mip_bisect, nullptr, nullptr,
               nullptr, false, "16 halvings",
               "the same walk with the paper's binary search in the cell; passes rays that dip into a cell"},
    sampling_march("naive", Guarantee::approximate, false, march_naive, march_naive,
                   "step factor 0.7, least step 1/512 of the way out, tolerance 0.001 of the distance, 1024 steps",
                   "steps by the vertical distance to the ground; steps over steep ground"),
    sampling_march("fixed-step", Guarantee::approximate, false, march_fixed_step, march_fixed_step,
                   "step 0.5 cells (functions: 5 m), interpolating, 16384 steps",
                   "a sample at every step, a hit where one is not above; passes what is thinner than a step"),
    sampling_march("relaxed", Guarantee::approximate, false, march_relaxed, march_relaxed,
                   "step factor 0.4, tolerance 0.0015 of the distance, 300 steps",
                   "the shader writers' t += 0.4 h: closes in on calm ground, steps through steep ground"),
    sampling_march("lipschitz", Guarantee::conservative, true, march_lipschitz, march_lipschitz,
                   "shrink factor 1/sqrt(1 + c^2), c the slope bound, tolerance 0.0005 of the distance, 1024 steps",
                   "steps by a distance that the steepest slope allows; never passes, slow near steep ground"),
    function_march("lipschitz-local", Guarantee::conservative, march_lipschitz_local, closest_hits_lipschitz_local_simd,
                   "tolerance 0.000001 of the distance, 1024 steps",
                   "bounds the ground anew on every segment of the ray; never passes, long steps where it is calm"),
    voxel_march("voxel-exhaustive", VoxelAccelerator::none, march_voxel_exhaustive, nullptr, nullptr,
                "solid voxels one by one, in rationals: the judge of the voxel marches, slow"),
    voxel_march("voxel-planes", VoxelAccelerator::none, march_voxel_planes, occluded_voxel_planes,
                march_packet_voxel_planes, "from plane to plane, voxel by voxel"),
    voxel_march("voxel-spheres", VoxelAccelerator::spheres, march_voxel_spheres, occluded_voxel_spheres, nullptr,
                "over the empty sphere around each voxel"),
    voxel_march("voxel-cubes", VoxelAccelerator::cubes, march_voxel_cubes, occluded_voxel_cubes,
                march_packet_voxel_cubes, "out of the largest empty cube around each voxel"),
    voxel_march("voxel-octants", VoxelAccelerator::octants, march_voxel_octants, occluded_voxel_octants,
                march_packet_voxel_octants,
                "out of the largest empty cube ahead of each voxel, one for each octant of directions"),
    voxel_march("voxel-bricks", VoxelAccelerator::bricks, march_voxel_bricks, occluded_voxel_bricks,
                march_packet_voxel_bricks,
                "out of empty blocks of 2 to 16 voxels, told by bit masks; the smallest memory"),
    distance_march("sphere-trace", Guarantee::conservative, march_sphere_trace, occluded_sphere_trace,
                   "tolerance 1e-6 of the distance, 1024 steps",
                   "steps by the distance to the nearest surface, closes in by bounds of segments; never passes"),
};

// A run of rows for which `takes` holds.
template <class Takes>
constexpr std::span<const MarchEntry> run_of(Takes takes) {
  std::size_t begin = 0;
  while (!takes(kMarches[begin])) ++begin;
  std::size_t end = begin;
  while (end < kMarches.size() && takes(kMarches[end])) ++end;
  return std::span<const MarchEntry>(kMarches).subspan(begin, end - begin);
}

void require(bool good, std::string_view name, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("march setting {}: is {}; it must be {}", name, value, range));
}

// In the order of Refinement.
constexpr std::array<std::string_view, 3> kRefinements = {"none", "secant", "bisect"};

bool positive(double x) { return std::isfinite(x) && x > 0; }

const MarchEntry& find_in(std::span<const MarchEntry> entries, std::string_view name) {
  std::string names;
  for (const MarchEntry& entry : entries) {
    if (entry.name == name) return entry;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  }
  throw Error(fmt::format("march '{}': unknown; there are: {}", name, names));
}

}  // namespace

std::string_view name_of(Guarantee guarantee) {
  switch (guarantee) {
    case Guarantee::exact:
      return "exact";
    case Guarantee::conservative:
      return "conservative";
    case Guarantee::approximate:
      break;
  }
  return "approximate";
}

std::string_view name_of(Refinement refinement) { return kRefinements[static_cast<std::size_t>(refinement)]; }

Refinement find_refinement(std::string_view name) {
  const auto* found = std::find(kRefinements.begin(), kRefinements.end(), name);
  if (found == kRefinements.end()) {
    throw Error(fmt::format("refinement '{}': unknown; there are: {}", name, fmt::join(kRefinements, ", ")));
  }
  return static_cast<Refinement>(found - kRefinements.begin());
}

void validate(const MarchSettings& settings) {
  const auto& naive = settings.naive;
  require(positive(naive.step_factor), "naive step factor", naive.step_factor, "above 0");
  require(positive(naive.min_step) && naive.min_step <= 1, "naive least step", naive.min_step, "above 0 and at most 1");
  require(std::isfinite(naive.tolerance) && naive.tolerance >= 0, "naive tolerance", naive.tolerance, "0 or more");
  require(naive.max_steps >= 1, "naive step limit", naive.max_steps, "1 or more");
  const auto& fixed_step = settings.fixed_step;
  require(positive(fixed_step.step), "fixed-step step", fixed_step.step, "above 0");
  require(fixed_step.max_steps >= 1, "fixed-step step limit", fixed_step.max_steps, "1 or more");
  const auto& relaxed = settings.relaxed;
  require(positive(relaxed.step_factor), "relaxed step factor", relaxed.step_factor, "above 0");
  require(positive(relaxed.tolerance) || (relaxed.tolerance == 0 && settings.function.tolerance > 0),
          "relaxed tolerance", relaxed.tolerance, "above 0, or 0 with a function tolerance above 0");
  require(relaxed.max_steps >= 1, "relaxed step limit", relaxed.max_steps, "1 or more");
  const auto& lipschitz = settings.lipschitz;
  require(lipschitz.shrink >= 0 && lipschitz.shrink <= 1, "lipschitz shrink factor", lipschitz.shrink,
          "above 0 and at most 1, or 0 for that of the slope bound");
  require(std::isfinite(lipschitz.tolerance) && lipschitz.tolerance >= 0, "lipschitz tolerance", lipschitz.tolerance,
          "0 or more");
  require(lipschitz.max_steps >= 1, "lipschitz step limit", lipschitz.max_steps, "1 or more");
  const auto& local = settings.lipschitz_local;
  require(std::isfinite(local.tolerance) && local.tolerance >= 0, "lipschitz-local tolerance", local.tolerance,
          "0 or more");
  require(local.max_steps >= 1, "lipschitz-local step limit", local.max_steps, "1 or more");
  const auto& function = settings.function;
  require(function.reach > 0, "function reach", function.reach, "above 0 metres");
  require(positive(function.step), "function step", function.step, "above 0 metres");
  require(std::isfinite(function.step_share) && function.step_share >= 0, "function step share", function.step_share,
          "0 or more");
  require(std::isfinite(function.tolerance) && function.tolerance >= 0, "function tolerance", function.tolerance,
          "0 or more metres");
  require(function.halvings >= 1 && function.halvings <= 60, "function halvings", function.halvings, "1 to 60");
  const auto& sphere_trace = settings.sphere_trace;
  require(std::isfinite(sphere_trace.tolerance) && sphere_trace.tolerance >= 0, "sphere-trace tolerance",
          sphere_trace.tolerance, "0 or more");
  require(sphere_trace.max_steps >= 1, "sphere-trace step limit", sphere_trace.max_steps, "1 or more");
  require(settings.bisect.halvings >= 1 && settings.bisect.halvings <= 60, "bisect halvings", settings.bisect.halvings,
          "1 to 60");
}

std::span<const MarchEntry> marches() { return kMarches; }
std::span<const MarchEntry> height_marches() {
  return run_of([](const MarchEntry& entry) { return entry.cpu != nullptr; });
}
std::span<const MarchEntry> function_marches() {
  return run_of([](const MarchEntry& entry) { return entry.function_cpu != nullptr; });
}
std::span<const MarchEntry> voxel_marches() {
  return run_of([](const MarchEntry& entry) { return entry.voxel_cpu != nullptr; });
}
std::span<const MarchEntry> distance_marches() {
  return run_of([](const MarchEntry& entry) { return entry.distance_cpu != nullptr; });
}

const MarchEntry& find_march(std::string_view name) { return find_in(height_marches(), name); }
const MarchEntry& find_function_march(std::string_view name) { return find_in(function_marches(), name); }
const MarchEntry& find_voxel_march(std::string_view name) { return find_in(voxel_marches(), name); }
const MarchEntry& find_distance_march(std::string_view name) { return find_in(distance_marches(), name); }

}  // namespace scarp
