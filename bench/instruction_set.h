// SPDX-License-Identifier: MIT
// The instruction set of the engines: the best that the machine has, or one to which both Scarp and Embree are
// restricted.
#pragma once

#include <string>
#include <string_view>

namespace scarp::bench {

/// "avx2", "avx512", or "native" for the best that each engine finds. Call this before any ray is traced. Throws Error
/// if the machine lacks the set.
void hold_to_instruction_set(std::string_view name);

/// The selected name, and Highway's name for the set that Scarp uses: "avx512 (AVX3_DL)".
std::string instruction_set();

/// For rtcNewDevice.
const char* embree_configuration();

}  // namespace scarp::bench
