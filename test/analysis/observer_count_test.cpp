// SPDX-License-Identifier: MIT
// Cumulative viewsheds: the sum of the viewsheds of all observers.
#include "scarp/analysis/observer_count.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "analysis/map_fields.h"
#include "cases.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::test {
namespace {

std::vector<std::uint16_t> sum_of_viewsheds(const std::vector<Viewpoint>& views) {
  const HeightField& field = views[0].ground().field();
  std::vector<std::uint16_t> sum;
  for (const Viewpoint& view : views) {
    const auto codes = viewshed(field, view.observer(), view.settings());
    sum.resize(codes.size(), kCountOutOfRange);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (codes[i] == Seen::hole) sum[i] = kCountHole;
      if (codes[i] == Seen::hole || codes[i] == Seen::out_of_range) continue;
      if (sum[i] == kCountOutOfRange) sum[i] = 0;
      sum[i] = static_cast<std::uint16_t>(sum[i] + (codes[i] == Seen::visible));
    }
  }
  return sum;
}

TEST(ObserverCount, EqualsTheSumOfViewsheds) {
  const auto fields = map_fields();
  const auto stride = static_cast<std::size_t>(cases(1, 1, 4));
  std::size_t limited = 0, holes = 0, several = 0;
  for (std::size_t k = 0; k < fields.size(); k += stride) {
    for (const ViewshedSettings& settings : map_settings()) {
      std::vector<Viewpoint> views;
      for (const Node observer : map_observers(fields[k].field))
        views.emplace_back(fields[k].field, observer, settings);
      if (views.empty()) continue;
      // The same observer twice counts twice.
      views.push_back(views.front());
      const auto counts = observer_count(views);
      ASSERT_EQ(counts, sum_of_viewsheds(views)) << fields[k].name;
      for (const std::uint16_t count : counts) {
        limited += count == kCountOutOfRange;
        holes += count == kCountHole;
        several += count > 2 && count <= kMostObservers;
      }
    }
  }
  EXPECT_GT(limited, 100u);
  EXPECT_GT(holes, 50u);
  EXPECT_GT(several, 1000u);
}

// One observer with limits and one without: nothing is out of range.
TEST(ObserverCount, CombinesLimitedAndUnlimitedObservers) {
  const auto fields = map_fields();
  const HeightField& field = fields[0].field;
  const std::vector<Viewpoint> views{{field, {2, 3}, {.max_distance = 3}}, {field, {9, 3}, {}}};
  const auto counts = observer_count(views);
  EXPECT_EQ(counts, sum_of_viewsheds(views));
  EXPECT_EQ(std::count(counts.begin(), counts.end(), kCountOutOfRange), 0);
}

TEST(ObserverCount, DoesNotDependOnThreads) {
  std::mt19937 random(7);
  std::vector<float> samples;
  constexpr int kCols = 150, kRows = 130;
  for (int i = 0; i < kCols * kRows; ++i) samples.push_back(static_cast<float>(random() % 64));
  const HeightField field = HeightField::own(std::move(samples), kCols, kRows, {.cell_x = 10, .cell_y = 10});
  std::vector<Viewpoint> views;
  for (int i = 0; i < cases(60, 60, 20); ++i) {
    const Node observer{static_cast<int>(random() % kCols), static_cast<int>(random() % kRows)};
    views.emplace_back(field, observer, ViewshedSettings{.observer_height = 60});
  }
  const auto counts = observer_count(views);
  const ThreadLimit one(1);
  EXPECT_EQ(counts, observer_count(views));
}

TEST(ObserverCount, RejectsBadViews) {
  const HeightField small = HeightField::own(std::vector<float>{1, 2, 3, 4}, 2, 2);
  const HeightField large = HeightField::own(std::vector<float>(9, 1), 3, 3);
  EXPECT_THROW(observer_count({}), Error);
  const std::vector<Viewpoint> views{{small, {0, 0}, {}}, {large, {0, 0}, {}}};
  EXPECT_THROW(observer_count(views), Error);
  const std::vector<Viewpoint> many(kMostObservers + 1, views[0]);
  EXPECT_THROW(observer_count(many), Error);
}

}  // namespace
}  // namespace scarp::test
