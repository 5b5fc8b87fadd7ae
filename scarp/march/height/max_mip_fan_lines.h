// SPDX-License-Identifier: MIT
// The grid lines of fans: their frame and the samples on them, in vectors. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_FAN_LINES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_FAN_LINES_H
#undef SCARP_MARCH_MAX_MIP_FAN_LINES_H
#else
#define SCARP_MARCH_MAX_MIP_FAN_LINES_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hwy/cache_control.h"
#include "scarp/accel/relief_map.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/grid_axis.h"
#include "scarp/march/height/max_mip_simd_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

using MF = hn::Mask<decltype(df)>;

HWY_INLINE std::uint64_t bits_of(MF mask) { return bits_of(hn::RebindMask(di, mask)); }

// Samples of a line that all lanes look up.
constexpr int kWindow = 16;

// in_first_copy() for numbers below 2^24, which floats hold; others become some cell.
HWY_INLINE VI in_copy(VI number, std::int32_t cells) {
  const VI all = hn::Set(di, cells), last = hn::Set(di, cells - 1), zero = hn::Zero(di);
  const VF copy = hn::Floor(hn::Mul(hn::ConvertTo(df, number), hn::Set(df, 1 / static_cast<float>(cells))));
  const VI rest = hn::Sub(number, hn::Mul(hn::ConvertTo(di, copy), all));
  // The quotient is rounded: off by one copy at most.
  const VI low = hn::IfThenElse(hn::Lt(rest, zero), hn::Add(rest, all), rest);
  return hn::Min(hn::Max(hn::IfThenElse(hn::Gt(low, last), hn::Sub(low, all), low), zero), last);
}

// The ground, mirrored and turned for the rays of one octant: they advance along `major`, whose lines are numbered, and
// along `minor`, whose nodes are. Line k and node Y count from those behind the origin: it is between lines 0 and 1 and
// nodes 0 and 1, or on line 1 or node 1. Over a wrapped grid, whose first copy has the origin, lines and nodes go on
// through all copies.
template <class Sample>
struct Octant {
  bool wraps;
  bool turned;                  // major is that of the rows
  bool back_major, back_minor;  // runs against the grid
  bool rises;                   // diagonals of triangles run from node (k, Y) to (k + 1, Y + 1)
  std::int32_t line0, node0;    // of line 0 and node 0 in the mirrored field
  double fx, fy;                // from there to the origin, (0, 1]
  std::int32_t major_cells, minor_cells;
  const Sample* corner;  // node 0 of line 0 of the mirrored field; wrapped: of the last line or node, where mirrored
  std::ptrdiff_t step_major, step_minor;
  bool gathers;         // whether 32-bit offsets reach all nodes of a line
  float z_high, z_low;  // height of the origin in sample units: their sum
  bool holes;
  float nodata, lowest;  // samples that mark holes, besides NaN, and what they count as

  std::int32_t last_line() const { return major_cells - line0; }
  // Line k and a node, by their numbers in the mirrored field. Beyond a field without wrap they are those of its
  // border.
  std::int32_t field_line(std::int32_t k) const { return wraps ? in_first_copy(line0 + k, major_cells) : line0 + k; }
  const Sample* line(std::int32_t k) const {
    const std::int32_t at =
        wraps ? in_first_copy(line0 + k - back_major, major_cells) : std::clamp(line0 + k, 0, major_cells);
    return corner + at * step_major;
  }
  std::ptrdiff_t node(std::int32_t i) const {
    return (wraps ? in_first_copy(i - back_minor, minor_cells) : std::clamp(i, 0, minor_cells)) * step_minor;
  }
  float T_at(std::int32_t k) const { return static_cast<float>(std::max(k - fx, 0.0)); }
};

template <class Sample>
Octant<Sample> octant(const SampleGrid<Sample>& grid, bool wraps, const dvec3& origin, float lowest, int number) {
  Octant<Sample> o;
  o.wraps = wraps;
  o.turned = number & 1;
  const bool back_x = number & 2, back_y = number & 4;
  o.back_major = o.turned ? back_y : back_x, o.back_minor = o.turned ? back_x : back_y;
  o.rises = back_x != back_y;
  o.major_cells = o.turned ? grid.cell_rows : grid.cell_cols,
  o.minor_cells = o.turned ? grid.cell_cols : grid.cell_rows;
  const double x = back_x ? grid.cell_cols - origin.x : origin.x, y = back_y ? grid.cell_rows - origin.y : origin.y;
  const double major = o.turned ? y : x, minor = o.turned ? x : y;
  o.line0 = static_cast<std::int32_t>(std::ceil(major)) - 1, o.node0 = static_cast<std::int32_t>(std::ceil(minor)) - 1;
  o.fx = major - o.line0, o.fy = minor - o.node0;
  const std::ptrdiff_t step_x = back_x ? -1 : 1, step_y = back_y ? -grid.row_stride : grid.row_stride;
  o.corner = grid.row(back_y ? grid.cell_rows - wraps : 0) + (back_x ? grid.cell_cols - wraps : 0);
  o.step_major = o.turned ? step_y : step_x, o.step_minor = o.turned ? step_x : step_y;
  o.gathers =
      std::is_same_v<Sample, float> && std::abs(static_cast<double>(o.step_minor)) * (o.minor_cells + 2.0) < 0x1p31;
  o.z_high = static_cast<float>(origin.z);
  o.z_low = static_cast<float>(origin.z - static_cast<double>(o.z_high));
  o.gathers = o.gathers && !grid.has_holes;
  o.holes = grid.has_holes, o.nodata = static_cast<float>(grid.nodata), o.lowest = lowest;
  return o;
}

