// SPDX-License-Identifier: MIT
// Viewsheds, least visible heights and shadows against the slow judge, cell by cell.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "analysis/map_fields.h"
#include "analysis/slow_judge.h"
#include "cases.h"
#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/analysis/sun_disc.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

std::string place(const MapField& kind, std::size_t i) {
  const auto cols = static_cast<std::size_t>(kind.field.cols());
  return kind.name + ", column " + std::to_string(i % cols) + ", row " + std::to_string(i / cols);
}

// All fields in optimised builds, some in others: the judge's rational numbers take most of the time.
std::vector<MapField> some_fields() {
  const auto stride = static_cast<std::size_t>(cases(1, 1, 4));
  auto all = map_fields();
  std::vector<MapField> some;
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(std::move(all[i]));
  return some;
}

// Some of the observers, different ones for each field.
std::vector<Node> some_observers(const HeightField& field) {
  static std::size_t turn = 0;
  const auto all = map_observers(field);
  std::vector<Node> some;
  for (int i = 0; i < cases(6, 2, 1) && some.size() < all.size(); ++i) some.push_back(all[turn++ % all.size()]);
  return some;
}

TEST(Maps, HaveAtLeastSixtyFields) { EXPECT_GE(map_fields().size(), 60u); }

TEST(Maps, ViewshedsMatchTheJudge) {
  std::size_t visible = 0, hidden = 0;
  unsigned turn = 0;
  for (const MapField& kind : some_fields())
    for (const Node observer : some_observers(kind.field)) {
      // Observers use the sets of settings in turn, so that every set is combined with every shape.
      const auto settings = map_settings();
      const auto& chosen = settings[turn++ % settings.size()];
      const auto judged = judge_viewshed(kind.field, observer, chosen);
      const auto codes = viewshed(kind.field, observer, chosen);
      ASSERT_EQ(codes.size(), judged.size());
      for (std::size_t i = 0; i < codes.size(); ++i) {
        ASSERT_EQ(codes[i], judged[i]) << place(kind, i) << " from " << observer.col << ", " << observer.row;
        visible += codes[i] == Seen::visible;
        hidden += codes[i] == Seen::hidden;
      }
    }
  const auto least = static_cast<std::size_t>(cases(1000, 1000, 100));
  EXPECT_GT(visible, least);
  EXPECT_GT(hidden, least);
}

TEST(Maps, LeastVisibleHeightsMatchTheJudge) {
  unsigned turn = 0;
  for (const MapField& kind : some_fields())
    for (const Node observer : some_observers(kind.field)) {
      const auto settings = map_settings();
      const Viewpoint view(kind.field, observer, settings[turn++ % settings.size()]);
      const auto least = least_visible(kind.field, observer, view.settings());
      for (std::size_t i = 0; i < least.size(); ++i) {
        const int col = static_cast<int>(i) % kind.field.cols(), row = static_cast<int>(i) / kind.field.cols();
        const double judged = judge_least_visible(view, {col, row});
        ASSERT_TRUE(least[i] == judged || (std::isnan(least[i]) && std::isnan(judged)))
            << place(kind, i) << ": " << least[i] << ", not " << judged;
      }
    }
}

// A plane 10 m below the eye; a wall with a hole on it hides the ground behind it.
TEST(Maps, AnglesMatchTheLinesOfSight) {
  constexpr int kSide = 21;
  std::vector<float> heights(kSide * kSide, 0);
  for (int row = 0; row < kSide; ++row) heights[static_cast<std::size_t>(row * kSide + 15)] = 40;
  heights[15] = std::nanf("");
  const auto field = HeightField::own(std::move(heights), kSide, kSide, {.cell_x = 20, .cell_y = 30});
  const ViewshedSettings settings{.observer_height = 10, .target_height = 5, .curvature = {1, 5000}};
  const Viewpoint view(field, {10, 10}, settings);
  const auto codes = viewshed(field, {10, 10}, settings);
  const auto angles = sight_angles(view, codes);
  const auto at = [&](int col, int row) { return angles[static_cast<std::size_t>(row * kSide + col)]; };
  const auto expected = [](double height, double distance) {
    return std::atan((height - distance * distance / 5000) / distance) * 180 / std::numbers::pi;
  };
  EXPECT_NEAR(at(10, 0), expected(5 - 10, 300), 1e-5);
  EXPECT_NEAR(at(8, 11), expected(5 - 10, 50), 1e-5);
  EXPECT_NEAR(at(15, 10), expected(45 - 10, 100), 1e-5);
  EXPECT_EQ(at(10, 10), -90);  // straight down
  EXPECT_TRUE(std::isnan(at(17, 10)));
  EXPECT_TRUE(std::isnan(at(15, 0)));
  for (std::size_t i = 0; i < codes.size(); ++i) EXPECT_EQ(std::isnan(angles[i]), codes[i] != Seen::visible);
  const auto last = sight_angles(view, std::span(codes).last(2 * kSide), kSide - 2);
  EXPECT_EQ(last[3], at(3, kSide - 2));
}

