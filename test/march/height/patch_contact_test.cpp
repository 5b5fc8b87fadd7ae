// SPDX-License-Identifier: MIT
// Contacts and closest points of parts of bilinear cells, against many points of the part: where they are proven, none
// is in the way or closer.
#include "scarp/march/height/patch_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/sweep_judge.h"
#include "cases.h"
#include "march/height/spiteful.h"

namespace scarp::test {
namespace {

constexpr double kSlack = 0x1p-21, kPatchRounding = 0x1p-44;
constexpr int kParts = 24;  // the judge looks at (kParts + 1)^2 points

// A cell with sides of about 1, and corners that are up to 4 apart.
Patch random_patch(Random& random) {
  const double relief = std::pow(2, uniform(random, -8, 2)), tilt = uniform(random, 0, 2);
  const auto z = [&] { return uniform(random, -tilt, tilt); };
  Patch patch{{uniform(random, -2, 2), uniform(random, -2, 2), z()},
              {uniform(random, 0.3, 1.5), 0, z()},
              {0, -uniform(random, 0.3, 1.5), z()},
              uniform(random, -relief, relief)};
  return patch;
}

std::vector<dvec3> points_of(const Patch& patch) {
  std::vector<dvec3> points;
  for (int row = 0; row <= kParts; ++row) {
    for (int col = 0; col <= kParts; ++col)
      points.push_back(patch.at(static_cast<double>(col) / kParts, static_cast<double>(row) / kParts));
  }
  return points;
}

// The distance of a point from all positions of the centre line until `t`: a parallelogram.
double to_swept(const dvec3& p, const Capsule& capsule, const dvec3& way) {
  const dvec3 &a = capsule.a, &b = capsule.b;
  if (a == b) return bench::to_segment(p, a, a + way);
  return std::min(bench::to_triangle(p, bench::JudgedTriangle{a, b, b + way}),
                  bench::to_triangle(p, bench::JudgedTriangle{a, b + way, a + way}));
}

TEST(PatchContact, IsTheFirstWhereProven) {
  Random random(21);
  int proven = 0, found = 0;
  for (int round = 0; round < cases(20'000, 4000, 1000); ++round) {
    const Patch patch = random_patch(random);
    const std::vector<dvec3> points = points_of(patch);
    Capsule capsule{{uniform(random, -4, 4), uniform(random, -4, 4), uniform(random, 0, 4)},
                    {},
                    round % 8 == 0 ? 0.0 : std::pow(2, uniform(random, -8, 1.5))};
    capsule.b = capsule.a;
    if (round % 3 == 0) capsule.b.z += uniform(random, -1, 2);
    if (round % 9 == 0) capsule.b.x += uniform(random, -1, 1);
    // To a point of the patch or past it.
    const dvec3 motion = uniform(random, 0.8, 2) * (patch.at(uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2)) +
                                                    dvec3(0, 0, uniform(random, -0.5, 0.5)) - capsule.a);
    const auto contact = patch_contact(patch, capsule, motion, 1, kSlack);
    if (!contact) continue;
    ++found;
    ASSERT_GE(contact->t, 0);
    ASSERT_LE(contact->t, 1);
    // It touches a point of the patch.
    const dvec3 way = contact->t * motion, &p = contact->point;
    const double u = (p.x - patch.corner.x) / patch.along_u.x, v = (p.y - patch.corner.y) / patch.along_v.y;
    ASSERT_TRUE(u >= -kPatchRounding && u <= 1 + kPatchRounding && v >= -kPatchRounding && v <= 1 + kPatchRounding)
        << round;
    ASSERT_NEAR(length(patch.at(u, v) - p), 0, kPatchRounding) << round;
    ASSERT_NEAR(length(contact->normal), 1, kPatchRounding);
    const double away = bench::to_segment(p, capsule.a + way, capsule.b + way);
    if (contact->t > 0) {
      ASSERT_NEAR(away, capsule.radius, kSlack) << round;
    } else {
      ASSERT_LE(away, capsule.radius + kSlack) << round;
    }
    if (!contact->proven) continue;
    ++proven;
    for (const dvec3& point : points)
      ASSERT_GE(to_swept(point, capsule, way), (contact->t > 0 ? capsule.radius : 0) - kSlack - kPatchRounding)
          << round;
  }
  EXPECT_GT(found, cases(20'000, 4000, 1000) / 3);
  EXPECT_GT(proven, found / 2);
}

TEST(PatchContact, ClosestPointIsTheClosestWhereProven) {
  Random random(22);
  int proven = 0;
  const int rounds = cases(20'000, 4000, 1000);
  for (int round = 0; round < rounds; ++round) {
    const Patch patch = random_patch(random);
    const dvec3 p = patch.at(uniform(random, -0.5, 1.5), uniform(random, -0.5, 1.5)) +
                    dvec3(0, 0, std::pow(2, uniform(random, -8, 2)) * (round % 2 ? 1 : -1));
    const PatchPoint found = closest_of_patch(patch, p, kSlack);
    ASSERT_TRUE(found.u >= 0 && found.u <= 1 && found.v >= 0 && found.v <= 1);
    ASSERT_EQ(length(found.point - patch.at(found.u, found.v)), 0);
    ASSERT_NEAR(found.distance, length(found.point - p), kPatchRounding);
    if (!found.proven) continue;
    ++proven;
    for (const dvec3& point : points_of(patch)) ASSERT_GE(length(point - p), found.distance - kSlack) << round;
  }
  EXPECT_GT(proven, rounds / 2);
}

}  // namespace
}  // namespace scarp::test
