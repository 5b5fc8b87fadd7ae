// SPDX-License-Identifier: MIT
// The shared columns of the techniques that march both height fields and terrain functions: rows of both tables.
#pragma once

#include "scarp/march/march_entry.h"

namespace scarp {

inline constexpr MarchEntry kNaiveEntry{
    .name = "naive",
    .guarantee = Guarantee::approximate,
    .sampling = Sampling::naive,
    .gpu = true,
    .parameters =
        "step factor 0.7, minimum step 1/512 of the exit distance, tolerance 0.001 of the distance, 1024 steps",
    .description = "steps by the vertical distance to the ground; passes through steep ground"};

inline constexpr MarchEntry kFixedStepEntry{
    .name = "fixed-step",
    .guarantee = Guarantee::approximate,
    .sampling = Sampling::fixed_step,
    .gpu = true,
    .parameters = "step 0.5 cells (functions: 5 m), interpolating, 16384 steps",
    .description = "constant step; hits at the first sample not above ground; misses features thinner than a step"};

inline constexpr MarchEntry kRelaxedEntry{
    .name = "relaxed",
    .guarantee = Guarantee::approximate,
    .sampling = Sampling::relaxed,
    .gpu = true,
    .parameters = "step factor 0.4, tolerance 0.0015 of the distance, 300 steps",
    .description = "steps by t += 0.4 h, common in shaders; converges on gentle ground, passes through steep ground"};

inline constexpr MarchEntry kLipschitzEntry{
    .name = "lipschitz",
    .guarantee = Guarantee::conservative,
    .sampling = Sampling::lipschitz,
    .gpu = true,
    .parameters = "shrink factor 1/sqrt(1 + c^2), c the slope bound, tolerance 0.0005 of the distance, 1024 steps",
    .description =
        "steps by the distance that the steepest slope allows; never passes through; slow near steep ground; "
        "approximate with a larger shrink factor"};

}  // namespace scarp
