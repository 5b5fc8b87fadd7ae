// SPDX-License-Identifier: MIT
#include "bench/simt_bundle.h"

#include <algorithm>

#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

// A ray and its position in its trace.
struct Lane {
  const std::uint64_t* next;
  const std::uint64_t* end;

  bool at_block() const { return next != end && (*next & SimtTrace::kBlockBit) != 0; }
  SimtBlock block() const { return static_cast<SimtBlock>(*next & ~SimtTrace::kBlockBit); }
  bool at_head(int depth) const { return at_block() && nesting(block()).head && nesting(block()).depth == depth; }
};
using Lanes = std::vector<Lane*>;

class Replay {
 public:
  explicit Replay(std::span<const SimtTrace> traces) {
    std::vector<Lane> all;
    for (const SimtTrace& trace : traces) {
      const std::uint64_t* const begin = trace.events().data();
      all.push_back({begin, begin + trace.events().size()});
    }
    Lanes lanes;
    for (Lane& lane : all) lanes.push_back(&lane);
    pay(SimtBlock::begin, lanes.size());
    straight(0, lanes);
    loop(1, lanes);
    straight(0, lanes);
    pay(SimtBlock::end, lanes.size());
    // Blocks must be in the order of their nesting; otherwise this is not the trace of a shader.
    if (std::any_of(all.begin(), all.end(), [](const Lane& lane) { return lane.next != lane.end; }))
      throw Error("simt: a trace has a block outside of its loop");
  }

  const SimtBundle& sum() const { return sum_; }

 private:
  // Iterations of a loop until no lane starts another one.
  void loop(int depth, const Lanes& lanes) {
    Lanes active = lanes;
    for (;;) {
      std::erase_if(active, [&](const Lane* lane) { return !lane->at_head(depth); });
      if (active.empty()) return;
      for (Lane* lane : active) enter(*lane);
      straight(depth, active);
      loop(depth + 1, active);
      straight(depth, active);
    }
  }

  // The blocks of a loop's body up to an inner loop or the next iteration.
  void straight(int depth, const Lanes& lanes) {
    for (Lane* lane : lanes) {
      while (lane->at_block() && !nesting(lane->block()).head && nesting(lane->block()).depth == depth) enter(*lane);
    }
    for (std::size_t block = 0; block < kSimtBlocks; ++block) {
      if (entered_[block] == 0) continue;
      pay(static_cast<SimtBlock>(block), entered_[block]);
      entered_[block] = 0;
      for (std::vector<std::uint64_t>& fetches : fetched_[block]) {
        if (!fetches.empty()) pay_fetch(fetches);
        fetches.clear();
      }
    }
  }

  // Consumes one block of a lane and its fetches.
  void enter(Lane& lane) {
    const auto block = static_cast<std::size_t>(lane.block());
    ++entered_[block];
    ++lane.next;
    auto& fetched = fetched_[block];
    for (std::size_t k = 0; lane.next != lane.end && !lane.at_block(); ++k, ++lane.next) {
      if (k == fetched.size()) fetched.emplace_back();
      fetched[k].push_back(*lane.next);
    }
  }

  void pay(SimtBlock block, std::size_t lanes) {
    sum_.runs[static_cast<std::size_t>(block)] += 1;
    sum_.lanes[static_cast<std::size_t>(block)] += lanes;
  }

  // Addresses of one instruction in all lanes.
  void pay_fetch(const std::vector<std::uint64_t>& fetches) {
    ++sum_.fetches;
    for (std::size_t k = 0; k < kCacheLines.size(); ++k) {
      lines_.clear();
      for (const std::uint64_t fetch : fetches) {
        const std::uint64_t address = fetch & ((std::uint64_t{1} << SimtTrace::kBytesShift) - 1),
                            last = address + (fetch >> SimtTrace::kBytesShift) - 1;
        const auto bytes = static_cast<std::uint64_t>(kCacheLines[k]);
        lines_.push_back(address / bytes);
        if (last / bytes != address / bytes) lines_.push_back(last / bytes);
      }
      std::sort(lines_.begin(), lines_.end());
      sum_.lines[k] += static_cast<std::uint64_t>(std::unique(lines_.begin(), lines_.end()) - lines_.begin());
    }
  }

  SimtBundle sum_;
  std::array<std::size_t, kSimtBlocks> entered_{};
  // By block and by the number of the fetch in it.
  std::array<std::vector<std::vector<std::uint64_t>>, kSimtBlocks> fetched_;
  std::vector<std::uint64_t> lines_;
};

}  // namespace

SimtBundle& SimtBundle::operator+=(const SimtBundle& other) {
  for (std::size_t block = 0; block < kSimtBlocks; ++block) {
    runs[block] += other.runs[block];
    lanes[block] += other.lanes[block];
  }
  fetches += other.fetches;
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k] += other.lines[k];
  return *this;
}

SimtBundle replay(std::span<const SimtTrace> lanes) { return Replay(lanes).sum(); }

SimtSum cost_of(const SimtBundle& bundle, const SimtShader& shader) {
  SimtSum sum;
  for (std::size_t block = 0; block < kSimtBlocks; ++block) {
    const SimtCost& cost = shader.costs[block];
    sum.instructions += bundle.runs[block] * static_cast<std::uint64_t>(cost.instructions);
    sum.vector += bundle.runs[block] * static_cast<std::uint64_t>(cost.vector);
    sum.memory += bundle.runs[block] * static_cast<std::uint64_t>(cost.memory);
  }
  return sum;
}

}  // namespace scarp::bench
