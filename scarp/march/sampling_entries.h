// SPDX-License-Identifier: MIT
// The shared columns of the techniques that march both height fields and terrain functions: rows of both tables.
#pragma once

#include "scarp/march/march_entry.h"

namespace scarp {

inline constexpr MarchEntry kNaiveEntry{
    .name = "naive",
    .guarantee = Guarantee::approximate,
    .gpu = true,
    .parameters = "step factor 0.7, least step 1/512 of the way out, tolerance 0.001 of the distance, 1024 steps",
    .description = "steps by the vertical distance to the ground; steps over steep ground"};

inline constexpr MarchEntry kFixedStepEntry{
    .name = "fixed-step",
    .guarantee = Guarantee::approximate,
    .gpu = true,
    .parameters = "step 0.5 cells (functions: 5 m), interpolating, 16384 steps",
    .description = "a sample at every step, a hit where one is not above; passes what is thinner than a step"};

inline constexpr MarchEntry kRelaxedEntry{
    .name = "relaxed",
    .guarantee = Guarantee::approximate,
    .gpu = true,
    .parameters = "step factor 0.4, tolerance 0.0015 of the distance, 300 steps",
    .description = "the shader writers' t += 0.4 h: closes in on calm ground, steps through steep ground"};

inline constexpr MarchEntry kLipschitzEntry{
    .name = "lipschitz",
    .guarantee = Guarantee::conservative,
    .gpu = true,
    .parameters = "shrink factor 1/sqrt(1 + c^2), c the slope bound, tolerance 0.0005 of the distance, 1024 steps",
    .description = "steps by a distance that the steepest slope allows; never passes, slow near steep ground"};

}  // namespace scarp
