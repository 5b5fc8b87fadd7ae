// SPDX-License-Identifier: MIT
// The closest point of the ground, against the distances to many points of every cell.
#include "scarp/march/height/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/refusal.h"
#include "bench/sweep_judge.h"
#include "march/height/spiteful.h"

namespace scarp::test {
namespace {

// Distance to all cells, each split into parts x parts pieces of two triangles.
double by_force(const HeightField& field, const dvec3& p, int parts) {
  double best = std::numeric_limits<double>::infinity();
  for (const bench::JudgedTriangle& triangle : bench::all_triangles(field, parts))
    best = std::min(best, bench::to_triangle(p, triangle));
  return best;
}

TEST(ClosestPoint, MatchesASearchOfAllTriangles) {
  Random random(2);
  for (int round = 0; round < 60; ++round) {
    const HeightField field =
        rugged(random, 20, 3, round % 3 ? 0.05 : 0, {.offset = 10, .surface = Surface::triangles});
    const MaxPyramid pyramid(field);
    for (int i = 0; i < 30; ++i) {
      const dvec3 p(uniform(random, -5, field.width() + 5), uniform(random, -5, field.depth() + 5),
                    uniform(random, 0, 25));
      const auto found = closest_point({&field, &pyramid}, p);
      const double expected = by_force(field, p, 1);
      ASSERT_EQ(found.has_value(), std::isfinite(expected));
      if (!found) continue;
      EXPECT_NEAR(found->distance, expected, 1e-12 * (1 + expected));
      EXPECT_NEAR(length(found->point - p), found->distance, 1e-12 * (1 + expected));
      EXPECT_NEAR(field.height_from_sample(
                      height_in_cell(Surface::triangles, *field.cell_heights(found->cell), found->u, found->v)),
                  found->point.z, 1e-9);
      // A limit just below and above.
      EXPECT_FALSE(closest_point({&field, &pyramid}, p, expected * (1 - 1e-9)));
      EXPECT_TRUE(closest_point({&field, &pyramid}, p, expected * (1 + 1e-9)));
    }
  }
}

TEST(ClosestPoint, StaysWithinItsBoundOnBilinearCells) {
  Random random(3);
  constexpr int kParts = 6;
  for (int round = 0; round < 12; ++round) {
    const HeightField field = rugged(random, 20, 3, round % 3 ? 0.05 : 0, {.offset = 10});
    const MaxPyramid pyramid(field);
    // The pieces of a cell deviate from it by this much: a quarter of their twist, which is at most 4 times the relief
    // of 6 m.
    const double off = 0.25 * 24 / (kParts * kParts),
                 bound = 0x1p-20 * std::min(field.settings().cell_x, field.settings().cell_y);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p(uniform(random, -3, field.width() + 3), uniform(random, -3, field.depth() + 3),
                    uniform(random, 5, 15));
      const auto found = closest_point({&field, &pyramid}, p);
      const double pieces = by_force(field, p, kParts);
      ASSERT_EQ(found.has_value(), std::isfinite(pieces));
      if (!found) continue;
      EXPECT_LE(found->distance, pieces + off + bound);
      EXPECT_GE(found->distance, pieces - off);
      EXPECT_EQ(found->distance, length(found->point - p));
      // On the surface.
      EXPECT_NEAR(field.height_from_sample(
                      height_in_cell(Surface::bilinear, *field.cell_heights(found->cell), found->u, found->v)),
                  found->point.z, 1e-12);
      // No point of the cell or its neighbours is closer by more than the bound.
      for (int j = 0; j < 200; ++j) {
        const double x = found->point.x + uniform(random, -0.01, 0.01),
                     y = found->point.y + uniform(random, -0.01, 0.01);
        if (const auto z = field.height(x, y)) {
          EXPECT_GE(length(dvec3(x, y, *z) - p), found->distance - bound);
        }
      }
    }
  }
}

TEST(ClosestPoint, RejectsUnsupportedQueries) {
  const std::vector<float> flat(25, 1.0f);
  const HeightField wrapped = HeightField::own(flat, 5, 5, {.wrap = Wrap::periodic}),
                    field = HeightField::own(flat, 5, 5);
  const MaxPyramid pyramid(wrapped);
  EXPECT_NE(refusal([&] { closest_point({&wrapped, &pyramid}, dvec3(0.0)); }), "");
  EXPECT_NE(refusal([&] { closest_point({&field}, dvec3(0.0)); }), "");
  const HeightField line = HeightField::own(std::vector<float>(5), 5, 1);
  const MaxPyramid none(line);
  EXPECT_FALSE(closest_point({&line, &none}, dvec3(0.0)));
}

}  // namespace
}  // namespace scarp::test