// Heights relative to the origin.
template <class Sample>
HWY_INLINE VF relative(const Octant<Sample>& o, VF samples) {
  return hn::Sub(hn::Sub(samples, hn::Set(df, o.z_high)), hn::Set(df, o.z_low));
}

template <class Sample>
HWY_INLINE VF load_samples(const Sample* from) {
  if constexpr (std::is_same_v<Sample, float>) {
    return hn::LoadU(df, from);
  } else {
    constexpr hn::Rebind<Sample, decltype(df)> dt;
    return hn::ConvertTo(df, hn::PromoteTo(di, hn::LoadU(dt, from)));
  }
}

// A sample, or what nodata counts as.
template <class Sample>
HWY_INLINE float filled(const Octant<Sample>& o, Sample sample) {
  const auto number = static_cast<float>(sample);
  return o.holes && (number == o.nodata || number != number) ? o.lowest : number;
}

// As load_window() beside the border or a seam, and over a field with holes: apart, so that the usual loads stay short.
template <class Sample>
HWY_NOINLINE void load_odd_window(const Octant<Sample>& o, std::int32_t k, std::int32_t b, float* window) {
  alignas(64) float samples[kWindow];
  const Sample* line = o.line(k);
  for (int i = 0; i < kWindow; ++i) samples[i] = filled(o, line[o.node(o.node0 + b + i)]);
  for (int i = 0; i < kWindow; i += N) hn::Store(relative(o, hn::Load(df, samples + i)), df, window + i);
}

// Nodes first .. first + 15 of line k.
template <class Sample>
HWY_INLINE void load_window(const Octant<Sample>& o, std::int32_t k, std::int32_t b, float* window) {
  if (o.holes) [[unlikely]]
    return load_odd_window(o, k, b, window);
  std::int32_t first = o.node0 + b, count = o.minor_cells + 1;
  if (o.wraps) first = in_first_copy(first - o.back_minor, o.minor_cells), count = o.minor_cells;
  const Sample* line = o.line(k);
  if (first >= 0 && first + kWindow <= count) {
    const Sample* from = line + first * o.step_minor;
    if (o.step_minor == 1) {
      for (int i = 0; i < kWindow; i += N) hn::Store(relative(o, load_samples(from + i)), df, window + i);
      return;
    }
    if (o.step_minor == -1) {
      for (int i = 0; i < kWindow; i += N) {
        const VF back = load_samples(from - i - (static_cast<std::ptrdiff_t>(N) - 1));
        hn::Store(relative(o, hn::Reverse(df, back)), df, window + i);
      }
      return;
    }
    if constexpr (std::is_same_v<Sample, float>) {
      if (o.gathers) {
        const auto step = static_cast<std::int32_t>(o.step_minor);
        for (int i = 0; i < kWindow; i += N) {
          const VI at = hn::Mul(hn::Iota(di, i), hn::Set(di, step));
          hn::Store(relative(o, hn::GatherIndex(df, from, at)), df, window + i);
        }
        return;
      }
    }
    alignas(64) float samples[kWindow];
    for (int i = 0; i < kWindow; ++i) samples[i] = static_cast<float>(from[i * o.step_minor]);
    for (int i = 0; i < kWindow; i += N) hn::Store(relative(o, hn::Load(df, samples + i)), df, window + i);
    return;
  }
  load_odd_window(o, k, b, window);
}

// One of a window's samples per lane.
HWY_INLINE VF look_up(const float* window, VI at) {
  if constexpr (N == 16) {
    return hn::TableLookupLanes(hn::Load(df, window), hn::IndicesFromVec(df, at));
  } else if constexpr (N == 8) {
    const auto of_eight = hn::IndicesFromVec(df, hn::And(at, hn::Set(di, 7)));
    return hn::IfThenElse(hn::RebindMask(df, hn::Gt(at, hn::Set(di, 7))),
                          hn::TableLookupLanes(hn::Load(df, window + 8), of_eight),
                          hn::TableLookupLanes(hn::Load(df, window), of_eight));
  } else {
    return hn::GatherIndex(df, window, at);
  }
}

