// SPDX-License-Identifier: MIT
// Sweeps of spheres and capsules over height fields, and overlaps of boxes, against all triangles.
#include "scarp/march/height/ground_contact.h"
#include "scarp/march/closest_of.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <vector>

#include "base/refusal.h"
#include "bench/sweep_judge.h"
#include "cases.h"
#include "march/height/spiteful.h"

namespace scarp::test {
namespace {

using bench::JudgedSweep;
using bench::JudgedTriangle;

// Some units in the last place of numbers up to 8.
constexpr double kRounding = 0x1p-48;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

dvec3 direction(Random& random) {
  for (;;) {
    const dvec3 d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    if (const double square = dot(d, d); square > 0.01 && square < 1) return normalize(d);
  }
}

struct Moving {
  Capsule capsule;
  dvec3 motion;
};

// Capsules move between random positions around the field; some of them are aimed at nodes, sides and grazes.
Moving random_sweep(const HeightField& field, const std::vector<JudgedTriangle>& triangles, Random& random) {
  const auto about = [&] {
    return dvec3(uniform(random, -2, field.width() + 2), uniform(random, -2, field.depth() + 2),
                 uniform(random, -4, 6));
  };
  Moving moving{{about(), {}, std::pow(10, uniform(random, -4, 0.3))}, {}};
  moving.capsule.b = moving.capsule.a;
  if (whole(random, 0, 1)) moving.capsule.b += uniform(random, 0, 3) * direction(random);
  moving.motion = about() - moving.capsule.a;
  const int aim = whole(random, 0, 5);
  if (triangles.empty() || aim > 2) return moving;
  const JudgedTriangle& t =
      triangles[static_cast<std::size_t>(whole(random, 0, static_cast<int>(triangles.size()) - 1))];
  // A node, a point of a side, or, for a graze, a point off a side by the radius.
  dvec3 target = t[0] + (aim == 0 ? 0.0 : uniform(random, 0, 1)) * (t[1] - t[0]);
  if (aim == 2) target += moving.capsule.radius * direction(random);
  moving.motion = (target - moving.capsule.a) * (whole(random, 0, 1) ? 1.0 : uniform(random, 1, 3));
  return moving;
}

void expect_no_tunnelling(Surface surface, int parts) {
  Random random(11);
  int contacts = 0, starts = 0;
  // The judge's time is proportional to the number of triangles.
  const int fewer = parts * parts;
  for (int round = 0; round < cases(400, 60, 12); ++round) {
    const HeightField field = rugged(random, 9, 2, round % 3 ? 0 : 0.2, {.surface = surface});
    const MaxPyramid pyramid(field);
    const auto triangles = bench::all_triangles(field, parts);
    // The triangles of both the judge and the sweep deviate from a bilinear surface.
    const double cell = std::min(field.settings().cell_x, field.settings().cell_y);
    const double off = parts == 1 ? 0 : 2.0 / (parts * parts) + 0x1p-21 * cell;
    for (int i = 0; i < cases(400, 100, 40) / fewer; ++i) {
      const auto [capsule, motion] = random_sweep(field, triangles, random);
      const auto found = sweep({&field, &pyramid}, capsule, motion);
      const JudgedSweep judged{capsule.a, capsule.b, capsule.radius, motion};
      const auto error = bench::judge_sweep(judged, triangles, found.has_value(), found ? found->t : 0, off);
      ASSERT_EQ(error.tunnelled, 0) << round << ", " << i;
      ASSERT_EQ(error.untouched, 0) << round << ", " << i;
      if (!found) continue;
      ++contacts;
      starts += found->t == 0;
      ASSERT_NEAR(length(found->normal), 1, kRounding);
      ASSERT_TRUE(field.cell_heights(found->cell));
      if (found->t == 0) continue;
      // The point is on the capsule at its position at that time, and the normal opposes the motion.
      const double rounding = judged.rounding() + off;
      ASSERT_NEAR(bench::to_segment(found->point, capsule.a + found->t * motion, capsule.b + found->t * motion),
                  capsule.radius, rounding);
      // The normal is the difference of two points, each rounded, over the radius.
      if (off == 0) {
        ASSERT_LE(dot(found->normal, motion), 2 * rounding / capsule.radius * length(motion));
      }
    }
  }
  EXPECT_GT(contacts, cases(40'000, 1500, 100) / fewer / 2);
  EXPECT_GT(starts, 0);
}

TEST(Sweep, NeverTunnelsThroughTriangles) { expect_no_tunnelling(Surface::triangles, 1); }
TEST(Sweep, NeverTunnelsThroughBilinearCells) { expect_no_tunnelling(Surface::bilinear, 4); }

// Points of every cell, exactly on the surface: none is passed before the contact.
TEST(Sweep, PassesNoPointOfBilinearCells) {
  Random random(14);
  constexpr int kPoints = 12;
  int contacts = 0;
  const int rounds = cases(2000, 300, 60);
  for (int round = 0; round < rounds; ++round) {
    const HeightField field = rugged(random, 6, std::pow(2, uniform(random, -3, 1)), round % 3 ? 0 : 0.2, {});
    const MaxPyramid pyramid(field);
    const double slack = 0x1p-20 * std::min(field.settings().cell_x, field.settings().cell_y);
    std::vector<dvec3> points;
    for (int row = 0; row < field.cell_rows(); ++row) {
      for (int col = 0; col < field.cell_cols(); ++col) {
        const auto h = field.cell_heights({col, row});
        for (int i = 0; h && i <= kPoints * (kPoints + 2); ++i) {
          const double u = static_cast<double>(i % (kPoints + 1)) / kPoints,
                       v = static_cast<double>(i / (kPoints + 1)) / kPoints;
          points.push_back(field.world_from_grid(col + u, row + v, height_in_cell(Surface::bilinear, *h, u, v)));
        }
      }
    }
    const auto triangles = bench::all_triangles(field, 1);
    for (int i = 0; i < 20; ++i) {
      const auto [capsule, motion] = random_sweep(field, triangles, random);
      const auto found = sweep({&field, &pyramid}, capsule, motion);
      contacts += found.has_value();
      if (found && found->t == 0) continue;
      const dvec3 way = (found ? found->t : 1) * motion, &a = capsule.a, &b = capsule.b;
      for (const dvec3& p : points) {
        const double away = a == b ? bench::to_segment(p, a, a + way)
                                   : std::min(bench::to_triangle(p, JudgedTriangle{a, b, b + way}),
                                              bench::to_triangle(p, JudgedTriangle{a, b + way, a + way}));
        ASSERT_GE(away, capsule.radius - slack) << round << ", " << i;
      }
    }
  }
  EXPECT_GT(contacts, rounds);
}

// The closest distance of a capsule's centre line to the triangles of a field, at its start.
double to_all(const std::vector<JudgedTriangle>& triangles, const Capsule& capsule) {
  double least = kInfinity;
  for (const JudgedTriangle& triangle : triangles)
    least = std::min(least, bench::to_triangle(capsule.a, capsule.b, triangle));
  return least;
}

void expect_depths(Surface surface, int parts) {
  Random random(15);
  int overlapping = 0, crossing = 0;
  const int rounds = cases(600, 200, 60);
  for (int round = 0; round < rounds; ++round) {
    const HeightField field = rugged(random, 7, 2, round % 3 ? 0 : 0.2, {.surface = surface});
    const MaxPyramid pyramid(field);
    const auto triangles = bench::all_triangles(field, parts);
    // The judge's triangles deviate from a bilinear surface.
    const double off = parts == 1 ? kRounding : 2.0 / (parts * parts) + 0x1p-21;
    for (int i = 0; i < 40; ++i) {
      const auto [capsule, motion] = random_sweep(field, triangles, random);
      const auto found = sweep({&field, &pyramid}, capsule, motion);
      if (!found || found->t > 0) {
        if (found) {
          ASSERT_EQ(found->depth, 0);
        }
        continue;
      }
      ++overlapping;
      const double away = to_all(triangles, capsule);
      ASSERT_NEAR(length(found->normal), 1, kRounding);
      // Moved out by the depth, it touches the plane at the point.
      const auto above = [&](const dvec3& end) { return dot(found->normal, end - found->point) + found->depth; };
      // The normal is the difference of two rounded points over their distance.
      const double tilt = away > off ? kRounding * length(capsule.b - capsule.a) / away : 0;
      ASSERT_NEAR(std::min(above(capsule.a), above(capsule.b)), capsule.radius, off + kRounding + tilt)
          << round << ", " << i;
      if (away > off) {
        ASSERT_NEAR(found->depth, capsule.radius - away, off) << round << ", " << i;
      } else {
        ++crossing;
        ASSERT_GE(found->depth, capsule.radius - off);
      }
    }
  }
  EXPECT_GT(overlapping, rounds);
  EXPECT_GT(crossing, rounds / 10);
}

TEST(Sweep, StartsInOverlapOfTrianglesWithADepth) { expect_depths(Surface::triangles, 1); }
TEST(Sweep, StartsInOverlapOfBilinearCellsWithADepth) { expect_depths(Surface::bilinear, 4); }

HeightField plane(int cells, float height) {
  const auto side = static_cast<std::size_t>(cells + 1);
  return HeightField::own(std::vector<float>(side * side, height), cells + 1, cells + 1);
}

TEST(Sweep, StopsAtThePlane) {
  const HeightField field = plane(8, 1);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const auto ball = sweep(target, {{4, 4, 5}, {4, 4, 5}, 0.5}, {0, 0, -7});
  ASSERT_TRUE(ball);
  EXPECT_DOUBLE_EQ(ball->t, 0.5);
  EXPECT_EQ(ball->normal, dvec3(0, 0, 1));
  EXPECT_NEAR(length(ball->point - dvec3(4, 4, 1)), 0, kRounding);
  // From below, the plane's lower side is hit.
  EXPECT_EQ(sweep(target, {{4, 4, -3}, {4, 4, -3}, 1}, {0, 0, 6})->normal, dvec3(0, 0, -1));
  // A vertical capsule, and a horizontal one.
  EXPECT_DOUBLE_EQ(sweep(target, {{4, 4, 3}, {4, 4, 9}, 0.5}, {0, 0, -3})->t, 0.5);
  EXPECT_DOUBLE_EQ(sweep(target, {{2, 4, 3}, {6, 4, 3}, 0.5}, {0, 0, -3})->t, 0.5);
  // Outside of the field, at its border, and too short.
  EXPECT_FALSE(sweep(target, {{-1, 4, 3}, {-1, 4, 3}, 0.5}, {0, 0, -9}));
  EXPECT_TRUE(sweep(target, {{-0.4, 4, 3}, {-0.4, 4, 3}, 0.5}, {0, 0, -9}));
  EXPECT_FALSE(sweep(target, {{4, 4, 3}, {4, 4, 3}, 0.5}, {0, 0, -1.4}));
  // A ball whose centre is above the plane, and one below it; a vertical capsule through it.
  const auto sunk = sweep(target, {{4, 4, 1.2}, {4, 4, 1.2}, 0.5}, {0, 0, -1});
  EXPECT_NEAR(sunk->depth, 0.3, kRounding);
  EXPECT_EQ(sunk->normal, dvec3(0, 0, 1));
  EXPECT_EQ(sweep(target, {{4, 4, 0.75}, {4, 4, 0.75}, 0.5}, {0, 0, -1})->normal, dvec3(0, 0, -1));
  EXPECT_NEAR(sweep(target, {{4, 4, 0.6}, {4, 4, 3}, 0.5}, {1, 0, -1})->depth, 0.9, kRounding);
  // Capsules that touch the plane from the start.
  EXPECT_EQ(sweep(target, {{4, 4, 1.5}, {4, 4, 1.5}, 0.5}, {1, 0, 0})->t, 0);
  EXPECT_EQ(sweep(target, {{4, 4, 1.2}, {4, 4, 1.2}, 0.5}, dvec3(0.0))->t, 0);
  EXPECT_FALSE(sweep(target, {{4, 4, 2}, {4, 4, 2}, 0.5}, dvec3(0.0)));
}

TEST(Sweep, OfAPointMatchesARay) {
  const HeightField field = plane(8, 1);
  const MaxPyramid pyramid(field);
  const auto hit = sweep({&field, &pyramid}, {{3.2, 3.7, 4}, {3.2, 3.7, 4}, 0}, {0.5, 0.25, -6});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 0.5, kRounding);
}

TEST(ClosestOf, HandlesNearlyParallelSegments) {
  Random random(13);
  for (int i = 0; i < cases(100'000, 10'000, 1000); ++i) {
    const dvec3 d = direction(random), across = std::pow(10, uniform(random, -12, 0)) * direction(random);
    const dvec3 p(uniform(random, -1, 1), uniform(random, -1, 1), 0), e = uniform(random, 0.5, 2) * (d + across);
    const dvec3 q = p + uniform(random, -1, 1) * d + std::pow(10, uniform(random, -12, 0)) * direction(random);
    const ClosestPair pair = closest_of_segments(p, d, q, e);
    // The distance from a point of the first segment to the second segment is convex along the first.
    double low = 0, high = 1;
    for (int step = 0; step < 100; ++step) {
      const double x = (2 * low + high) / 3, y = (low + 2 * high) / 3;
      const bool before = bench::to_segment(p + x * d, q, q + e) < bench::to_segment(p + y * d, q, q + e);
      (before ? high : low) = before ? y : x;
    }
    const double expected = std::min(
        {bench::to_segment(p, q, q + e), bench::to_segment(p + d, q, q + e), bench::to_segment(p + low * d, q, q + e)});
    // Some roundings of coordinates below 8.
    ASSERT_LE(std::sqrt(pair.square()), expected + 64 * 0x1p-53 * 8) << i;
  }
}

TEST(Sweep, StaysPreciseOverLongDistances) {
  const HeightField field = plane(8, 0);
  const MaxPyramid pyramid(field);
  const dvec3 from(4 + 3e6, 4 - 2e6, 1e6), motion = 2.0 * (dvec3(4, 4, 0) - from);
  const auto hit = sweep({&field, &pyramid}, {from, from, 0.25}, motion);
  ASSERT_TRUE(hit);
  const JudgedSweep judged{from, from, 0.25, motion};
  EXPECT_NEAR((from + hit->t * motion).z, 0.25, judged.rounding());
}

// The part of a triangle inside a box, clipped by one side after another.
bool cut_by_box(const JudgedTriangle& triangle, const TurnedBox& box, double wider) {
  std::vector<dvec3> part;
  for (const dvec3& corner : triangle) part.push_back(glm::transpose(box.turn) * (corner - box.centre));
  for (int side = 0; side < 6; ++side) {
    const double sign = side % 2 ? 1 : -1;
    const auto outside = [&](const dvec3& p) { return sign * p[side / 2] - (box.half[side / 2] + wider); };
    std::vector<dvec3> rest;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const dvec3 &p = part[i], &q = part[(i + 1) % part.size()];
      const double at_p = outside(p), at_q = outside(q);
      if (at_p <= 0) rest.push_back(p);
      if ((at_p < 0) != (at_q < 0) && at_p != at_q) rest.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    part = rest;
    if (part.empty()) return false;
  }
  return true;
}

TEST(Overlap, MatchesATestOfAllTriangles) {
  Random random(12);
  int yes = 0, no = 0;
  for (int round = 0; round < cases(600, 60, 12); ++round) {
    const HeightField field = rugged(random, 9, 2, round % 3 ? 0 : 0.2, {.surface = Surface::triangles});
    const MaxPyramid pyramid(field);
    const auto triangles = bench::all_triangles(field, 1);
    for (int i = 0; i < 100; ++i) {
      TurnedBox box{
          {uniform(random, -1, field.width() + 1), uniform(random, -1, field.depth() + 1), uniform(random, -3, 3)},
          {uniform(random, 0, 0.6), uniform(random, 0, 0.6), uniform(random, 0, 0.6)}};
      box.turn = glm::dmat3(glm::rotate(glm::dmat4(1), uniform(random, 0, 6), direction(random)));
      const bool found = overlaps({&field, &pyramid}, box);
      const auto some = [&](double wider) {
        return std::any_of(triangles.begin(), triangles.end(),
                           [&](const JudgedTriangle& t) { return cut_by_box(t, box, wider); });
      };
      const double rounding = 1e-13 * (length(box.centre) + 1);
      ASSERT_TRUE(found || !some(-rounding)) << round << ", " << i;
      ASSERT_TRUE(!found || some(rounding)) << round << ", " << i;
      ++(found ? yes : no);
    }
  }
  EXPECT_GT(yes, cases(5000, 500, 100));
  EXPECT_GT(no, cases(5000, 500, 100));
}

TEST(Overlap, IncludesTouchingBoxes) {
  const HeightField field = plane(8, 1);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  EXPECT_TRUE(overlaps(target, {{4, 4, 2}, {1, 1, 1}}));
  EXPECT_FALSE(overlaps(target, {{4, 4, 2.5}, {1, 1, 1}}));
  EXPECT_FALSE(overlaps(target, {{4, 4, -4}, {1, 1, 1}}));
  EXPECT_TRUE(overlaps(target, {{4, 4, 1}, {0, 0, 0}}));
}

TEST(Sweep, RejectsInvalidCapsules) {
  const HeightField field = plane(8, 1);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal([&] { sweep({&field}, {}, dvec3(1.0)); }), "");
  EXPECT_NE(refusal([&] { sweep(target, {{nan, 0, 0}, {}, 1}, dvec3(1.0)); }), "");
  EXPECT_NE(refusal([&] { sweep(target, {{}, {}, -1}, dvec3(1.0)); }), "");
  EXPECT_NE(refusal([&] { sweep(target, {{}, {}, kInfinity}, dvec3(1.0)); }), "");
  EXPECT_NE(refusal([&] { sweep(target, {{}, {}, 1}, dvec3(kInfinity)); }), "");
  EXPECT_NE(refusal([&] { overlaps(target, {{}, {1, -1, 1}}); }), "");
  EXPECT_NE(refusal([&] { overlaps(target, {{}, {1, 1, 1}, glm::dmat3(2.0)}); }), "");
  const HeightField wrapped = HeightField::own(std::vector<float>(16), 4, 4, {.wrap = Wrap::periodic});
  const MaxPyramid other(wrapped);
  EXPECT_NE(refusal([&] { sweep({&wrapped, &other}, {}, dvec3(1.0)); }), "");
}

}  // namespace
}  // namespace scarp::test
