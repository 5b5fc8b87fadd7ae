// SPDX-License-Identifier: MIT
#include "scarp/accel/max_pyramid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  double low = kInfinity, high = -kInfinity;
  bool hole = false;
};

// The extremes over a block's cells, straight from the samples.
Bounds brute_force(const HeightField& field, int level, int col, int row) {
  Bounds bounds;
  for (int r = row << level; r < std::min((row + 1) << level, field.cell_rows()); ++r) {
    for (int c = col << level; c < std::min((col + 1) << level, field.cell_cols()); ++c) {
      const auto h = field.cell_heights({c, r});
      if (!h) {
        bounds.hole = true;
        continue;
      }
      bounds.low = std::min({bounds.low, h->h00, h->h10, h->h01, h->h11});
      bounds.high = std::max({bounds.high, h->h00, h->h10, h->h01, h->h11});
    }
  }
  return bounds;
}

// Each entry bounds its block to within less than one step of the code.
void expect_tight(const HeightField& field, const MaxPyramid& pyramid) {
  const double step = pyramid.code().step;
  const bool exact = field.sample_type() != SampleType::float32;
  std::size_t entries = 0;
  for (int l = 1; l <= pyramid.top_level(); ++l) {
    const auto& level = pyramid.levels()[static_cast<std::size_t>(l - 1)];
    ASSERT_EQ(level.cols, (field.cell_cols() + (1 << l) - 1) >> l);
    ASSERT_EQ(level.rows, (field.cell_rows() + (1 << l) - 1) >> l);
    entries += static_cast<std::size_t>(level.cols) * level.rows;
    for (int row = 0; row < level.rows; ++row) {
      for (int col = 0; col < level.cols; ++col) {
        SCOPED_TRACE(testing::Message() << "level " << l << ": " << col << ", " << row);
        const Bounds true_bounds = brute_force(field, l, col, row);
        const double high = pyramid.maximum(l, col, row), low = pyramid.minimum(l, col, row);
        if (true_bounds.high == -kInfinity) {
          ASSERT_EQ(high, pyramid.code().height(0));
        } else {
          ASSERT_GE(high, true_bounds.high);
          ASSERT_LT(high - true_bounds.high, exact ? step : 2 * step);
        }
        if (true_bounds.hole) {
          ASSERT_EQ(low, -kInfinity);
        } else if (low == -kInfinity) {
          ASSERT_EQ(true_bounds.low, pyramid.code().height(0));  // the lowest code
        } else {
          ASSERT_LE(low, true_bounds.low);
          ASSERT_LT(true_bounds.low - low, exact ? step : 2 * step);
        }
      }
    }
  }
  EXPECT_EQ(pyramid.entries(), entries);
  EXPECT_EQ(pyramid.levels().back().cols, 1);
  EXPECT_EQ(pyramid.levels().back().rows, 1);
}

template <class T>
std::vector<T> noise(int cols, int rows, double scale = 1) {
  std::mt19937 random(7);
  std::vector<T> samples(static_cast<std::size_t>(cols) * rows);
  for (T& s : samples) s = static_cast<T>(scale * static_cast<double>(random() % 1000));
  return samples;
}

const std::vector<std::pair<int, int>> kSizes{{2, 2},   {2, 9},   {3, 3},  {4, 4},   {5, 17},  {16, 16},
                                              {17, 17}, {13, 29}, {64, 3}, {65, 33}, {101, 97}};

TEST(MaxPyramid, BoundsEachBlockTightlyAtAnySize) {
  for (const auto& [cols, rows] : kSizes) {
    for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
      SCOPED_TRACE(testing::Message() << cols << " x " << rows);
      const auto check = [&](const HeightField& field) { expect_tight(field, MaxPyramid(field)); };
      check(HeightField::own(noise<float>(cols, rows, 0.37), cols, rows, {.wrap = wrap}));
      check(HeightField::own(noise<std::int16_t>(cols, rows), cols, rows, {.wrap = wrap}));
      check(HeightField::own(noise<std::uint16_t>(cols, rows), cols, rows, {.wrap = wrap}));
    }
  }
}

