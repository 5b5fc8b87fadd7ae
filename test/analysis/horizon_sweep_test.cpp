// SPDX-License-Identifier: MIT
// Swept horizons: vectors against lines one by one, to the bit; every horizon against the crossing that it names; and
// the error against every crossing.
#include "scarp/analysis/horizon_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "analysis/horizon_shapes.h"
#include "march/instruction_sets.h"
#include "scarp/analysis/horizon_scan.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/source/raster/procedural_dem.h"

namespace scarp {
namespace {

using test::azimuth;
using test::HorizonShape;
using test::is_drawn;
using test::kAzimuths;
using test::kFieldsPerKind;
using test::kShapes;
using test::shape;

struct Swept {
  std::vector<float> slopes;
  std::vector<std::int32_t> entries;
  std::vector<int> visited;  // how often
};

template <class Sweep>
Swept swept(const HorizonHeights& heights, const SweepTable& table, float eye, const Sweep& sweep) {
  const auto nodes = static_cast<std::size_t>(heights.cols()) * static_cast<std::size_t>(heights.rows());
  Swept found{std::vector<float>(nodes), std::vector<std::int32_t>(nodes), std::vector<int>(nodes)};
  const SweepSink sink = [&](int col, int row, int count, const float* slopes, const std::int32_t* entries) {
    for (int i = 0; i < count; ++i) {
      const auto at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(heights.cols()) + static_cast<std::size_t>(col + i);
      found.slopes[at] = slopes[i], found.entries[at] = entries[i], ++found.visited[at];
    }
  };
  const int drift = swept_place(table, heights.rows() - 1).nearest;
  for (int line = -std::max(drift, 0); line < heights.cols() - std::min(drift, 0); line += kSweptLines)
    sweep(heights, table, eye, line, heights.rows(), sink);
  return found;
}

TEST(HorizonSweep, EqualsLinesOneByOneToTheBit) {
  const std::vector<std::int64_t> sets = test::instruction_sets();
  int differences = 0;
  for (int s = 0; s < kShapes; ++s) {
    const HorizonShape made = shape(s);
    for (int a = 0; a < kAzimuths; ++a) {
      if (!is_drawn(s, a)) continue;
      const test::InstructionSet set(sets[static_cast<std::size_t>(s + a) % sets.size()]);
      const HorizonCrossings crossings(made.field, azimuth(a), std::numeric_limits<double>::infinity(),
                                       made.settings.curvature);
      const HorizonHeights heights(made.field, s % 2 == 0 ? 1 : -1, crossings.along_columns());
      const SweepTable table(heights, crossings);
      const Swept fast = swept(heights, table, made.eye, sweep_horizons);
      const Swept slow = swept(heights, table, made.eye, sweep_horizons_by_one);
      for (std::size_t i = 0; i < fast.slopes.size(); ++i) {
        ASSERT_EQ(fast.visited[i], 1);
        ASSERT_EQ(slow.visited[i], 1);
        if (std::isnan(slow.slopes[i]) && std::isnan(fast.slopes[i])) continue;
        differences += std::bit_cast<std::uint32_t>(fast.slopes[i]) != std::bit_cast<std::uint32_t>(slow.slopes[i]) ||
                       fast.entries[i] != slow.entries[i];
      }
    }
  }
  EXPECT_EQ(differences, 0);
}

// A swept horizon is the slope to the crossing that it names, and so at most the exact one; crossings up to 8 steps
// away are never missed. Where that crossing has no ground, it is the slope to a line beside it.
TEST(HorizonSweep, NamesACrossing) {
  int named = 0;
  for (int s = 0; s < kShapes; ++s) {
    HorizonShape made = shape(s);
    made.settings.max_distance = std::numeric_limits<double>::infinity();
    const HorizonGround ground(made.field, 1, made.eye);
    const NodeRect all{0, 0, made.field.cols(), made.field.rows()};
    const std::ptrdiff_t cols = made.field.cols();
    const auto nodes = static_cast<std::size_t>(cols * made.field.rows());
    for (int a = 0; a < kAzimuths; ++a) {
      if (!is_drawn(s, a)) continue;
      const HorizonCrossings crossings(made.field, azimuth(a), made.settings.max_distance, made.settings.curvature);
      const HorizonTable table(ground, crossings);
      std::vector<float> exact(nodes);
      std::vector<std::int32_t> winners(nodes);
      scan_horizon_by_all(ground, table, made.eye, all, exact.data(), winners.data(), cols);
      const bool transposed = crossings.along_columns();
      const HorizonHeights heights(made.field, 1, transposed);
      const SweepTable sweep_table(heights, crossings);
      const Swept found = swept(heights, sweep_table, made.eye, sweep_horizons);
      for (std::size_t i = 0; i < nodes; ++i) {
        const int col = static_cast<int>(static_cast<std::ptrdiff_t>(i) % cols);
        const int row = static_cast<int>(static_cast<std::ptrdiff_t>(i) / cols);
        const auto at = transposed ? static_cast<std::size_t>(col) * static_cast<std::size_t>(made.field.rows()) +
                                         static_cast<std::size_t>(row)
                                   : i;
        const float slope = found.slopes[at];
        const std::int32_t entry = found.entries[at];
        ASSERT_EQ(std::isnan(slope), std::isnan(exact[i]));
        if (std::isnan(slope)) continue;
        if (winners[i] >= 0 && crossings.all()[static_cast<std::size_t>(winners[i])].steps <= 8) {
          ASSERT_GE(slope, exact[i]) << "shape " << s << ", azimuth " << a << ", node " << col << ", " << row;
        }
        if (entry < 0) continue;
        const int step = entry - sweep_table.first_major();
        if (step >= 0 && !crossings.has_major(step)) continue;
        const std::size_t number = step < 0 ? static_cast<std::size_t>(entry) : crossings.count_to_major(step) - 1;
        ASSERT_EQ(sweep_table.distances()[static_cast<std::size_t>(entry)],
                  static_cast<float>(crossings.all()[number].steps * crossings.step()));
        const HorizonTable::Entry& e = table.entries()[number];
        const float* node = ground.heights().height(col, row);
        const float z = *node + made.eye;
        const float first = node[e.first], second = node[e.first + e.second];
        const float named_slope = std::fma(std::fma(e.w, second - first, first - z), e.per_distance, -e.drop);
        if (std::isnan(named_slope)) continue;
        ++named;
        ASSERT_EQ(slope, named_slope);
        ASSERT_LE(slope, exact[i]);
      }
    }
  }
  EXPECT_GT(named, 150'000 * kFieldsPerKind);
}

#ifdef NDEBUG
// The error that horizon.h promises, on ground of the kind that people have. Optimised builds only: others find the
// same horizons, in minutes.
TEST(HorizonSweep, ErrsByLittleOnGeneratedGround) {
  ProceduralDem dem;
  dem.cols = dem.rows = 512, dem.cell_m = 25, dem.kind = TerrainKind::ridged;
  const HeightField field = HeightField::own(generate_dem(dem), 512, 512, {.cell_x = 25, .cell_y = 25});
  HorizonSettings settings;
  std::vector<double> errors;
  const Horizons exact(field, settings);
  settings.engine = HorizonEngine::sweep;
  const Horizons sweep(field, settings);
  for (int a = 0; a < 16; ++a) {
    const double direction = 2 * std::numbers::pi * (a + 0.5) / 16;
    const HorizonRows truth = exact.rows(direction, 0, field.rows()), found = sweep.rows(direction, 0, field.rows());
    for (std::size_t i = 0; i < truth.angle.size(); ++i)
      errors.push_back(std::abs(static_cast<double>(truth.angle[i]) - static_cast<double>(found.angle[i])) * 180 /
                       std::numbers::pi);
  }
  const auto p99 = errors.begin() + static_cast<std::ptrdiff_t>(errors.size()) * 99 / 100;
  std::nth_element(errors.begin(), p99, errors.end());
  EXPECT_LE(*p99, 0.5);
  const std::vector fraction{SkyMeasure::sky_fraction};
  settings.engine = HorizonEngine::exact;
  const auto truth = SkyView(field, settings, 64, fraction).rows(0, field.rows());
  settings.engine = HorizonEngine::sweep;
  const auto found = SkyView(field, settings, 64, fraction).rows(0, field.rows());
  double sum = 0;
  for (std::size_t i = 0; i < truth[0].size(); ++i) sum += std::abs(static_cast<double>(truth[0][i] - found[0][i]));
  EXPECT_LE(sum / static_cast<double>(truth[0].size()), 2e-4);
}
#endif

}  // namespace
}  // namespace scarp
