// SPDX-License-Identifier: MIT
// Private to the station: the codes of float samples as tables, for devices that lack the CPU's double precision.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/height_code.h"

namespace scarp {

/// Ceilings, then floors, of all codes, as keys: see max_pyramid.glsl.h. They say of every float what encode_above()
/// and encode_below() make of it, since both rise with the sample.
std::vector<std::uint32_t> code_tables(const HeightCode& code);

}  // namespace scarp
