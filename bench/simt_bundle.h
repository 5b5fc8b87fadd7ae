// SPDX-License-Identifier: MIT
// Rays in lockstep: the cost of a bundle of rays on a device whose lanes share one instruction stream.
//
//   SimtTrace of each ray ──▶ replay: loops run until the slowest ray is done, ──▶ SimtBundle
//                             a block is paid for if any ray enters it
//
// Lanes reconverge after each branch and after each loop, nested loops included. Compilers for such devices translate
// structured control flow in this way.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/simt_blocks.h"

namespace scarp::bench {

/// The trace of one ray: the blocks that it entered, each followed by the addresses that it read, in order.
class SimtTrace {
 public:
  void enter(SimtBlock block) { events_.push_back(kBlockBit | static_cast<std::uint64_t>(block)); }
  /// Records a read of at most 16 bytes by one instruction; the address must be below 2^56.
  void fetch(std::uint64_t address, std::uint64_t bytes) { events_.push_back(address | bytes << kBytesShift); }
  void clear() { events_.clear(); }

  static constexpr std::uint64_t kBlockBit = std::uint64_t{1} << 63;
  static constexpr int kBytesShift = 56;
  const std::vector<std::uint64_t>& events() const { return events_; }

 private:
  std::vector<std::uint64_t> events_;
};

/// Sizes of a cache line, in bytes.
inline constexpr std::array<int, 2> kCacheLines = {128, 64};

/// The cost of a bundle, or the sum of several bundles.
struct SimtBundle {
  std::array<std::uint64_t, kSimtBlocks> runs{};          ///< times that a block was paid for
  std::array<std::uint64_t, kSimtBlocks> lanes{};         ///< the same, summed over the rays that entered it
  std::uint64_t fetches = 0;                              ///< instructions that read the ground
  std::array<std::uint64_t, kCacheLines.size()> lines{};  ///< distinct cache lines of each, summed

  std::uint64_t of(SimtBlock block) const { return runs[static_cast<std::size_t>(block)]; }
  SimtBundle& operator+=(const SimtBundle& other);
};

/// Replays rays as one bundle; `begin` and `end` are paid for once.
SimtBundle replay(std::span<const SimtTrace> lanes);

/// Instructions and other costs of bundles in a shader.
struct SimtSum {
  std::uint64_t instructions = 0, vector = 0, memory = 0;
};
SimtSum cost_of(const SimtBundle& bundle, const SimtShader& shader);

}  // namespace scarp::bench
