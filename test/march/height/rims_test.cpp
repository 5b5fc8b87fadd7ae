// SPDX-License-Identifier: MIT
// Rims of holes, borders and nodes belong to the ground for rays in any direction; and cutting a ray does not change
// its hits.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"

namespace scarp::test {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

// All exact answers to one ray.
void expect_hits(const HeightTarget& target, const Ray& ray, double t) {
  for (const Hit& hit : {march_max_mip(target, ray), march_exhaustive(target, ray)}) {
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit.t, t, 1e-12);
  }
  EXPECT_TRUE(occluded_max_mip(target, ray));
}

TEST(Rims, AreHitOnTheWayOut) {
  const HeightField flat = HeightField::own(std::vector<float>(17 * 17), 17, 17);
  const MaxPyramid pyramid(flat);
  expect_hits({&flat, &pyramid}, {{9.84375, -3.03125, 27.359375}, {6.15625, 7.03125, -27.359375}}, 1);
}

class RimsOfHoles : public testing::Test {
 protected:
  bool is_ground(int col, int row) const {
    return col >= 0 && row >= 0 && col < field_.cell_cols() && row < field_.cell_rows() &&
           field_.cell_heights({col, row});
  }
  template <class Check>
  void on_fields(const Check& check) {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
      std::vector<float> samples(kSide * kSide);
      for (float& sample : samples) sample = whole(random, 0, 3) == 0 ? kHole : static_cast<float>(whole(random, 0, 4));
      field_ = HeightField::own(samples, kSide, kSide);
      if (field_.all_nodata()) continue;
      const MaxPyramid pyramid(field_);
      check(HeightTarget{&field_, &pyramid}, samples);
    }
  }

  static constexpr int kSide = 9;
  HeightField field_ = HeightField::own(std::vector<float>(4), 2, 2);
};

TEST_F(RimsOfHoles, AreHitByVerticalRaysAndHeights) {
  int met = 0;
  on_fields([&](const HeightTarget& target, const std::vector<float>& samples) {
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) {
        const bool ground =
            is_ground(col, row) || is_ground(col - 1, row) || is_ground(col, row - 1) || is_ground(col - 1, row - 1);
        const dvec3 top = field_.world_from_grid(col, row, 100);
        ASSERT_EQ(field_.height(top.x, top.y).has_value(), ground) << col << ", " << row;
        if (!ground) {
          EXPECT_FALSE(march_max_mip(target, {top}));
          continue;
        }
        expect_hits(target, {top}, 100.0 - samples[static_cast<std::size_t>(row * kSide + col)]);
        ++met;
      }
    }
  });
  EXPECT_GT(met, 500);
}

TEST_F(RimsOfHoles, AreHitByRaysAlongGridLines) {
  int met = 0;
  on_fields([&](const HeightTarget& target, const std::vector<float>& samples) {
    for (int row = 0; row + 1 < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) {
        if (!is_ground(col, row) && !is_ground(col - 1, row)) continue;
        const auto at = static_cast<std::size_t>(row * kSide + col);
        const dvec3 middle = field_.world_from_grid(col, row + 0.5, 0.5 * (samples[at] + samples[at + kSide]));
        const dvec3 direction(0, 0.125, -16);
        expect_hits(target, {middle - direction, direction}, 1);
        ++met;
      }
    }
  });
  EXPECT_GT(met, 300);
}

// Where the ground touches a ray only at a node.
TEST_F(RimsOfHoles, AreHitAtTheirNodes) {
  Random random(4);
  int met = 0;
  on_fields([&](const HeightTarget& target, const std::vector<float>& samples) {
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) {
        if (!is_ground(col, row) && !is_ground(col - 1, row) && !is_ground(col, row - 1) &&
            !is_ground(col - 1, row - 1))
          continue;
        const dvec3 node = field_.world_from_grid(col, row, samples[static_cast<std::size_t>(row * kSide + col)]);
        const dvec3 direction(whole(random, -8, 8) / 64.0, whole(random, -8, 8) / 64.0, -50);
        expect_hits(target, {node - direction, direction}, 1);
        ++met;
      }
    }
  });
  EXPECT_GT(met, 500);
}

// t_max is inclusive: a ray that is cut at the t of its hit has the same hit, and no hit if it is cut earlier.
TEST(Ends, DoNotChangeHits) {
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 20; ++i) {
    std::vector<float> samples(24 * 24);
    for (float& sample : samples) sample = i % 2 == 0 ? 0.0f : static_cast<float>(uniform(random, 0, 4));
    HeightFieldSettings settings{.cell_x = 0.3, .cell_y = 0.7};
    settings.surface = i % 4 < 2 ? Surface::bilinear : Surface::triangles;
    const HeightField field = HeightField::own(samples, 24, 24, settings);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    std::vector<Ray> rays, ends, before;
    std::vector<Hit> own;
    for (int k = 0; k < 500; ++k) {
      const Ray ray{{uniform(random, -2, 9), uniform(random, -2, 18), uniform(random, 0, 9)},
                    {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 0)}};
      const Hit hit = march_max_mip(target, ray);
      if (!hit || hit.t == 0) continue;
      rays.push_back(ray), ends.push_back(ray), before.push_back(ray), own.push_back(hit);
      ends.back().t_max = hit.t;
      before.back().t_max = std::nextafter(hit.t, 0.0);
      for (const Ray& end : {ends.back(), before.back()}) {
        EXPECT_EQ(bool(march_max_mip(target, end)), end.t_max == hit.t);
        EXPECT_EQ(occluded_max_mip(target, end), end.t_max == hit.t);
      }
      const Hit exhaustive = march_exhaustive(target, ray);
      Ray end = ray;
      end.t_max = exhaustive.t;
      EXPECT_EQ(march_exhaustive(target, end), exhaustive);
    }
    std::vector<Hit> again(ends.size());
    closest_hits(target, ends, again);
    EXPECT_EQ(again, own);
    closest_hits(target, before, again);
    for (const Hit& hit : again) EXPECT_FALSE(hit);
    hits += static_cast<int>(own.size());
  }
  EXPECT_GT(hits, 1000);
}

}  // namespace
}  // namespace scarp::test
