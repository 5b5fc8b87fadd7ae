// SPDX-License-Identifier: MIT
// Colour tables of others, with their rights in ramp_tables.cpp.
#pragma once

#include <array>
#include <cstdint>

namespace scarp {

/// 256 colours from low to high, 0xRRGGBB in sRGB.
using RampTable = std::array<std::uint32_t, 256>;

extern const RampTable kViridis, kMagma, kInferno, kPlasma;

}  // namespace scarp
