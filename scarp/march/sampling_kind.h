// SPDX-License-Identifier: MIT
// How a technique steps along the ray.
#pragma once

#include <cstdint>

namespace scarp {

/// `none`: it walks cells, voxels or pieces of the ray.
enum class Sampling : std::uint8_t { none, naive, fixed_step, relaxed, lipschitz };

}  // namespace scarp
