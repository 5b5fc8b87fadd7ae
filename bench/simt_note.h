// SPDX-License-Identifier: MIT
// The record of the current ray, for files that compile the shader source as C++. Include this before any shader
// source: it defines SCARP_COUNT.
#pragma once

#define SCARP_COUNT(block) ::scarp::bench::note_block(::scarp::bench::SimtBlock::block)

#include "bench/simt_bundle.h"

namespace scarp::bench {

/// Null: nothing is recorded.
inline thread_local SimtTrace* noted = nullptr;

inline void note_block(SimtBlock block) {
  if (noted) noted->enter(block);
}
inline void note_fetch(std::uint64_t address, std::uint64_t bytes) {
  if (noted) noted->fetch(address, bytes);
}

}  // namespace scarp::bench