TEST(MaxPyramid, BoundsHeightsOfAnyOffsetAndScale) {
  // Far above the datum, tiny, huge, and all equal.
  for (const double offset : {0.0, 1e6, -3e30}) {
    for (const double scale : {0.0, 1e-7, 1.0 / 3, 1e30}) {
      auto samples = noise<float>(33, 18, scale);
      for (float& s : samples) s = static_cast<float>(static_cast<double>(s) + offset);
      const HeightField field = HeightField::own(samples, 33, 18);
      expect_tight(field, MaxPyramid(field));
    }
  }
}

TEST(MaxPyramid, BoundsRangesNarrowerThanRounding) {
  // Neighbouring floats far above the datum, and a reserve that is barely representable in doubles.
  for (const double datum : {1.0, 8388608.0, -3e30}) {
    auto samples = noise<float>(33, 18);
    const float low = static_cast<float>(datum), high = std::nextafter(low, std::numeric_limits<float>::infinity());
    for (float& s : samples) s = s < 500 ? low : high;
    const HeightField two = HeightField::own(samples, 33, 18);
    expect_tight(two, MaxPyramid(two));
    const HeightField flat = HeightField::own(std::vector<float>(33 * 18, low), 33, 18);
    expect_tight(flat, MaxPyramid(flat));
    expect_tight(flat, MaxPyramid(flat, SampleRange{datum, std::nextafter(datum, kInfinity)}));
  }
}

TEST(MaxPyramid, BoundsHeightsThatMatchCodesUpToRounding) {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> some(0.001, 0.01);
  const HeightField flat = HeightField::own(std::vector<float>(9, 1.0f), 3, 3);
  for (int i = 0; i < 200; ++i) {
    // A range in which the sample's height is that of code m.
    const double step = some(random), m = 2 + static_cast<double>(random() % 65000);
    const double low = 1 - step * m + 1.5 * step;
    expect_tight(flat, MaxPyramid(flat, SampleRange{low, low + 65533 * step}));
  }
}

TEST(MaxPyramid, IgnoresHoles) {
  auto ints = noise<std::int16_t>(21, 19);
  auto floats = noise<float>(21, 19);
  std::mt19937 random(8);
  for (int i = 0; i < 60; ++i) {
    const auto at = random() % ints.size();
    ints[at] = 9999;  // higher than all others: a hole taken for ground would show
    floats[at] = i % 2 ? std::numeric_limits<float>::quiet_NaN() : 9999.f;
  }
  for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
    const HeightField a = HeightField::own(ints, 21, 19, {.nodata = 9999, .wrap = wrap});
    expect_tight(a, MaxPyramid(a));
    const HeightField b = HeightField::own(floats, 21, 19, {.nodata = 9999, .wrap = wrap});
    expect_tight(b, MaxPyramid(b));
  }
}

TEST(MaxPyramid, HasNoLevelsWithoutCells) {
  EXPECT_EQ(MaxPyramid(HeightField::own(noise<float>(5, 1), 5, 1)).top_level(), 0);
}

RC_GTEST_PROP(MaxPyramid, BoundsTheSurfaceBetweenTheSamples, ()) {
  const int cols = *rc::gen::inRange(2, 40), rows = *rc::gen::inRange(2, 40);
  const Surface surface = *rc::gen::element(Surface::bilinear, Surface::triangles);
  const HeightField field = HeightField::own(noise<float>(cols, rows), cols, rows, {.surface = surface});
  const MaxPyramid pyramid(field);
  const double x = *rc::gen::inRange(0, 10001) * 1e-4 * field.width(),
               y = *rc::gen::inRange(0, 10001) * 1e-4 * field.depth();
  const auto place = field.place(x, y).value();
  for (int l = 1; l <= pyramid.top_level(); ++l) {
    RC_ASSERT(pyramid.maximum(l, place.cell.col >> l, place.cell.row >> l) >= field.height(x, y).value());
    RC_ASSERT(pyramid.minimum(l, place.cell.col >> l, place.cell.row >> l) <= field.height(x, y).value());
  }
}