// A node of line k per lane, by its number in the mirrored field.
template <class Sample>
HWY_INLINE VF look_far(const Octant<Sample>& o, const Sample* line, VI node) {
  const VI at = o.wraps ? in_copy(hn::Sub(node, hn::Set(di, o.back_minor)), o.minor_cells)
                        : hn::Min(hn::Max(node, hn::Zero(di)), hn::Set(di, o.minor_cells));
  if constexpr (std::is_same_v<Sample, float>) {
    if (o.gathers)
      return relative(o, hn::GatherIndex(df, line, hn::Mul(at, hn::Set(di, static_cast<std::int32_t>(o.step_minor)))));
  }
  alignas(64) std::int32_t nodes[N];
  alignas(64) float samples[N];
  hn::Store(at, di, nodes);
  for (std::size_t i = 0; i < N; ++i) samples[i] = filled(o, line[nodes[i] * o.step_minor]);
  return relative(o, hn::Load(df, samples));
}

// Asks for the samples that a strip will need some lines on. Along memory a line is a few cache lines; across it each
// node is in one of its own, which the next lines share: each line asks for every 16th node, farther ahead.
template <class Sample>
HWY_INLINE void prefetch_line(const Octant<Sample>& o, std::int32_t k, float least_m, float most_m) {
  constexpr std::int32_t kAlong = 6, kAcross = 16, kShared = 16;
  const bool along = std::abs(o.step_minor) == 1;
  const std::int32_t line = k + (along ? kAlong : kAcross);
  const auto T = static_cast<float>(line), y = static_cast<float>(o.fy);
  const auto node = [&](float m, float beside) {
    const std::int32_t at = o.node0 + static_cast<std::int32_t>(m * T + y + beside);
    return o.wraps ? at : std::clamp(at, 0, o.minor_cells);
  };
  const std::int32_t first = node(least_m, -1), last = node(most_m, 2);
  const Sample* from = o.line(line);
  for (std::int32_t i = along ? first : first + ((line - first) & (kShared - 1)); i < last; i += kShared)
    hwy::Prefetch(from + o.node(i));
  if (along) hwy::Prefetch(from + o.node(last));
}

// The steepest edge in the wedge of a strip's rays, up to the last line asked for.
template <class Sample>
class WedgeRelief {
 public:
  WedgeRelief(const Octant<Sample>& o, const ReliefMap& map, std::int32_t first_line, double least_m, double most_m)
      : o_(o), map_(map), line_(first_line), least_(least_m), most_(most_m) {}

  float up_to(std::int32_t line) {
    while (line_ < line) extend();
    return steepest_;
  }

 private:
  static constexpr int kLevel = ReliefMap::kLevel;

  void extend() {
    const std::int32_t cell = o_.wraps ? o_.field_line(line_) : std::clamp(o_.line0 + line_, 0, o_.major_cells - 1);
    const std::int32_t block = (o_.back_major ? o_.major_cells - 1 - cell : cell) >> kLevel;
    std::int32_t next = (o_.back_major ? o_.major_cells - (block << kLevel) : (block + 1) << kLevel) - o_.line0;
    if (o_.wraps) next = line_ + cells_left(cell, o_.back_major, o_.major_cells);
    if (next <= line_) next = line_ + (1 << kLevel);
    // A cell more on either side, for rounding.
    const double from = std::max(line_ - o_.fx, 0.0), to = std::max(next - o_.fx, 0.0);
    const double low = std::floor(o_.fy + least_ * from - 1) + o_.node0,
                 high = std::floor(o_.fy + most_ * to + 1) + o_.node0;
    const auto add = [&](std::int32_t i) {
      const float there = o_.turned ? map_.row(block)[i] : map_.row(i)[block];
      steepest_ = there > steepest_ ? there : steepest_;
    };
    o_.wraps ? add_copies(low, high, add) : add_inside(low, high, add);
    line_ = next;
  }
  // Cells of a block of the map from this one on, by numbers in the mirrored field.
  static std::int32_t cells_left(std::int32_t cell, bool back, std::int32_t cells) {
    const std::int32_t real = back ? cells - 1 - cell : cell, first = real >> kLevel << kLevel;
    return back ? real + 1 - first : std::min(first + (1 << kLevel), cells) - real;
  }
  template <class Add>
  void add_inside(double from, double to, const Add& add) const {
    const auto node = [&](double at) { return static_cast<std::int32_t>(std::clamp(at, 0.0, o_.minor_cells - 1.0)); };
    std::int32_t low = node(from), high = node(to);
    if (o_.back_minor) {
      const std::int32_t first = o_.minor_cells - 1 - high;
      high = o_.minor_cells - 1 - low, low = first;
    }
    for (std::int32_t i = low >> kLevel; i <= high >> kLevel; ++i) add(i);
  }
  template <class Add>
  void add_copies(double from, double to, const Add& add) const {
    const auto low = static_cast<std::int32_t>(from), high = static_cast<std::int32_t>(to);
    std::int32_t cell = in_first_copy(low, o_.minor_cells), left = std::min(high - low + 1, o_.minor_cells);
    while (left > 0) {
      add((o_.back_minor ? o_.minor_cells - 1 - cell : cell) >> kLevel);
      const std::int32_t cells = cells_left(cell, o_.back_minor, o_.minor_cells);
      cell += cells, left -= cells;
      if (cell == o_.minor_cells) cell = 0;
    }
  }

  const Octant<Sample>& o_;
  const ReliefMap& map_;
  std::int32_t line_;
  double least_, most_;
  float steepest_ = 0;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
