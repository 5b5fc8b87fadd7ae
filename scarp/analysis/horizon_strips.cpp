// SPDX-License-Identifier: MIT
// Horizons of rasters beyond the memory of a run: every thread copies the samples of a strip, finds the horizons of its
// nodes by the code for whole fields, and drops it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "scarp/analysis/horizon_state.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp {
namespace {

// Memory of one strip while it is used.
class StripHold {
 public:
  StripHold(StripMemory& memory, double bytes) : memory_(memory), bytes_(bytes) { memory_.take(bytes_); }
  ~StripHold() { memory_.give(bytes_); }
  StripHold(const StripHold&) = delete;
  StripHold& operator=(const StripHold&) = delete;

 private:
  StripMemory& memory_;
  const double bytes_;
};

// Blocks of nodes along parallel lines, for the exact engine, and the samples that their horizons depend on.
//
//   along rows    +---+            block k of a strip begins drift * k * rows columns further; the strips of an
//                 |   |+---+       azimuth lie side by side
//                 +---+|   |
//                      +---+
class ScanStrips {
 public:
  // `cols` x `rows`: size of a block.
  ScanStrips(const HorizonTiles& tiles, const HorizonCrossings& crossings, const NodeRect& nodes, int cols, int rows)
      : nodes_(nodes),
        along_columns_(crossings.along_columns()),
        drift_(crossings.col_sign() * crossings.row_sign() * crossings.tilt()),
        across_(along_columns_ ? rows : cols),
        along_(along_columns_ ? cols : rows),
        major_begin_(along_columns_ ? nodes.col_begin : nodes.row_begin),
        major_end_(along_columns_ ? nodes.col_end : nodes.row_end),
        shape_(shape(tiles, crossings)) {
    const int last = moved(blocks() - 1);
    const int minor_begin = along_columns_ ? nodes.row_begin : nodes.col_begin;
    const int minor_end = along_columns_ ? nodes.row_end : nodes.col_end;
    first_ = minor_begin - std::max(last, 0);
    strips_ = (minor_end - std::min(last, 0) - first_ + across_ - 1) / across_;
  }

  int strips() const { return strips_; }
  int blocks() const { return (major_end_ - major_begin_ + along_ - 1) / along_; }
  const StripShape& shape() const { return shape_; }
  double offset(std::int64_t strip) const { return begin_of(strip) + before_ - drift_ * major_begin_; }
  // Heights and maxima.
  double bytes() const { return 2 * sizeof(float) * shape_.most_samples(); }

  // The nodes of a block, which may be none.
  NodeRect block(std::int64_t strip, int k) const {
    const int minor = begin_of(strip) + moved(k), major = major_begin_ + k * along_;
    const int col = along_columns_ ? major : minor, row = along_columns_ ? minor : major;
    const int cols = along_columns_ ? along_ : across_, rows = along_columns_ ? across_ : along_;
    return {std::max(col, nodes_.col_begin), std::max(row, nodes_.row_begin), std::min(col + cols, nodes_.col_end),
            std::min(row + rows, nodes_.row_end)};
  }

 private:
  int moved(int k) const { return static_cast<int>(std::lround(drift_ * k * along_)); }
  int begin_of(std::int64_t strip) const { return first_ + static_cast<int>(strip) * across_; }

  StripShape shape(const HorizonTiles& tiles, const HorizonCrossings& crossings) {
    // Beyond a block: groups, what is rounded, the second sample of a crossing, and windows of level 0.
    constexpr int kGroup = kGroupCols, kAround = 16;
    const double back = std::max(drift_, 0.0) * (along_ + kGroup), ahead = std::max(-drift_, 0.0) * (along_ + kGroup);
    before_ = -back - kAround;
    const int width = static_cast<int>(std::ceil(back + ahead)) + across_ + kGroup + 2 * kAround;
    const int size = along_columns_ ? tiles.cols() : tiles.rows();
    const int sign = along_columns_ ? crossings.col_sign() : crossings.row_sign();
    const int reach = crossings.all().empty() ? 0 : static_cast<int>(std::ceil(crossings.all().back().steps)) + 1;
    const int begin = sign > 0 ? major_begin_ : std::max(major_begin_ - reach, 0);
    const int end = sign > 0 ? std::min(major_end_ + reach, size) : major_end_;
    return {tiles.cols(), tiles.rows(), along_columns_, drift_, width, begin, end};
  }

