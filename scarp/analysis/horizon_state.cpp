// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "scarp/analysis/map_part.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp {
namespace {

// A strip's rows of samples stay in the cache from one row of nodes to the next, and a block has enough rows for the
// warm start of horizon_scan.h to pay.
constexpr int kStripCols = 256, kBlockRows = 128;
// Tables of this many azimuths are kept at once: 28 bytes per crossing.
constexpr std::size_t kTablesAtOnce = 64;

void scan(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
          const NodeRect& nodes, const HorizonBody& body, const Progress& progress) {
  const HorizonGround& ground = *relief.ground;
  const std::int64_t across = (nodes.col_end - nodes.col_begin + kStripCols - 1) / kStripCols;
  const std::int64_t down = (nodes.row_end - nodes.row_begin + kBlockRows - 1) / kBlockRows;
  const double parts = std::ceil(static_cast<double>(azimuths.size()) / kTablesAtOnce);
  for (std::size_t begin = 0; begin < azimuths.size(); begin += kTablesAtOnce) {
    const std::size_t end = std::min(begin + kTablesAtOnce, azimuths.size());
    std::vector<HorizonTable> tables;
    for (std::size_t i = begin; i < end; ++i) tables.emplace_back(ground, state.crossings(azimuths[i]));
    const auto blocks = [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t block = first; block < last; ++block) {
        const int col = nodes.col_begin + static_cast<int>(block % across) * kStripCols;
        const int row = nodes.row_begin + static_cast<int>(block / across) * kBlockRows;
        const NodeRect here{col, row, std::min(col + kStripCols, nodes.col_end),
                            std::min(row + kBlockRows, nodes.row_end)};
        std::vector<float> slopes(here.count());
        std::vector<std::int32_t> entries(here.count());
        for (std::size_t i = begin; i < end; ++i) {
          scan_horizon(ground, tables[i - begin], relief.eye, here, slopes.data(), entries.data(),
                       here.col_end - here.col_begin);
          body({here, i, slopes.data(), entries.data(), tables[i - begin].distances().data()});
        }
      }
    };
    parallel_for(across * down, 1, blocks, progress_part(progress, static_cast<double>(begin) / kTablesAtOnce, parts));
  }
}

// Collects the horizons of neighbouring columns, one after another, and passes them on by rows.
template <int kCols>
class CollectedColumns {
 public:
  // `ascending`: whether columns come from west to east.
  CollectedColumns(std::size_t azimuth, bool ascending, const float* distances, const HorizonBody& body)
      : azimuth_(azimuth), ascending_(ascending), distances_(distances), body_(body) {}

  void add(int col, int row, int count, const float* slopes, const std::int32_t* entries) {
    if (count_ == 0) {
      // The lines move by at most one row per column.
      first_col_ = ascending_ ? col : col - kCols + 1, first_row_ = row - kCols;
      std::fill_n(begin_, kRows, kCols), std::fill_n(end_, kRows, 0);
    }
    const int at = col - first_col_;
    for (int i = 0; i < count; ++i) {
      const int r = row - first_row_ + i;
      slopes_[r][at] = slopes[i], entries_[r][at] = entries[i];
      begin_[r] = std::min(begin_[r], at), end_[r] = std::max(end_[r], at + 1);
    }
    if (++count_ == kCols) pass_on();
  }

  void pass_on() {
    for (int r = 0; count_ > 0 && r < kRows; ++r) {
      const int begin = begin_[r], row = first_row_ + r;
      if (begin < end_[r]) {
        body_({{first_col_ + begin, row, first_col_ + end_[r], row + 1},
               azimuth_,
               slopes_[r] + begin,
               entries_[r] + begin,
               distances_});
      }
    }
    count_ = 0;
  }

 private:
  static constexpr int kRows = kSweptLines + 2 * kCols;

  const std::size_t azimuth_;
  const bool ascending_;
  const float* const distances_;
  const HorizonBody& body_;
  int count_ = 0, first_col_ = 0, first_row_ = 0;
  int begin_[kRows], end_[kRows];  // columns that a row has
  float slopes_[kRows][kCols];
  std::int32_t entries_[kRows][kCols];
};

void sweep(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
           const NodeRect& nodes, const HorizonBody& body, const Progress& progress) {
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    const HorizonCrossings crossings = state.crossings(azimuths[i]);
    const HorizonHeights& heights = crossings.along_columns() ? *relief.transposed : *relief.heights;
    const SweepTable table(heights, crossings);
    const SweptNodes swept(i, crossings.along_columns(), table, heights.rows(), nodes);
    const auto strips = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t strip = begin; strip < end; ++strip)
        sweep_lines(heights, table, relief.eye, swept, strip, body, false);
    };
    parallel_for(swept.strips, 1, strips,
                 progress_part(progress, static_cast<double>(i), static_cast<double>(azimuths.size())));
  }
}

}  // namespace

