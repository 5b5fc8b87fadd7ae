// SPDX-License-Identifier: MIT
// The marches of terrain functions. Their oracle is function_exhaustive.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_entry.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// The closest hit of a ray. `stats`, unless null, is overwritten.
using FunctionMarch = Hit (*)(const HeightFunction& function, const Ray& ray, const MarchSettings& settings,
                              MarchStats* stats, FunctionUse use);

/// The same for many rays, on the calling thread; the answers are bit for bit those for single rays. `steps`, unless
/// empty, receives the cost of each ray: its steps and cell tests. The spans have the same length.
using FunctionMarchBatch = void (*)(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits,
                                    const MarchSettings& settings, std::span<std::uint32_t> steps, FunctionUse use);

/// A row. No function is null: a technique without a batch query of its own has one made of `cpu`.
struct FunctionMarchEntry : MarchEntry {
  FunctionMarch cpu = nullptr;         ///< scalar C++
  FunctionMarchBatch batch = nullptr;  ///< in vectors if `simd`
};

std::span<const FunctionMarchEntry> function_marches();
/// Throws Error listing the names when there is no such march.
const FunctionMarchEntry& find_function_march(std::string_view name);

}  // namespace scarp
