// SPDX-License-Identifier: MIT
#include "scarp/march/height/height_table.h"

#include <array>

#include "scarp/march/find_entry.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/height_sampling.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_easy.h"
#include "scarp/march/height/max_mip_simd.h"
#include "scarp/march/sampling/sampling_entries.h"

namespace scarp {
namespace {

// A row whose any-hit and batch queries call the closest-hit query ray by ray.
template <HeightMarch march, HeightMarchTraced traced = nullptr>
constexpr HeightMarchEntry height_march(const MarchEntry& common, bool needs_pyramid, bool needs_slope) {
  HeightMarchEntry entry{common};
  entry.needs_pyramid = needs_pyramid;
  entry.needs_slope = needs_slope;
  entry.cpu = march;
  entry.traced = traced;
  entry.occluded = [](const HeightTarget& target, const Ray& ray, const MarchSettings& settings) {
    return march(target, ray, settings, nullptr).status == HitStatus::hit;
  };
  entry.batch = [](const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                   const MarchSettings& settings) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = march(target, rays[i], settings, nullptr);
  };
  entry.occluded_batch = [](const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                            const MarchSettings& settings) {
    for (std::size_t i = 0; i < rays.size(); ++i)
      blocked[i] = march(target, rays[i], settings, nullptr).status == HitStatus::hit;
  };
  return entry;
}

constexpr HeightMarchEntry max_mip() {
  HeightMarchEntry entry = height_march<march_max_mip, traced_max_mip>(
      {.name = "max-mip",
       .guarantee = Guarantee::exact,
       .simd = true,
       .gpu = true,
       .description = "hierarchical walk through a maximum mipmap; closed-form hit in the bilinear cell"},
      true, false);
  entry.own_any_hit = true;
  entry.fans = true;
  entry.by_rules = march_max_mip_by_rules;
  entry.all_hits = all_hits_max_mip;
  entry.occluded = [](const HeightTarget& target, const Ray& ray, const MarchSettings&) {
    return occluded_max_mip(target, ray);
  };
  entry.batch = [](const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits, const MarchSettings&) {
    closest_hits_max_mip_simd(target, rays, hits);
  };
  entry.occluded_batch = [](const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                            const MarchSettings&) { occluded_max_mip_simd(target, rays, blocked); };
  return entry;
}

constexpr HeightMarchEntry max_mip_easy() {
  HeightMarchEntry entry = height_march<march_max_mip_easy>(
      {.name = "max-mip-easy",
       .guarantee = Guarantee::conservative,
       .description = "max-mip as a short text to paste into shaders; bilinear ground without holes or wrap; floats"},
      true, false);
  entry.fields = HeightFields::plain;
  entry.follows_below = false;
  return entry;
}

constexpr HeightMarchEntry exhaustive() {
  HeightMarchEntry entry = height_march<march_exhaustive>(
      {.name = "exhaustive",
       .guarantee = Guarantee::exact,
       .description = "tests every cell under the ray, in double; the reference for the others; slow"},
      false, false);
  entry.by_rules = march_exhaustive_by_rules;
  entry.all_hits = all_hits_exhaustive;
  return entry;
}

constexpr std::array kHeightTable = {
    exhaustive(),
    max_mip(),
    height_march<march_max_mip_bisect, traced_max_mip_bisect>(
        {.name = "max-mip-bisect",
         .guarantee = Guarantee::approximate,
         .parameters = "16 halvings",
         .description =
             "the same walk with the paper's binary search in the cell; misses rays that only dip into a cell"},
        true, false),
    max_mip_easy(),
    height_march<march_naive, traced_naive>(kNaiveEntry, false, false),
    height_march<march_fixed_step, traced_fixed_step>(kFixedStepEntry, false, false),
    height_march<march_relaxed, traced_relaxed>(kRelaxedEntry, false, false),
    height_march<march_lipschitz, traced_lipschitz>(kLipschitzEntry, true, true),
};

}  // namespace

std::span<const HeightMarchEntry> height_marches() { return kHeightTable; }
const HeightMarchEntry& find_height_march(std::string_view name) { return find_entry(height_marches(), name); }

}  // namespace scarp