SweptNodes::SweptNodes(std::size_t of_azimuth, bool is_transposed, const SweepTable& table, int rows,
                       const NodeRect& nodes)
    : azimuth(of_azimuth),
      transposed(is_transposed),
      inner(transposed ? NodeRect{nodes.row_begin, nodes.col_begin, nodes.row_end, nodes.col_end} : nodes),
      visits(table.row_sign() > 0 ? rows - inner.row_begin : inner.row_end) {
  const int drift = swept_place(table, visits - 1).nearest;
  first_line = inner.col_begin - std::max(drift, 0);
  strips = (inner.col_end - std::min(drift, 0) - first_line + kSweptLines - 1) / kSweptLines;
}

void sweep_lines(const HorizonHeights& heights, const SweepTable& table, float eye, const SweptNodes& swept,
                 std::int64_t strip, const HorizonBody& body, bool long_rows) {
  const float* distances = table.distances().data();
  const auto run = [&](const auto& pass_on) {
    const SweepSink sink = [&](int col, int row, int count, const float* slopes, const std::int32_t* entries) {
      const NodeRect& inner = swept.inner;
      const int before = std::max(inner.col_begin - col, 0), behind = std::max(col + count - inner.col_end, 0);
      if (row < inner.row_begin || row >= inner.row_end || before + behind >= count) return;
      pass_on(col + before, row, count - before - behind, slopes + before, entries + before);
    };
    sweep_horizons(heights, table, eye, swept.line(strip), swept.visits, sink);
  };
  if (!swept.transposed) {
    return run([&](int col, int row, int count, const float* slopes, const std::int32_t* entries) {
      body({{col, row, col + count, row + 1}, swept.azimuth, slopes, entries, distances});
    });
  }
  const auto run_columns = [&]<int kCols>(CollectedColumns<kCols>& columns) {
    run([&](int col, int row, int count, const float* slopes, const std::int32_t* entries) {
      columns.add(row, col, count, slopes, entries);
    });
    columns.pass_on();
  };
  const bool ascending = table.row_sign() < 0;
  if (long_rows) {
    run_columns(*std::make_unique<CollectedColumns<128>>(swept.azimuth, ascending, distances, body));
  } else {
    CollectedColumns<16> columns(swept.azimuth, ascending, distances, body);
    run_columns(columns);
  }
}

void StripMemory::take(double bytes) {
  std::unique_lock lock(mutex_);
  given_.wait(lock, [&] { return used_ == 0 || used_ + bytes <= bytes_; });
  used_ += bytes;
}

void StripMemory::give(double bytes) {
  {
    const std::lock_guard lock(mutex_);
    used_ -= bytes;
  }
  given_.notify_all();
}

LargeVector<float> StripMemory::spare() {
  const std::lock_guard lock(mutex_);
  if (spares_.empty()) return {};
  LargeVector<float> last = std::move(spares_.back());
  spares_.pop_back();
  return last;
}

void StripMemory::keep(LargeVector<float> array) {
  const std::lock_guard lock(mutex_);
  spares_.push_back(std::move(array));
}

HorizonRelief::HorizonRelief(const HeightField& field, HorizonEngine engine, int sign, float eye_height, double memory,
                             const Progress& progress)
    : eye(eye_height) {
  const bool exact = engine == HorizonEngine::exact;
  const double nodes = static_cast<double>(field.cols()) * field.rows(), bytes = (exact ? 9 : 8) * nodes;
  if (bytes > memory) {
    const double most = exact ? HorizonGround::coarse_bytes(field.cols(), field.rows()) : 0;
    require_strip_memory("maxima over", field.cols(), field.rows(), most, memory);
    tiles.emplace(field, sign, progress);
    if (exact)
      coarse = std::make_shared<const HorizonGround::CoarseMaxima>(HorizonGround::coarse_maxima(*tiles, eye, {}));
    strips = std::make_unique<StripMemory>(memory - most / 2);
  } else if (exact) {
    ground.emplace(field, sign, eye, progress);
  } else {
    heights.emplace(field, sign), transposed.emplace(field, sign, true);
  }
}

void HorizonRelief::copy_heights(int col, int row, int count, float* to) const {
  if (tiles) {
    tiles->read_row(col, row, count, to);
  } else {
    std::copy_n((ground ? ground->heights() : *heights).height(col, row), count, to);
  }
}

void require_nodes(const HeightField& field, const NodeRect& nodes) {
  require_band(field, {nodes.row_begin, nodes.row_end});
  if (nodes.col_begin < 0 || nodes.col_end > field.cols() || nodes.col_begin >= nodes.col_end)
    throw Error(
        fmt::format("map: columns {} to {} of a field of {} columns", nodes.col_begin, nodes.col_end, field.cols()));
}

void for_each_horizon(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                      const NodeRect& nodes, const HorizonBody& body, const Progress& progress) {
  require_nodes(state.field, nodes);
  const bool exact = state.settings.engine == HorizonEngine::exact;
  const auto& find = relief.tiles ? (exact ? scan_strips : sweep_strips) : (exact ? scan : sweep);
  find(state, relief, azimuths, nodes, body, progress);
}

}  // namespace scarp
