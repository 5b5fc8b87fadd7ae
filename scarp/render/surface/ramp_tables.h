// SPDX-License-Identifier: MIT
// Third-party colour tables; ramp_tables.cpp states their licences.
#pragma once

#include <array>
#include <cstdint>

namespace scarp {

/// 256 colours from low to high, 0xRRGGBB in sRGB.
using RampTable = std::array<std::uint32_t, 256>;

extern const RampTable kViridis, kMagma, kInferno, kPlasma;

}  // namespace scarp
