// SPDX-License-Identifier: MIT
#include "scarp/march/marches.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "scarp/base/error.h"
#include "scarp/march/exhaustive.h"
#include "scarp/march/fixed_step.h"
#include "scarp/march/lipschitz.h"
#include "scarp/march/max_mip.h"
#include "scarp/march/max_mip_simd.h"
#include "scarp/march/naive.h"
#include "scarp/march/relaxed.h"
#include "scarp/march/sphere_trace.h"
#include "scarp/march/voxel_bricks.h"
#include "scarp/march/voxel_cubes.h"
#include "scarp/march/voxel_exhaustive.h"
#include "scarp/march/voxel_octants.h"
#include "scarp/march/voxel_planes.h"
#include "scarp/march/voxel_spheres.h"

namespace scarp {
namespace {

constexpr MarchEntry voxel_march(std::string_view name, VoxelAccelerator needs, VoxelMarch cpu, VoxelOcclusion occluded,
                                 std::string_view description) {
  return {name,  "voxel grid", Guarantee::exact, false, false,    nullptr, nullptr, nullptr, nullptr,
          false, "",           description,      cpu,   occluded, needs};
}

constexpr MarchEntry distance_march(std::string_view name, Guarantee guarantee, DistanceMarch cpu,
                                    DistanceOcclusion occluded, std::string_view parameters,
                                    std::string_view description) {
  MarchEntry entry{name,    "distance field", guarantee, false, false,      nullptr,
                   nullptr, nullptr,          nullptr,   false, parameters, description};
  entry.distance_cpu = cpu;
  entry.distance_cpu_occluded = occluded;
  return entry;
}

constexpr std::array kMarches = {
    MarchEntry{"exhaustive", "height field", Guarantee::exact, false, false, march_exhaustive, nullptr, nullptr,
               nullptr, false, "", "every cell under the ray on its own, in double: the judge of the others, slow"},
    MarchEntry{"naive", "height field", Guarantee::approximate, false, false, march_naive, nullptr, nullptr, nullptr,
               true, "step factor 0.7, least step 1/512 of the way out, tolerance 0.001 of the distance, 1024 steps",
               "steps by the vertical distance to the ground; steps over steep ground"},
    MarchEntry{"fixed-step", "height field", Guarantee::approximate, false, false, march_fixed_step, nullptr, nullptr,
               nullptr, true, "step 0.5 cells, interpolating, 16384 steps",
               "a sample at every step, a hit where one is not above; passes what is thinner than a step"},
    MarchEntry{"relaxed", "height field", Guarantee::approximate, false, false, march_relaxed, nullptr, nullptr,
               nullptr, true, "step factor 0.4, tolerance 0.0015 of the distance, 300 steps",
               "the shader writers' t += 0.4 h: closes in on calm ground, steps through steep ground"},
    MarchEntry{"lipschitz", "height field", Guarantee::conservative, true, true, march_lipschitz, nullptr, nullptr,
               nullptr, true,
               "shrink factor 1/sqrt(1 + c^2), c the slope bound, tolerance 0.0005 of the distance, 1024 steps",
               "steps by a distance that the steepest slope allows; never passes, slow near steep ground"},
    MarchEntry{"max-mip", "height field", Guarantee::exact, true, false, march_max_mip, occluded_max_mip,
               closest_hits_max_mip_simd, occluded_max_mip_simd, true, "",
               "hierarchical walk through a maximum mipmap, closed form in the bilinear cell"},
    MarchEntry{"max-mip-bisect", "height field", Guarantee::approximate, true, false, march_max_mip_bisect, nullptr,
               nullptr, nullptr, false, "16 halvings",
               "the same walk with the paper's binary search in the cell; passes rays that dip into a cell"},
    voxel_march("voxel-exhaustive", VoxelAccelerator::none, march_voxel_exhaustive, nullptr,
                "every solid voxel on its own, in rationals: the judge of the voxel marches, slow"),
    voxel_march("voxel-planes", VoxelAccelerator::none, march_voxel_planes, occluded_voxel_planes,
                "from plane to plane, voxel by voxel"),
    voxel_march("voxel-spheres", VoxelAccelerator::spheres, march_voxel_spheres, occluded_voxel_spheres,
                "over the empty sphere around each voxel"),
    voxel_march("voxel-cubes", VoxelAccelerator::cubes, march_voxel_cubes, occluded_voxel_cubes,
                "out of the largest empty cube around each voxel"),
    voxel_march("voxel-octants", VoxelAccelerator::octants, march_voxel_octants, occluded_voxel_octants,
                "out of the largest empty cube ahead of each voxel, one for each octant of directions"),
    voxel_march("voxel-bricks", VoxelAccelerator::bricks, march_voxel_bricks, occluded_voxel_bricks,
                "out of empty blocks of 2 to 16 voxels, told by bit masks; the smallest memory"),
    distance_march("sphere-trace", Guarantee::conservative, march_sphere_trace, occluded_sphere_trace,
                   "tolerance 1e-6 of the distance, 1024 steps",
                   "steps by the distance to the nearest surface, closes in by bounds of segments; never passes"),
};

// How many rows there are of a kind, which stand together.
constexpr std::size_t count_of(std::string_view fields) {
  std::size_t count = 0;
  for (const MarchEntry& march : kMarches) count += march.fields == fields;
  return count;
}
constexpr std::size_t kHeightMarches = count_of("height field"), kVoxelMarches = count_of("voxel grid");

void require(bool good, std::string_view name, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("march setting {}: is {}; it must be {}", name, value, range));
}

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
  require(positive(relaxed.tolerance), "relaxed tolerance", relaxed.tolerance, "above 0");
  require(relaxed.max_steps >= 1, "relaxed step limit", relaxed.max_steps, "1 or more");
  const auto& lipschitz = settings.lipschitz;
  require(lipschitz.shrink >= 0 && lipschitz.shrink <= 1, "lipschitz shrink factor", lipschitz.shrink,
          "above 0 and at most 1, or 0 for that of the slope bound");
  require(std::isfinite(lipschitz.tolerance) && lipschitz.tolerance >= 0, "lipschitz tolerance", lipschitz.tolerance,
          "0 or more");
  require(lipschitz.max_steps >= 1, "lipschitz step limit", lipschitz.max_steps, "1 or more");
  const auto& sphere_trace = settings.sphere_trace;
  require(std::isfinite(sphere_trace.tolerance) && sphere_trace.tolerance >= 0, "sphere-trace tolerance",
          sphere_trace.tolerance, "0 or more");
  require(sphere_trace.max_steps >= 1, "sphere-trace step limit", sphere_trace.max_steps, "1 or more");
  require(settings.bisect.halvings >= 1 && settings.bisect.halvings <= 60, "bisect halvings", settings.bisect.halvings,
          "1 to 60");
}

std::span<const MarchEntry> marches() { return kMarches; }
std::span<const MarchEntry> height_marches() { return marches().first(kHeightMarches); }
std::span<const MarchEntry> voxel_marches() { return marches().subspan(kHeightMarches, kVoxelMarches); }
std::span<const MarchEntry> distance_marches() { return marches().subspan(kHeightMarches + kVoxelMarches); }

const MarchEntry& find_march(std::string_view name) { return find_in(height_marches(), name); }
const MarchEntry& find_voxel_march(std::string_view name) { return find_in(voxel_marches(), name); }
const MarchEntry& find_distance_march(std::string_view name) { return find_in(distance_marches(), name); }

}  // namespace scarp
