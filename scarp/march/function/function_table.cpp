// SPDX-License-Identifier: MIT
#include "scarp/march/function/function_table.h"

#include <array>

#include "scarp/march/find_entry.h"
#include "scarp/march/function/function_sampling.h"
#include "scarp/march/function/lipschitz_local.h"
#include "scarp/march/function/lipschitz_local_rules.h"
#include "scarp/march/function/lipschitz_local_simd.h"
#include "scarp/march/sampling/sampling_entries.h"

namespace scarp {
namespace {

// A row whose batch query traces one ray after another.
template <FunctionMarch march, FunctionMarchTraced traced = nullptr>
constexpr FunctionMarchEntry function_march(const MarchEntry& common) {
  FunctionMarchEntry entry{common};
  entry.cpu = march;
  entry.traced = traced;
  entry.batch = [](const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits,
                   const MarchSettings& settings, std::span<std::uint32_t> steps, FunctionUse use) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      MarchStats stats;
      hits[i] = march(function, rays[i], settings, &stats, use);
      if (!steps.empty()) steps[i] = stats.steps + stats.cell_tests;
    }
  };
  return entry;
}

constexpr FunctionMarchEntry lipschitz_local() {
  FunctionMarchEntry entry = function_march<march_lipschitz_local>(
      {.name = "lipschitz-local",
       .guarantee = Guarantee::conservative,
       .simd = true,
       .gpu = true,
       .parameters = "tolerance 0.000001 of the distance, 1024 steps",
       .description =
           "bounds the ground on each segment of the ray; never passes through; long steps over gentle ground"});
  entry.batch = closest_hits_lipschitz_local_simd;
  entry.filtered = march_lipschitz_local_filtered;
  return entry;
}

constexpr std::array kFunctionTable = {
    function_march<march_naive, traced_naive>(kNaiveEntry),
    function_march<march_fixed_step, traced_fixed_step>(kFixedStepEntry),
    function_march<march_relaxed, traced_relaxed>(kRelaxedEntry),
    function_march<march_lipschitz, traced_lipschitz>(kLipschitzEntry),
    lipschitz_local(),
};

}  // namespace

std::span<const FunctionMarchEntry> function_marches() { return kFunctionTable; }
const FunctionMarchEntry& find_function_march(std::string_view name) { return find_entry(function_marches(), name); }

}  // namespace scarp
