// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/rounded_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/march/voxel/voxel_planes.h"

namespace scarp {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
dvec3 point(Random& random, double low, double high) {
  return {uniform(random, low, high), uniform(random, low, high), uniform(random, low, high)};
}

VoxelHit first(const VoxelGrid& grid, const VoxelRay& ray, const VoxelRounding& rounding, const ivec3* from = nullptr) {
  return first_rounded_voxel({&grid, grid.box()}, march_voxel_planes, ray, VoxelDirection(ray.direction), rounding,
                             from, nullptr);
}

// With the largest radius a lone voxel is a ball.
TEST(RoundedVoxels, SingleVoxelIsABall) {
  VoxelGrid grid(ivec3(3));
  grid.set(ivec3(1), 7);
  const dvec3 middle(1.5);
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    VoxelRay ray;
    ray.origin = point(random, -4, 7);
    ray.direction = point(random, 0.9, 2.1) - ray.origin;
    const dvec3 d = normalize(ray.direction);
    const double nearest = length(cross(middle - ray.origin, d)), inside = length(ray.origin - middle);
    // The quantised ray is within 2^-17 of this ray along each axis.
    if (std::abs(nearest - 0.5) < 1e-4 || std::abs(inside - 0.5) < 1e-4) continue;
    const bool ahead = dot(middle - ray.origin, d) > 0;
    const VoxelHit hit = first(grid, ray, {0.5, false});
    ASSERT_EQ(static_cast<bool>(hit), inside < 0.5 || (nearest < 0.5 && ahead)) << i;
    if (!hit || inside < 0.5) continue;
    ++hits;
    const dvec3 p = ray.origin + hit.t * ray.direction;
    EXPECT_NEAR(length(p - middle), 0.5, 1e-12);
    EXPECT_EQ(hit.entry, 7U);
    EXPECT_LT(length(rounded_normal(grid, hit.voxel, hit.face, p, {0.5, false}) - 2.0 * (p - middle)), 1e-11);
  }
  EXPECT_GT(hits, 1000);
}

// The judge: every solid voxel separately, its cube cut out of the ray, and the first point of that part that is close
// enough to the inner box, by bisection; the distance to a box is convex along a line.
struct Judged {
  double t = std::numeric_limits<double>::infinity();
  bool close = false;  // near the boundary between hit and miss
};

bool solid(const VoxelGrid& grid, const ivec3& v) { return grid.box().contains(v) && grid.solid(v); }

// Within one octant of a voxel.
void judge_piece(const VoxelGrid& grid, const VoxelRay& ray, const VoxelRounding& rounding, const ivec3& v,
                 double begin, double end, Judged& judged) {
  const dvec3 inside = ray.origin + 0.5 * (begin + end) * ray.direction - dvec3(v);
  const ivec3 out(inside.x > 0.5 ? 1 : -1, inside.y > 0.5 ? 1 : -1, inside.z > 0.5 ? 1 : -1);
  const ivec3 x(out.x, 0, 0), y(0, out.y, 0), z(0, 0, out.z);
  const bool open_x = !solid(grid, v + x), open_y = !solid(grid, v + y), open_z = !solid(grid, v + z);
  const bool touch_xy = open_x && open_y && solid(grid, v + x + y),
             touch_yz = open_y && open_z && solid(grid, v + y + z),
             touch_zx = open_z && open_x && solid(grid, v + z + x);
  const dvec3 off = rounding.each
                        ? dvec3(rounding.radius)
                        : rounding.radius * dvec3(open_x && !touch_xy && !touch_zx, open_y && !touch_xy && !touch_yz,
                                                  open_z && !touch_yz && !touch_zx);
  dvec3 low(v), high = low + 1.0;
  for (int axis = 0; axis < 3; ++axis) (out[axis] > 0 ? high : low)[axis] -= out[axis] * off[axis];
  const auto outside = [&](double t) {
    const dvec3 p = ray.origin + t * ray.direction;
    return length(p - clamp(p, low, high)) - rounding.radius;
  };
  double a = begin, b = end;
  for (int i = 0; i < 200; ++i) {
    const double c = a + (b - a) / 3, d = b - (b - a) / 3;
    outside(c) < outside(d) ? b = d : a = c;
  }
  const double least = 0.5 * (a + b);
  judged.close = judged.close || std::abs(outside(least)) < 1e-3;
  if (outside(least) > 0) return;
  a = begin, b = least;
  for (int i = 0; i < 100 && outside(begin) > 0; ++i)
    outside(0.5 * (a + b)) > 0 ? a = 0.5 * (a + b) : b = 0.5 * (a + b);
  judged.t = std::min(judged.t, outside(begin) > 0 ? b : begin);
}

