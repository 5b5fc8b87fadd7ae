// SPDX-License-Identifier: MIT
// Private to the station: rays of a batch that wait at tiles. All rays at a tile are traced together; those that go on
// join the queue of the next one.
//
//   tile 3   r0 r1 r4 r5        1st turn: r0, r4 hit; r1, r5 go on to tile 4
//   tile 4   r2 r3 | r1 r5      2nd turn: all four together
//
// Source: M. Pharr, C. Kolb, R. Gershbein, P. Hanrahan, "Rendering complex scenes with memory-coherent ray tracing",
// SIGGRAPH 1997.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scarp/base/kept_memory.h"

namespace scarp {

template <class Entry>
class TileQueues {
 public:
  /// `tiles`: number of tiles, whose numbers are below it.
  explicit TileQueues(std::int64_t tiles) {
    if (tiles <= kMostListed) listed_.resize(static_cast<std::size_t>(tiles));
  }

  void push(std::uint32_t tile, const Entry& entry) { queue_of(tile).entries.push_back(entry); }

  /// Calls drain(tile, entries) for all queues, in turns, until they are empty. `drain` may push.
  template <class Drain>
  void run(const Drain& drain) {
    std::vector<Entry> entries;
    for (bool any = true; any;) {
      any = false;
      // By index: `drain` may add queues.
      for (std::size_t i = 0; i < queues_.size(); ++i) {
        if (queues_[i].entries.empty()) continue;
        any = true;
        entries.clear();
        entries.swap(queues_[i].entries);
        drain(queues_[i].tile, entries);
      }
    }
  }

 private:
  struct Queue {
    std::uint32_t tile;
    std::vector<Entry> entries{};
  };
  static constexpr std::int64_t kMostListed = 4096;

  Queue& queue_of(std::uint32_t tile) {
    if (last_ < queues_.size() && queues_[last_].tile == tile) return queues_[last_];
    std::uint32_t& place = listed_.empty() ? found_[tile] : listed_[tile];
    if (place == 0) {
      queues_.push_back({tile});
      place = static_cast<std::uint32_t>(queues_.size());
    }
    last_ = place - 1;
    return queues_[last_];
  }

  std::vector<Queue> queues_;
  std::size_t last_ = 0;
  KeptVector<std::uint32_t> listed_;                        // 1 + index of a tile's queue; 0: it has none
  std::unordered_map<std::uint32_t, std::uint32_t> found_;  // the same for many tiles
};

}  // namespace scarp
