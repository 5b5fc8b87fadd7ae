// SPDX-License-Identifier: MIT
// The marches of terrain functions. Their oracle is function_exhaustive.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/hit_rules.h"
#include "scarp/march/march_entry.h"
#include "scarp/march/march_settings.h"

namespace scarp {

struct MarchTrace;  // base/march_trace.h

/// Returns the closest hit of a ray. Overwrites `stats` unless null.
using FunctionMarch = Hit (*)(const HeightFunction& function, const Ray& ray, const MarchSettings& settings,
                              MarchStats* stats, FunctionUse use);

/// The same for many rays, on the calling thread; the answers are bit-identical to those for single rays. `steps`,
/// unless empty, receives the cost of each ray: its steps and cell tests. The spans have the same length.
using FunctionMarchBatch = void (*)(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits,
                                    const MarchSettings& settings, std::span<std::uint32_t> steps, FunctionUse use);

/// The closest hit that the filter accepts; see lipschitz_local_rules.h.
using FunctionMarchFiltered = Hit (*)(const HeightFunction& function, const HeightFunction& below, const Ray& ray,
                                      const HitFilter& accept, const MarchSettings& settings, MarchStats* stats);

/// The closest hit, for FunctionUse::march; `trace` receives the steps of the march. Overwrites `stats` unless null.
using FunctionMarchTraced = Hit (*)(const HeightFunction& function, const Ray& ray, const MarchSettings& settings,
                                    MarchStats* stats, MarchTrace& trace);

/// A row of the table. Only `filtered` and `traced` may be null: a technique without its own batch query gets one based
/// on `cpu`.
struct FunctionMarchEntry : MarchEntry {
  FunctionMarch cpu = nullptr;         ///< scalar C++
  FunctionMarchBatch batch = nullptr;  ///< in vectors if `simd`
  /// Null if the march cannot continue behind a rejected hit.
  FunctionMarchFiltered filtered = nullptr;
  FunctionMarchTraced traced = nullptr;  ///< null if the march records nothing
};

std::span<const FunctionMarchEntry> function_marches();
/// Throws Error listing the names if the march is unknown.
const FunctionMarchEntry& find_function_march(std::string_view name);

}  // namespace scarp