TEST(Maps, ShadowsMatchTheJudge) {
  std::size_t counts[4] = {};
  const auto suns = map_suns();
  const auto turns = static_cast<std::size_t>(cases(static_cast<int>(suns.size()), 5, 2));
  std::size_t turn = 0;
  for (const MapField& kind : some_fields())
    for (std::size_t k = 0; k < turns; ++k) {
      const SunDirection& sun = suns[turn++ % suns.size()];
      const auto codes = shadow(kind.field, sun), judged = judge_shadow(kind.field, sun);
      for (std::size_t i = 0; i < codes.size(); ++i) {
        ASSERT_EQ(codes[i], judged[i]) << place(kind, i) << ", sun " << sun.azimuth << ", " << sun.altitude;
        ++counts[static_cast<int>(codes[i])];
      }
    }
  const auto least = static_cast<std::size_t>(cases(100, 100, 10));
  for (const std::size_t count : counts) EXPECT_GT(count, least);
}

// Passes over the field are parts of one task.
TEST(Maps, ProgressNeverDecreases) {
  std::vector<float> heights;
  for (int i = 0; i < 200 * 200; ++i) heights.push_back(static_cast<float>(i * 7919 % 31));
  const HeightField field = HeightField::own(std::move(heights), 200, 200);
  const SunDirection sun{1, 0.3};
  ViewshedSettings near;
  near.max_distance = 90;
  const std::pair<const char*, std::function<void(const Progress&)>> maps[] = {
      {"viewshed",
       [&](const Progress& progress) {
         viewshed(field, {9, 9}, near, progress);
       }},
      {"least visible",
       [&](const Progress& progress) {
         least_visible(field, {9, 9}, near, progress);
       }},
      {"shadow", [&](const Progress& progress) { shadow(field, sun, progress); }},
      {"lit share",
       [&](const Progress& progress) {
         lit_share(SunGround(field), sun, RowBand{0, field.rows()}, progress);
       }},
      {"heights of a sky view",
       [&](const Progress& progress) { SkyView(field, {}, 4, {SkyMeasure::negative_openness}, progress); }},
      {"sky view", [&](const Progress& progress) {
         SkyView(field, {}, 4, {SkyMeasure::sky_fraction, SkyMeasure::negative_openness})
             .rows(0, field.rows(), progress);
       }}};
  for (const auto& one : maps) {
    const std::string name = one.first;
    double last = 0;
    one.second([&](double share) {
      EXPECT_GE(share, last) << name;
      last = share;
      return true;
    });
    EXPECT_EQ(last, 1) << name;
  }
}

// Terms that the filter cannot decide.
TEST(CrossingSign, IsExact) {
  const double tiny = 0x1p-40;
  EXPECT_EQ(sign_of({1, 3, 1, 5, 1, 6, 1, 2}), 0);
  EXPECT_EQ(sign_of({1e15, 3, 1, 1, 1e15, 3, 1, 1}), 0);
  EXPECT_EQ(sign_of({1e15, 3, 1 + tiny, 1, 1e15, 3, 1, 1}), 1);
  EXPECT_EQ(sign_of({1e15, 3, 1, 1, 1e15, 3, 1 + tiny, 1}), -1);
  // 0.1 * 3 is not 0.3: the products are exact, not rounded.
  EXPECT_EQ(sign_of({0.1, 3, 0, 0, 0.3, 1, 0, 1}), 1);
}

TEST(Viewshed, RejectsBadInput) {
  const auto field = HeightField::own(std::vector<float>{1, 2, 3, std::nanf("")}, 2, 2);
  EXPECT_THROW(viewshed(field, {2, 0}), Error);
  EXPECT_THROW(viewshed(field, {1, 1}), Error);
  EXPECT_NO_THROW(viewshed(field, {1, 1}, {.observer_z = 5}));
  EXPECT_THROW(viewshed(field, {0, 0}, {.observer_z = 0.5}), Error);
  EXPECT_THROW(viewshed(field, {0, 0}, {.observer_height = -1}), Error);
  EXPECT_THROW(viewshed(field, {0, 0}, {.target_height = std::nan("")}), Error);
  EXPECT_THROW(viewshed(field, {0, 0}, {.curvature = {.coefficient = 11}}), Error);
  EXPECT_THROW(viewshed(field, {0, 0}, {.min_distance = 5, .max_distance = 1}), Error);
  EXPECT_THROW(viewshed(field, {0, 0}, {.first_azimuth = 7}), Error);
  EXPECT_THROW(shadow(field, {.altitude = 0}), Error);
  EXPECT_THROW(shadow(field, {.altitude = 2}), Error);
  const auto wrapped = HeightField::own(std::vector<float>{1, 2, 3, 4}, 2, 2, {.wrap = Wrap::periodic});
  EXPECT_THROW(viewshed(wrapped, {0, 0}), Error);
  EXPECT_THROW(shadow(wrapped, {.altitude = 1}), Error);
}

}  // namespace
}  // namespace scarp::test