std::vector<std::uint16_t> entries(const MaxPyramid& pyramid) {
  const std::size_t count = pyramid.entries();
  std::vector<std::uint16_t> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(pyramid.maximum_code(static_cast<std::ptrdiff_t>(i)));
  all.insert(all.end(), pyramid.minima(), pyramid.minima() + count);
  return all;
}

template <class T>
void expect_update_equals_build(const HeightFieldSettings& settings) {
  std::mt19937 random(9);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const int cols = 37, rows = 29;
  // Samples 0 and 999 stay, so that a rebuilt pyramid has the same range.
  auto samples = noise<T>(cols, rows);
  if (settings.wrap == Wrap::shared_border) {
    for (int row = 0; row < rows; ++row)
      samples[static_cast<std::size_t>(row * cols + cols - 1)] = samples[static_cast<std::size_t>(row * cols)];
    for (int col = 0; col < cols; ++col)
      samples[static_cast<std::size_t>((rows - 1) * cols + col)] = samples[static_cast<std::size_t>(col)];
  }
  samples[static_cast<std::size_t>(14 * cols + 18)] = T{0};
  samples[static_cast<std::size_t>(14 * cols + 19)] = T{999};
  HeightField field = HeightField::own(samples, cols, rows, settings);
  MaxPyramid pyramid(field);
  for (int i = 0; i < 200; ++i) {
    SampleRect rect{below(cols), below(rows), 1, 1};
    rect.cols = 1 + below(cols - rect.col);
    rect.rows = 1 + below(rows - rect.row);
    if (settings.wrap == Wrap::shared_border) rect = {1, 1, 1 + below(cols - 2), 1 + below(rows - 2)};
    std::vector<T> edit(static_cast<std::size_t>(rect.cols) * rect.rows);
    for (int r = 0; r < rect.rows; ++r) {
      for (int c = 0; c < rect.cols; ++c) {
        T sample = below(12) == 0 ? T{500} : static_cast<T>(below(1000));
        if (rect.row + r == 14 && (rect.col + c == 18 || rect.col + c == 19))
          sample = rect.col + c == 18 ? T{0} : T{999};
        edit[static_cast<std::size_t>(r * rect.cols + c)] = sample;
      }
    }
    const CellBox changed = field.set_samples(rect, edit.data(), rect.cols);
    pyramid.update(field, changed);
    ASSERT_EQ(entries(pyramid), entries(MaxPyramid(field))) << "edit " << i;
  }
}

TEST(MaxPyramid, UpdateMatchesARebuild) {
  for (const Wrap wrap : {Wrap::none, Wrap::periodic, Wrap::shared_border}) {
    for (const std::optional<double> nodata : {std::optional<double>(), std::optional<double>(500)}) {
      expect_update_equals_build<float>({.nodata = nodata, .wrap = wrap});
      expect_update_equals_build<std::int16_t>({.nodata = nodata, .wrap = wrap});
      expect_update_equals_build<std::uint16_t>({.nodata = nodata, .wrap = wrap});
    }
  }
}

TEST(MaxPyramid, UpdateTouchesOnlyChangedBlocks) {
  HeightField field = HeightField::own(noise<std::int16_t>(65, 65), 65, 65);
  MaxPyramid pyramid(field);
  // A corrupted entry far from the edit stays corrupted.
  const_cast<std::uint32_t*>(pyramid.blocks())[0] = 12345;
  const std::int16_t sample = 7;
  pyramid.update(field, field.set_samples({60, 60, 1, 1}, &sample, 1));
  EXPECT_EQ(pyramid.maximum_code(0), 12345);
}

TEST(MaxPyramid, RebuildsWhenSamplesLeaveTheCodeRange) {
  HeightField field = HeightField::own(noise<float>(40, 30), 40, 30);
  MaxPyramid pyramid(field), reserved(field, SampleRange{-6000, 6000});
  const double step = reserved.code().step;
  const std::vector<float> edit{5000.f, -5000.f};
  const CellBox changed = field.set_samples({20, 10, 2, 1}, edit.data(), 2);
  pyramid.update(field, changed);
  reserved.update(field, changed);
  expect_tight(field, pyramid);
  expect_tight(field, reserved);
  EXPECT_EQ(reserved.code().step, step);  // not needed: the range was reserved
}

}  // namespace
}  // namespace scarp
