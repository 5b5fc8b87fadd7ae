// SPDX-License-Identifier: MIT
// The sweeps over all nodes against one ray per node, on many random fields with exact ties, holes and cliffs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "scarp/analysis/shadow_sweep.h"
#include "scarp/analysis/sight_rays.h"
#include "scarp/analysis/viewshed_sweep.h"
#include "scarp/base/parallel.h"

namespace scarp::test {
namespace {

class SweepDraw {
 public:
  explicit SweepDraw(unsigned seed) : random_(seed) {}
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  bool one_in(int count) { return below(count) == 0; }

 private:
  std::mt19937 random_;
};

constexpr int kSweepShapes = 10;
// Several blocks of 16 samples, so that some are skipped.
constexpr int kSweepSide = 60;

float sweep_height(int shape, int col, int row, int cols, int rows, int a, int b, SweepDraw& draw) {
  const auto x = static_cast<float>(col), y = static_cast<float>(row);
  const auto fa = static_cast<float>(a), fb = static_cast<float>(b);
  const float from_middle_x = x - static_cast<float>(cols / 2), from_middle_y = y - static_cast<float>(rows / 2);
  switch (shape) {
    case 0:
      return static_cast<float>(draw.below(std::abs(a) + 2));
    case 1:
      return fa * x + fb * y;
    case 2:
      return (fa * x + fb * y) / 8 + (draw.one_in(50) ? 1.f : 0.f);
    case 3:
      return -std::max(std::abs(from_middle_x), std::abs(from_middle_y));
    case 4:
      return 0;
    case 5:
      return col / 5 % 2 ? 100.f : 0.f;
    case 6:
      return static_cast<float>(draw.below(1000000)) * 1e-4f;
    case 7:
      return fa * std::hypot(from_middle_x, from_middle_y);
    case 8:
      return -std::abs(fa * x + fb * y - 20);
    default:
      return static_cast<float>(draw.below(3)) * (x + y);
  }
}

HeightField sweep_field(int number, SweepDraw& draw) {
  const bool large = number % 7 == 0;
  const int cols = large ? kSweepSide : 1 + draw.below(24), rows = large ? kSweepSide - 10 : 1 + draw.below(24);
  const int a = draw.below(9) - 4, b = draw.below(9) - 4;
  const bool holes = number / kSweepShapes % 3 == 0;
  const int every = 2 + draw.below(12);
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const float height = sweep_height(number % kSweepShapes, col, row, cols, rows, a, b, draw);
      samples.push_back(holes && draw.one_in(every) ? std::nanf("") : height);
    }
  }
  return HeightField::own(std::move(samples), cols, rows, {.cell_x = 1.0 + number % 3, .cell_y = 1.0 + number % 2});
}

Viewpoint sweep_view(const HeightField& field, int number, SweepDraw& draw) {
  Node observer{draw.below(field.cols()), draw.below(field.rows())};
  if (draw.one_in(5)) observer = {draw.one_in(2) ? 0 : field.cols() - 1, draw.one_in(2) ? 0 : field.rows() - 1};
  ViewshedSettings settings;
  const double heights[] = {0, 0.5, 2, 1000};
  settings.observer_height = heights[draw.below(4)];
  if (!SightGround(field).height(observer)) settings.observer_z = draw.below(5);
  settings.target_height = draw.one_in(3) ? 1.5 : 0;
  settings.curvature = {.coefficient = number % 4 == 3 ? 1.0 : 0.0, .diameter = 100};
  if (number % 9 == 0) {
    settings.min_distance = 2;
    settings.max_distance = 10;
  }
  return Viewpoint(field, observer, settings);
}

SunDirection sweep_sun(SweepDraw& draw) {
  SunDirection sun;
  const int kind = draw.below(4);
  sun.azimuth = kind == 0   ? draw.below(8) * std::numbers::pi / 4
                : kind == 1 ? std::atan2(1 + draw.below(3), 1 + draw.below(4))
                            : draw.below(6283) * 1e-3;
  sun.altitude = draw.one_in(4)   ? std::atan(1.0)
                 : draw.one_in(9) ? std::numbers::pi / 2
                                  : (1 + draw.below(1500)) * 1e-3;
  return sun;
}

std::size_t sweep_index(const HeightField& field, Node node) {
  return static_cast<std::size_t>(node.row) * static_cast<std::size_t>(field.cols()) +
         static_cast<std::size_t>(node.col);
}
std::size_t sweep_size(const HeightField& field) { return sweep_index(field, {0, field.rows()}); }