Judged judge(const VoxelGrid& grid, const VoxelRay& ray, const VoxelRounding& rounding) {
  Judged judged;
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    if (!grid.solid(v)) return;
    double begin = ray.t_min, end = ray.t_max;
    dvec3 low(v), high = low + 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - ray.origin[axis]) / ray.direction[axis];
      const double b = (high[axis] - ray.origin[axis]) / ray.direction[axis];
      begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    }
    judged.close = judged.close || std::abs(end - begin) < 1e-3;
    if (begin >= end) return;
    // Also cut at the middle planes: each octant has its own box.
    std::vector<double> cuts{begin, end};
    for (int axis = 0; axis < 3; ++axis) {
      const double t = (v[axis] + 0.5 - ray.origin[axis]) / ray.direction[axis];
      if (t > begin && t < end) cuts.push_back(t);
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) judge_piece(grid, ray, rounding, v, cuts[i], cuts[i + 1], judged);
  });
  return judged;
}

TEST(RoundedVoxels, MatchPerVoxelTests) {
  Random random(2);
  int hits = 0, misses = 0, close = 0;
  for (int round = 0; round < 60; ++round) {
    VoxelGrid grid(ivec3(5), 8);
    const double share = uniform(random, 0.05, 0.7);
    grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
      return uniform(random, 0, 1) < share ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
    });
    const VoxelRounding rounding{uniform(random, 0.05, 0.5), round % 3 == 0};
    for (int i = 0; i < 60; ++i) {
      VoxelRay ray;
      ray.origin = point(random, -3, 8);
      ray.direction = normalize(point(random, 0, 5) - ray.origin);
      const Judged expected = judge(grid, ray, rounding);
      if (expected.close) {
        ++close;
        continue;
      }
      const VoxelHit hit = first(grid, ray, rounding);
      ASSERT_EQ(static_cast<bool>(hit), std::isfinite(expected.t)) << round << ' ' << i;
      (hit ? hits : misses) += 1;
      if (!hit) continue;
      // On a face t is that of the quantised ray, off by 2^-17 voxel along the face's axis.
      const dvec3 normal = rounded_normal(grid, hit.voxel, hit.face, ray.origin + hit.t * ray.direction, rounding);
      const double along = normal == dvec3(0.0) ? 1 : std::abs(dot(normal, ray.direction));
      EXPECT_NEAR(hit.t, expected.t, 0x1p-17 / along) << round << ' ' << i;
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 300);
  EXPECT_LT(close, 1200);
}

TEST(RoundedVoxels, WallsStayFlat) {
  VoxelGrid grid(ivec3(4, 4, 1));
  grid.fill(grid.box(), 1);
  VoxelRay ray;
  ray.origin = {2, 1.75, 5};  // over the line between two voxels
  ray.direction = {0, 0, -1};
  const VoxelHit flat = first(grid, ray, {0.25, false});
  EXPECT_EQ(flat.t, 4);
  EXPECT_EQ(rounded_normal(grid, flat.voxel, flat.face, {2, 1.75, 1}, {0.25, false}), dvec3(0, 0, 1));
  // With separate voxels there would be a groove as deep as the radius.
  EXPECT_EQ(first(grid, ray, {0.25, true}).t, 4.25);
  // And no groove where four meet.
  ray.origin.y = 2;
  EXPECT_EQ(first(grid, ray, {0.25, false}).t, 4);
  EXPECT_FALSE(first(grid, ray, {0.25, true}));
}

// A wall of voxels that touch at edges stops the same rays as it would with plain cubes.
TEST(RoundedVoxels, EdgeContactsStayClosed) {
  VoxelGrid grid(ivec3(8));
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return v.x == v.z ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  Random random(3);
  int passed = 0;
  for (int i = 0; i < 2000; ++i) {
    VoxelRay ray;
    const dvec3 at = uniform(random, 1, 7) * dvec3(1, 0, 1) + dvec3(0, uniform(random, 1, 7), 0);
    ray.origin = at + dvec3(uniform(random, -12, -2), uniform(random, -1, 1), uniform(random, 2, 12));
    ray.direction = at - ray.origin;
    EXPECT_TRUE(first(grid, ray, {0.5, false})) << i;
    passed += first(grid, ray, {0.5, true}) ? 0 : 1;
  }
  EXPECT_GT(passed, 100);
}

TEST(RoundedVoxels, RaysDoNotHitTheVoxelTheyLeave) {
  VoxelGrid grid(ivec3(2, 1, 1));
  grid.set({0, 0, 0}, 1);
  VoxelRay ray;
  // Starts at the ball's upper right, where a cube would extend further; going up, the ray hits nothing.
  ray.origin = dvec3(0.5) + 0.5 * normalize(dvec3(1, 0, 1));
  ray.direction = {1, 0, 0.25};
  const ivec3 from(0);
  EXPECT_FALSE(first(grid, ray, {0.5, false}, &from));
  grid.set({1, 0, 0}, 2);
  // Now the neighbour exists, and its side of the seam is flat.
  ray.origin = {0.75, 0.5, 1};
  ray.direction = {1, 0, -0.01};
  const VoxelHit hit = first(grid, ray, {0.25, true}, &from);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.voxel, ivec3(1, 0, 0));
}

TEST(RoundedVoxels, RejectsInvalidRadii) {
  EXPECT_THROW(validate(VoxelRounding{0.51, false}), Error);
  EXPECT_THROW(validate(VoxelRounding{-0.1, false}), Error);
  EXPECT_THROW(validate(VoxelRounding{std::nan(""), false}), Error);
}

}  // namespace
}  // namespace scarp
