// SPDX-License-Identifier: MIT
// The visitor of walk_blocks() that records the blocks and cells of `max-mip` (base/march_trace.h), if the query has a
// trace. The rules over blocks and cells are those of the visitor that it contains.
#pragma once

#include "scarp/base/march_trace.h"
#include "scarp/march/height/block_walk.h"

namespace scarp::max_mip {
namespace {

inline void record_cell(MarchTrace& trace, int col, int row, double t_in, double t_out, bool tested) {
  TraceStep step{.kind = tested ? TraceKind::tested_cell : TraceKind::passed_cell, .t = t_in, .t_out = t_out};
  step.col = col, step.row = row;
  trace.steps.push_back(step);
}

/// `Rules` has wanted(), cell_tests() and maximum_of(block) in metres.
template <class Rules, class Visitor>
class TracedVisitor {
 public:
  explicit TracedVisitor(Rules& rules) : rules_(rules), visitor_(rules), trace_(rules.wanted().trace) {}

  [[gnu::always_inline]] Verdict block(const Block& block, const BlockWay& way) const {
    const Verdict verdict = visitor_.block(block, way);
    if (trace_) [[unlikely]]
      record(block, way, verdict);
    return verdict;
  }
  [[gnu::always_inline]] bool cell(int col, int row, const BlockWay& way) const {
    const auto tests = rules_.cell_tests();
    const bool stops = visitor_.cell(col, row, way);
    if (trace_) [[unlikely]]
      record_cell(*trace_, col, row, way.t_in, way.t_leave, rules_.cell_tests() > tests);
    return stops;
  }
  bool leaves(const BlockWay& way) const { return visitor_.leaves(way); }
  bool crosses(const BlockWay& way, std::uint32_t steps) const { return visitor_.crosses(way, steps); }

 private:
  [[gnu::noinline]] void record(const Block& block, const BlockWay& way, Verdict verdict) const {
    TraceStep step{.kind = verdict == Verdict::pass ? TraceKind::passed_block : TraceKind::entered_block,
                   .t = way.t_in,
                   .t_out = way.t_leave};
    step.level = block.level, step.col = block.col, step.row = block.row;
    step.maximum = rules_.maximum_of(block);
    trace_->steps.push_back(step);
  }

  Rules& rules_;
  Visitor visitor_;
  MarchTrace* trace_;
};

}  // namespace
}  // namespace scarp::max_mip