template <class Body>
void for_nodes(const HeightField& field, const Body& body) {
  for (int row = 0; row < field.rows(); ++row) {
    for (int col = 0; col < field.cols(); ++col) body(Node{col, row}, sweep_index(field, {col, row}));
  }
}

std::string sweep_place(int number, const HeightField& field, Node node) {
  return "field " + std::to_string(number) + ", " + std::to_string(field.cols()) + " x " +
         std::to_string(field.rows()) + ", at " + std::to_string(node.col) + ", " + std::to_string(node.row);
}

constexpr int kSweptFields = 400;

TEST(Sweeps, ViewshedsMatchRays) {
  SweepDraw draw(1);
  SweepStatistics statistics;
  for (int number = 0; number < kSweptFields; ++number) {
    const HeightField field = sweep_field(number, draw);
    const Viewpoint view = sweep_view(field, number, draw);
    std::vector<Seen> codes(sweep_size(field));
    statistics.add(sweep_viewshed(view, codes.data()));
    for_nodes(field, [&](Node node, std::size_t i) {
      const auto lowered = view.ground().lowered(node);
      const double target = view.target(lowered.value_or(0));
      const Seen expected = !lowered                                                         ? Seen::hole
                            : !view.in_range(node, target)                                   ? Seen::out_of_range
                            : sees(view.ground(), view.observer(), view.eye(), node, target) ? Seen::visible
                                                                                             : Seen::hidden;
      ASSERT_EQ(codes[i], expected) << sweep_place(number, field, node) << " from " << view.observer().col << ", "
                                    << view.observer().row << ", eye " << view.eye();
    });
  }
  // All branches of the code are taken.
  EXPECT_GT(statistics.skipped, 1000);
  EXPECT_GT(statistics.careful, 1000);
  EXPECT_GT(statistics.walked, 10);
}

TEST(Sweeps, LeastVisibleHeightsMatchRays) {
  SweepDraw draw(2);
  for (int number = 0; number < kSweptFields; ++number) {
    const HeightField field = sweep_field(number, draw);
    const Viewpoint view = sweep_view(field, number, draw);
    std::vector<double> least(sweep_size(field));
    sweep_least_visible(view, least.data());
    for_nodes(field, [&](Node node, std::size_t i) {
      const auto lowered = view.ground().lowered(node);
      if (!lowered || !view.in_range(node, view.target(*lowered))) {
        ASSERT_TRUE(std::isnan(least[i])) << sweep_place(number, field, node);
      } else {
        ASSERT_EQ(least[i], least_visible(view.ground(), view.observer(), view.eye(), node))
            << sweep_place(number, field, node) << " from " << view.observer().col << ", " << view.observer().row;
      }
    });
  }
}

TEST(Sweeps, ShadowsMatchRays) {
  SweepDraw draw(3);
  SweepStatistics statistics;
  for (int number = 0; number < kSweptFields; ++number) {
    const HeightField field = sweep_field(number, draw);
    const SightGround ground(field);
    const SunDirection direction = sweep_sun(draw);
    const SunRay sun = sun_ray(field, direction);
    std::vector<Shade> codes(sweep_size(field));
    statistics.add(sweep_shadow(ground, sun, codes.data()));
    for_nodes(field, [&](Node node, std::size_t i) {
      ASSERT_EQ(codes[i], shade(ground, sun, node))
          << sweep_place(number, field, node) << ", sun " << direction.azimuth << ", " << direction.altitude;
    });
  }
  EXPECT_GT(statistics.skipped, 100);
}

// One of the eight symmetries of the grid: swaps the axes, then mirrors columns and rows.
struct GridSymmetry {
  bool swaps, mirrors_cols, mirrors_rows;
  int cols, rows;  // of the image

  GridSymmetry(int number, int from_cols, int from_rows)
      : swaps(number & 1),
        mirrors_cols(number & 2),
        mirrors_rows(number & 4),
        cols(swaps ? from_rows : from_cols),
        rows(swaps ? from_cols : from_rows) {}
  Node operator()(Node n) const {
    if (swaps) std::swap(n.col, n.row);
    return {mirrors_cols ? cols - 1 - n.col : n.col, mirrors_rows ? rows - 1 - n.row : n.row};
  }
  SunRay operator()(SunRay sun) const {
    if (swaps) std::swap(sun.col, sun.row);
    return {mirrors_cols ? -sun.col : sun.col, mirrors_rows ? -sun.row : sun.row, sun.rise};
  }
};

