// SPDX-License-Identifier: MIT
// Private to scarp/accel: height codes of float samples as tables, for devices without double precision.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/height_code.h"

namespace scarp {

/// Returns ceilings, then floors, of all codes, as keys (see max_pyramid.glsl.h). Both encode_above() and
/// encode_below() are monotone in the sample, so the tables determine the code of every float.
std::vector<std::uint32_t> code_tables(const HeightCode& code);

}  // namespace scarp
