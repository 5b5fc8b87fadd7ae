// SPDX-License-Identifier: MIT
// Private to the station: limits that several fields and queries share.
#pragma once

#include <cstdint>

namespace scarp {

/// Number of rays of a batch that a thread takes at a time.
inline constexpr std::int64_t kRaysPerPiece = 512;
/// Step limit of marches that judge others.
inline constexpr int kStepsOfJudge = 1 << 20;

}  // namespace scarp