// The maps of a field that is rotated by quarter turns or mirrored are rotated and mirrored, too: no direction is
// favoured.
TEST(Sweeps, AreSymmetric) {
  SweepDraw draw(4);
  for (int number = 0; number < 64; ++number) {
    const int cols = 5 + draw.below(40), rows = 5 + draw.below(40);
    const bool holes = draw.one_in(3);
    std::vector<float> samples, turned(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    for (int i = 0; i < cols * rows; ++i)
      samples.push_back(holes && draw.one_in(9) ? std::nanf("") : static_cast<float>(draw.below(6)));
    const GridSymmetry turn(number % 8, cols, rows);
    const HeightField field = HeightField::own(samples, cols, rows);
    const auto at = [&](Node n) { return static_cast<std::size_t>(n.row * turn.cols + n.col); };
    for_nodes(field, [&](Node node, std::size_t i) { turned[at(turn(node))] = samples[i]; });
    const HeightField other = HeightField::own(turned, turn.cols, turn.rows);
    const Node observer{draw.below(cols), draw.below(rows)};
    const ViewshedSettings settings{.observer_z = 7};
    const SunRay sun = sun_ray(field, sweep_sun(draw));
    const std::size_t size = sweep_size(field);
    const auto codes = viewshed(field, observer, settings), turned_codes = viewshed(other, turn(observer), settings);
    const auto least = least_visible(field, observer, settings),
               turned_least = least_visible(other, turn(observer), settings);
    std::vector<Shade> shades(size), turned_shades(size);
    sweep_shadow(SightGround(field), sun, shades.data());
    sweep_shadow(SightGround(other), turn(sun), turned_shades.data());
    for_nodes(field, [&](Node node, std::size_t i) {
      const std::size_t k = at(turn(node));
      ASSERT_EQ(codes[i], turned_codes[k]) << sweep_place(number, field, node);
      ASSERT_TRUE(least[i] == turned_least[k] || (std::isnan(least[i]) && std::isnan(turned_least[k])))
          << sweep_place(number, field, node);
      ASSERT_EQ(shades[i], turned_shades[k]) << sweep_place(number, field, node);
    });
  }
}

// Visibility between two nodes is mutual, and a higher sun lights more nodes.
TEST(Sweeps, AreReciprocalAndMonotone) {
  SweepDraw draw(6);
  int visible = 0, lit_later = 0;
  for (int number = 0; number < 40; ++number) {
    const HeightField field = sweep_field(number, draw);
    ViewshedSettings settings{.observer_height = 1, .target_height = 1, .curvature = {.coefficient = 0}};
    const SightGround ground(field);
    const Node a{draw.below(field.cols()), draw.below(field.rows())};
    if (!ground.height(a)) continue;
    const auto seen = viewshed(field, a, settings);
    for (int i = 0; i < 8; ++i) {
      const Node b{draw.below(field.cols()), draw.below(field.rows())};
      if (!ground.height(b)) continue;
      const auto back = viewshed(field, b, settings);
      ASSERT_EQ(seen[sweep_index(field, b)], back[sweep_index(field, a)]) << sweep_place(number, field, b);
      visible += back[sweep_index(field, a)] == Seen::visible;
    }
    const double azimuth = draw.below(6283) * 1e-3;
    std::vector<Shade> before;
    for (const double altitude : {0.02, 0.1, 0.3, 0.9, 1.4}) {
      const auto shades = shadow(field, {azimuth, altitude});
      for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i] == Shade::lit) {
          ASSERT_EQ(shades[i], Shade::lit) << "field " << number;
        }
        lit_later += before[i] != Shade::lit && shades[i] == Shade::lit;
      }
      before = shades;
    }
  }
  EXPECT_GT(visible, 50);
  EXPECT_GT(lit_later, 500);
}

TEST(Sweeps, DoNotDependOnThreads) {
  SweepDraw draw(5);
  std::vector<float> samples;
  for (int i = 0; i < 200 * 190; ++i) samples.push_back(static_cast<float>(draw.below(1000)) * 0.1f);
  const HeightField field = HeightField::own(samples, 200, 190);
  const ViewshedSettings settings{.observer_height = 30};
  const SunDirection sun{1, 0.5};
  const auto codes = viewshed(field, {90, 100}, settings);
  const auto least = least_visible(field, {90, 100}, settings);
  const auto shades = shadow(field, sun);
  const ThreadLimit one(1);
  EXPECT_EQ(codes, viewshed(field, {90, 100}, settings));
  EXPECT_EQ(least, least_visible(field, {90, 100}, settings));
  EXPECT_EQ(shades, shadow(field, sun));
}

}  // namespace
}  // namespace scarp::test
