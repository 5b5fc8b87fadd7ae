// SPDX-License-Identifier: MIT
// The judge of `scarp-bench leaks`, in cases in which it was once wrong, and in which it must find errors.
#include "bench/leak_judge.h"

#include <gtest/gtest.h>

#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::bench {
namespace {

LeakField plane() {
  constexpr int kCols = 64, kRows = 48;
  std::vector<float> samples;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col)
      samples.push_back(0.5F * static_cast<float>(col) + 0.25F * static_cast<float>(row));
  }
  HeightFieldSettings settings;
  settings.cell_x = 7.3, settings.cell_y = 5.1, settings.scale = 0.3;
  return {"plane", HeightField::own(std::move(samples), kCols, kRows, settings), {}};
}

// 47 * 5.1 is a little over 47 cells in binary: the ray starts north of the field by less than rounding, and enters so
// slowly that it falls by 5e-11 until then. It is on the surface where it starts, and hits there.
Ray along_the_border() {
  Ray ray;
  ray.origin = {0x1.e1ccccccccccdp+7, 0x1.df66666666666p+7, 0x1.3cccccccccccdp+2};
  ray.direction = {0x1.ffffffc3b629p-1, -0x1.f0ee99116334p-14, -0x1.d5ea0ba60076p-3};
  ray.t_min = 0, ray.t_max = 102;
  ray.start = RayStart::on_surface, ray.start_cell = {33, 0};
  return ray;
}

Hit hit_at(double t, double u, double v) {
  Hit hit;
  hit.status = HitStatus::hit;
  hit.t = t, hit.cell = {33, 0}, hit.u = u, hit.v = v;
  return hit;
}

TEST(LeakJudge, RayStartingOutsideByRoundingIsOnTheSurface) {
  const LeakField ground = plane();
  const LeakJudge judge(ground, along_the_border());
  EXPECT_TRUE(judge.must_hit());
  EXPECT_EQ(judge.false_hit(hit_at(0, 0, 0)), nullptr);
  EXPECT_TRUE(judge.same(hit_at(0, 0, 0), hit_at(0, 0, 0)));
}

TEST(LeakJudge, DistinguishesFalseHitsFromLostHits) {
  const LeakField ground = plane();
  const LeakJudge judge(ground, along_the_border());
  const Ray ray = along_the_border();
  const double t = 1, u = ray.direction.x * t / 7.3, v = -ray.direction.y * t / 5.1;
  EXPECT_STREQ(judge.false_hit(hit_at(t, u, v)), "not on the surface");
  EXPECT_STREQ(judge.lost(hit_at(t, u, v), 0.5), "a hit before the one that is told");
  EXPECT_STREQ(judge.lost(Hit{}, 0.5), "a ray that must hit");
}

// Along the diagonal of saddles, rising by 8e-13 per cell: at each node the ray leaves the ground and re-enters it
// immediately.
TEST(LeakJudge, AcceptsReentryRightAfterExit) {
  constexpr int kSide = 40;
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) samples.push_back((row + col) % 2 ? 4.F : 0.F);
  }
  const LeakField saddles{"saddles", HeightField::own(std::move(samples), kSide, kSide), {}};
  Ray ray;
  ray.origin = {36, 19, 0}, ray.direction = {-1, 1, 0x1.bf7224218p-41};
  ray.t_max = 20;
  ray.start = RayStart::on_surface, ray.start_cell = {35, 19};
  const MaxPyramid pyramid(saddles.field);
  std::vector<Hit> hits;
  all_hits_max_mip({&saddles.field, &pyramid}, ray, hits);
  ASSERT_EQ(hits.size(), 20u);
  const LeakJudge judge(saddles, ray);
  for (const Hit& hit : hits) EXPECT_EQ(judge.false_hit(hit), nullptr) << hit.t;
  // The exit before it is not a hit.
  Hit out = hits[10];
  out.t = 10 - 9.93e-13, out.cell = {26, 10}, out.u = out.v = 9.93e-13;
  EXPECT_STREQ(judge.false_hit(out), "a way out of the ground");
}

}  // namespace
}  // namespace scarp::bench