  NodeRect nodes_;
  bool along_columns_;
  double drift_, before_ = 0;
  int across_, along_, major_begin_, major_end_;
  StripShape shape_;
  int first_ = 0, strips_ = 0;
};

// Blocks as large as the memory allows: a strip is wider than its blocks.
ScanStrips plan(const HorizonRelief& relief, const HorizonCrossings& crossings, const NodeRect& nodes) {
  const double most = relief.strips->bytes(), threads = std::max(1u, std::thread::hardware_concurrency());
  constexpr int kCols = 256, kRows = 128, kLeastCols = 64;
  for (int part = 1;; part *= 2) {
    ScanStrips strips(*relief.tiles, crossings, nodes, kCols / part, kRows / part);
    if (strips.bytes() <= most / threads || kCols / part == kLeastCols) return strips;
  }
}

void require_memory(const HorizonRelief& relief, double bytes) {
  require_strip_memory("a strip across", relief.tiles->cols(), relief.tiles->rows(), bytes, relief.strips->bytes());
}

double sweep_bytes(const StripShape& shape, int visits) {
  return sizeof(float) * shape.most_samples() + sizeof(std::uint64_t) * kSweptLines * (visits + 1.0);
}

// The samples that the lines of a strip need: those beside them, and what is rounded.
constexpr int kBesideLines = 6;

StripShape shape_of_lines(const HorizonTiles& tiles, const SweepTable& table, const HorizonCrossings& crossings,
                          const SweptNodes& swept) {
  const bool turned = swept.transposed;
  const int cols = turned ? tiles.rows() : tiles.cols(), rows = turned ? tiles.cols() : tiles.rows();
  const double drift = crossings.col_sign() * crossings.row_sign() * crossings.tilt();
  const int begin = table.row_sign() > 0 ? rows - swept.visits : 0;
  return {cols, rows, false, drift, kSweptLines + 2 * kBesideLines, begin, begin + swept.visits};
}

}  // namespace

void require_strip_memory(const char* what, int cols, int rows, double bytes, double memory) {
  constexpr double kMebibyte = 1 << 20;
  if (bytes > memory)
    throw Error(fmt::format("horizons: {} {} x {} samples needs {:.0f} MiB, {:.0f} are left (allow more memory)", what,
                            cols, rows, std::ceil(bytes / kMebibyte), std::floor(memory / kMebibyte)));
}

void scan_strips(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                 const NodeRect& nodes, const HorizonBody& body, const Progress& progress) {
  const HorizonTiles& tiles = *relief.tiles;
  for (const double azimuth : azimuths) require_memory(relief, plan(relief, state.crossings(azimuth), nodes).bytes());
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    const HorizonCrossings crossings = state.crossings(azimuths[i]);
    const ScanStrips strips = plan(relief, crossings, nodes);
    const HorizonTable table(HorizonHeights::layout_of(tiles, strips.shape()), crossings);
    const auto scan = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t strip = begin; strip < end; ++strip) {
        const StripHold hold(*relief.strips, strips.bytes());
        StripMemory& memory = *relief.strips;
        HorizonHeights heights(tiles, strips.shape(), strips.offset(strip), false, memory.spare());
        HorizonGround ground(std::move(heights), relief.eye, relief.coarse, memory.spare());
        std::vector<float> slopes;
        std::vector<std::int32_t> entries;
        for (int k = 0; k < strips.blocks(); ++k) {
          const NodeRect here = strips.block(strip, k);
          if (here.col_begin >= here.col_end || here.row_begin >= here.row_end) continue;
          slopes.resize(here.count()), entries.resize(here.count());
          scan_horizon(ground, table, relief.eye, here, slopes.data(), entries.data(), here.col_end - here.col_begin);
          body({here, i, slopes.data(), entries.data(), table.distances().data()});
        }
        auto [first, second] = ground.release();
        memory.keep(std::move(first)), memory.keep(std::move(second));
      }
    };
    parallel_for(strips.strips(), 1, scan,
                 progress_part(progress, static_cast<double>(i), static_cast<double>(azimuths.size())));
  }
}

void sweep_strips(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                  const NodeRect& nodes, const HorizonBody& body, const Progress& progress) {
  const HorizonTiles& tiles = *relief.tiles;
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    const HorizonCrossings crossings = state.crossings(azimuths[i]);
    const bool transposed = crossings.along_columns();
    // The pitch of a strip depends on nothing else.
    const StripShape any(1, 1, false, 0, kSweptLines + 2 * kBesideLines, 0, 1);
    const SweepTable table(HorizonHeights::layout_of(tiles, any, transposed), crossings);
    const SweptNodes swept(i, transposed, table, transposed ? tiles.cols() : tiles.rows(), nodes);
    const StripShape shape = shape_of_lines(tiles, table, crossings, swept);
    const double bytes = sweep_bytes(shape, swept.visits);
    require_memory(relief, bytes);
    // The place of the first line at row 0.
    const int rows = transposed ? tiles.cols() : tiles.rows();
    const double at_first_row = table.drift(table.row_sign() > 0 ? rows - 1 : 0) - kBesideLines;
    const auto sweep = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t strip = begin; strip < end; ++strip) {
        const StripHold hold(*relief.strips, bytes);
        HorizonHeights heights(tiles, shape, swept.line(strip) + at_first_row, transposed, relief.strips->spare());
        sweep_lines(heights, table, relief.eye, swept, strip, body, true);
        relief.strips->keep(heights.release());
      }
    };
    parallel_for(swept.strips, 1, sweep,
                 progress_part(progress, static_cast<double>(i), static_cast<double>(azimuths.size())));
  }
}

}  // namespace scarp
