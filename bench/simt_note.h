// SPDX-License-Identifier: MIT
// The record of the ray that is being traced, for files that compile the shaders' text as C++. To be included before
// any of that text: it defines SCARP_COUNT.
#pragma once

#define SCARP_COUNT(block) ::scarp::bench::note_block(::scarp::bench::SimtBlock::block)

#include "bench/simt_bundle.h"

namespace scarp::bench {

/// Null: nothing is noted.
inline thread_local SimtTrace* noted = nullptr;

inline void note_block(SimtBlock block) {
  if (noted) noted->enter(block);
}
inline void note_fetch(std::uint64_t address, std::uint64_t bytes) {
  if (noted) noted->fetch(address, bytes);
}

}  // namespace scarp::bench
