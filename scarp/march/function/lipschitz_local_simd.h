// SPDX-License-Identifier: MIT
// `lipschitz-local` for many rays in vectors: dozens of walks (lipschitz_local_walk.h) are in progress at once. Their
// queries are answered together, one walk per vector lane (function_simd_taylor.h).
//
//   walks    w0 w1 w2 w3 w4 w5 ...       bounds   [ w0 w2 w3 w5 | w8 ... ]     a finished walk makes room
//            each has one query          heights  [ w1 w4 ... ]              for the next ray
//
// Answers and counts equal those of single rays bit for bit.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Sets hits[i] to march_lipschitz_local() of rays[i], bit for bit, and steps[i], unless the span is empty, to the sum
/// of steps and cell tests in its stats. Runs on the calling thread; the spans have equal lengths.
void closest_hits_lipschitz_local_simd(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits,
                                       const MarchSettings& settings, std::span<std::uint32_t> steps, FunctionUse use);

}  // namespace scarp
