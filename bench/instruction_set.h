// SPDX-License-Identifier: MIT
// The instruction set of the engines: the best that the machine has, or one that both Scarp and Embree are held to.
#pragma once

#include <string>
#include <string_view>

namespace scarp::bench {

/// "avx2", "avx512", or "native" for the best that each engine finds. To be called before any ray is traced. Throws
/// Error if the machine does not have it.
void hold_to_instruction_set(std::string_view name);

/// The name that is held to, and Highway's name of what Scarp runs: "avx512 (AVX3_DL)".
std::string instruction_set();

/// For rtcNewDevice.
const char* embree_configuration();

}  // namespace scarp::bench
