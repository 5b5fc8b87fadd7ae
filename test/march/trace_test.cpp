// SPDX-License-Identifier: MIT
// Recorded marches: the answer of the query bit for bit, as many steps as it counts, and steps that an independent
// computation confirms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cases.h"
#include "field/terrain_functions.h"
#include "march/height/spiteful.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/march_trace.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::test {
namespace {

template <class Keeps>
std::uint32_t count(const MarchTrace& trace, const Keeps& keeps) {
  return static_cast<std::uint32_t>(
      std::count_if(trace.steps.begin(), trace.steps.end(), [&](const TraceStep& step) { return keeps(step.kind); }));
}

bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.status == b.status && bits(a.t, b.t) && bits(a.u, b.u) && bits(a.v, b.v) && a.cell == b.cell &&
         a.wall == b.wall && (!a || bits(a.height, b.height));
}

// The highest sample of a block, in metres.
double highest_in(const HeightField& field, const TraceStep& step) {
  double highest = -HUGE_VAL;
  const int side = 1 << step.level;
  for (int row = step.row * side; row < std::min((step.row + 1) * side, field.cell_rows()); ++row) {
    for (int col = step.col * side; col < std::min((step.col + 1) * side, field.cell_cols()); ++col) {
      if (const auto h = field.cell_heights({col, row}))
        highest = std::max({highest, field.height_from_sample(std::max({h->h00, h->h10, h->h01, h->h11})),
                            field.height_from_sample(std::min({h->h00, h->h10, h->h01, h->h11}))});
    }
  }
  return highest;
}

// Fewer roundings lie between a ray and a height below it, in metres: four of its position, six to the place in a cell,
// eight of the interpolation, six to metres. March and test each have their own.
constexpr double kRoundings = 2 * 24 * 0x1p-53;

// Clearances against HeightField::height(), and blocks against their samples.
void check_ground(const HeightField& field, const Ray& ray, const MarchTrace& trace, const std::string& what) {
  const double steepest = slope_bound(field);
  const double tallest = std::max(std::abs(field.min_height()), std::abs(field.max_height()));
  for (const TraceStep& step : trace.steps) {
    const dvec3 p = ray.at(step.t);
    if (step.kind == TraceKind::sample || step.kind == TraceKind::refinement) {
      const auto ground = field.height(p.x, p.y);
      // By rounding the point may be beside the field or a hole.
      if (!ground) continue;
      const auto reach = [&](int axis) { return std::abs(ray.origin[axis]) + std::abs(step.t * ray.direction[axis]); };
      const double scale = reach(2) + tallest + steepest * (reach(0) + reach(1));
      EXPECT_NEAR(step.clearance, p.z - *ground, kRoundings * scale) << what;
      EXPECT_LE(step.free, std::abs(step.clearance) * (1 + kRoundings)) << what;
    } else if (is_block(step.kind)) {
      EXPECT_GE(step.maximum, highest_in(field, step)) << what;
    }
    if (ray.start == RayStart::free) {
      EXPECT_LE(step.t, step.t_out) << what;
      continue;
    }
    // A start on the surface may be beside its cell by a rounding: then it is late by three roundings of its place in
    // the grid, over the direction across the line.
    double times = 0;
    for (const int axis : {0, 1}) {
      const double along = std::abs(ray.direction[axis]), extent = axis == 0 ? field.width() : field.depth();
      if (along > 0) times = std::max(times, (std::abs(ray.origin[axis]) + extent) / along);
    }
    EXPECT_LE(step.t, step.t_out + 3 * 0x1p-53 * times) << what;
  }
}

TEST(Trace, HeightMarchesAnswerAsWithoutIt) {
  const int rays_per_pair = cases(200, 40, 10);
  std::uint64_t samples = 0, blocks = 0, cells = 0;
  for (const FieldKind& kind : spiteful_fields()) {
    for (const RayKind& rays : spiteful_rays()) {
      Random random(7);
      const HeightField field = kind.make(random);
      if (!field.has_cells() || field.all_nodata()) continue;
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid, slope_bound(field)};
      for (int i = 0; i < rays_per_pair && !testing::Test::HasFailure(); ++i) {
        const Ray ray = rays.make(field, random);
        for (const HeightMarchEntry& march : height_marches()) {
          if (!march.traced) continue;
          MarchSettings settings;
          if (i % 2 == 1) settings.sampling.refinement = Refinement::bisect;
          const std::string what = fmt::format("{} over {}, {}, ray {}", march.name, kind.name, rays.name, i);
          MarchStats plain, counted;
          MarchTrace trace;
          const Hit expected = march.cpu(target, ray, settings, &plain);
          const Hit hit = march.traced(target, ray, settings, &counted, trace);
          EXPECT_TRUE(same(hit, expected)) << what;
          const std::uint32_t tested = count(trace, [](TraceKind k) { return k == TraceKind::tested_cell; });
          if (march.sampling != Sampling::none) {
            EXPECT_EQ(trace.steps.size(), plain.steps) << what;
            samples += plain.steps;
          } else if (!trace.steps.empty()) {
            const bool from_surface = ray.start == RayStart::on_surface;
            EXPECT_EQ(tested, counted.cell_tests) << what;
            EXPECT_EQ(trace.steps.size(), counted.steps + (from_surface ? 1 : 0)) << what;
            blocks += count(trace, is_block), cells += count(trace, is_cell);
          }
          check_ground(field, ray, trace, what);
        }
      }
    }
  }
  EXPECT_GT(samples, 1000u);
  EXPECT_GT(blocks, 100u);
  EXPECT_GT(cells, 100u);
}

TEST(Trace, BallsOfLipschitzAreFreeOfGround) {
  Random random(3);
  const HeightField field = rugged(random, 24, 3, 0, {});
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  // Heights are below 32 m; a rounding of their position changes them by the slope.
  const double rounding = kRoundings * 32 * (1 + target.slope);
  int balls = 0;
  for (int i = 0; i < 50; ++i) {
    const Ray ray{{uniform(random, 0, field.width()), uniform(random, 0, field.depth()), 8},
                  {uniform(random, -1, 1), uniform(random, -1, 1), -0.4}};
    MarchTrace trace;
    find_height_march("lipschitz").traced(target, ray, {}, nullptr, trace);
    for (const TraceStep& step : trace.steps) {
      const dvec3 centre = ray.at(step.t);
      if (step.kind != TraceKind::sample || step.clearance <= 0) continue;
      ++balls;
      for (int k = 0; k < 50; ++k) {
        const double x = centre.x + uniform(random, -1, 1) * step.free,
                     y = centre.y + uniform(random, -1, 1) * step.free;
        const auto ground = field.height(x, y);
        if (ground) {
          EXPECT_GE(length(dvec3(x, y, *ground) - centre), step.free - rounding);
        }
      }
    }
  }
  EXPECT_GT(balls, 100);
}

TEST(Trace, TimesOfLongDirectionsAreThoseOfTheRay) {
  const HeightField field = HeightField::own(std::vector<float>(101 * 101, 0.f), 101, 101);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  const Ray ray{{10, 50, 30}, {0.8, 0, -0.6}};
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.traced) continue;
    Ray far = ray;
    far.direction = far.direction * 0x1p600;
    MarchTrace usual, scaled;
    march.traced(target, ray, {}, nullptr, usual);
    const Hit hit = march.traced(target, far, {}, nullptr, scaled);
    EXPECT_TRUE(hit) << march.name;
    ASSERT_EQ(usual.steps.size(), scaled.steps.size()) << march.name;
    for (std::size_t i = 0; i < usual.steps.size(); ++i) {
      EXPECT_EQ(std::ldexp(scaled.steps[i].t, 600), usual.steps[i].t) << march.name;
    }
  }
}

TEST(Trace, FunctionMarchesAnswerAsWithoutIt) {
  Random random(5);
  for (const NamedFunction& named : terrain_functions()) {
    const std::string& name = named.name;
    const HeightFunction function(named.function);
    for (int i = 0; i < cases(200, 40, 10); ++i) {
      const Ray ray{{uniform(random, -500, 500), uniform(random, -500, 500), uniform(random, 0, 500)},
                    {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.5, 0.1)}};
      for (const FunctionMarchEntry& march : function_marches()) {
        if (!march.traced) continue;
        MarchStats plain, counted;
        MarchTrace trace;
        const Hit expected = march.cpu(function, ray, {}, &plain, FunctionUse::march);
        EXPECT_TRUE(same(march.traced(function, ray, {}, &counted, trace), expected)) << march.name << " " << name;
        EXPECT_EQ(trace.steps.size(), plain.steps) << march.name << " " << name;
        EXPECT_EQ(counted.steps, plain.steps);
        for (const TraceStep& step : trace.steps) {
          const dvec3 p = ray.at(step.t);
          const double ground = function.value(p.x, p.y, FunctionUse::march);
          EXPECT_EQ(step.clearance, p.z - ground) << march.name << " " << name;
        }
      }
    }
  }
}

// Checks that each step skips empty voxels only, and that the next one starts where it ends.
void check_voxels(const VoxelGrid& grid, const MarchTrace& trace, const std::string& what) {
  const auto empty = [&](const ivec3& voxel) { return !grid.box().contains(voxel) || !grid.solid(voxel); };
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const TraceStep& step = trace.steps[i];
    EXPECT_LE(step.t, step.t_out) << what;
    if (i + 1 < trace.steps.size()) {
      EXPECT_EQ(step.t_out, trace.steps[i + 1].t) << what;
    }
    EXPECT_EQ(empty(step.voxel), step.kind != TraceKind::solid) << what;
    if (step.kind == TraceKind::sphere && step.size > 0) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const int sign : {-1, 1}) {
          ivec3 end = step.voxel;
          end[axis] += sign * step.size;
          EXPECT_TRUE(empty(end)) << what;
        }
      }
    }
  }
}

TEST(Trace, VoxelMarchesAnswerAsWithoutIt) {
  std::uint64_t cubes = 0, spheres = 0, solids = 0;
  for (const VoxelGridKind& kind : spiteful_voxel_grids()) {
    for (const VoxelRayKind& rays : spiteful_voxel_rays()) {
      Random random(9);
      const VoxelGrid grid = kind.make(random);
      const EmptySpheres nearest(grid);
      const EmptyCubes radii(grid);
      const OctantCubes octants(grid);
      const BrickMasks bricks(grid);
      const VoxelTarget target{&grid, grid.bounds(), &nearest, &radii, &octants, &bricks};
      if (target.box.empty()) continue;
      for (int i = 0; i < cases(100, 20, 5) && !testing::Test::HasFailure(); ++i) {
        const VoxelRay ray = rays.make(grid, random);
        const auto quantised =
            quantise(ray, VoxelDirection(ray.direction, VoxelTies(random_orientation(random))), target.box);
        if (!quantised) continue;
        for (const VoxelMarchEntry& march : voxel_marches()) {
          if (!march.traced) continue;
          const std::string what = fmt::format("{} through {}, {}", march.name, kind.name, rays.name);
          MarchStats plain, counted;
          MarchTrace trace;
          const VoxelHit expected = march.cpu(target, *quantised, &plain);
          const VoxelHit hit = march.traced(target, *quantised, &counted, trace);
          EXPECT_TRUE(hit == expected) << what;
          const std::uint32_t solid = count(trace, [](TraceKind k) { return k == TraceKind::solid; });
          EXPECT_EQ(trace.steps.size(), plain.steps + solid) << what;
          EXPECT_EQ(counted.steps, plain.steps) << what;
          if (hit) {
            EXPECT_EQ(trace.steps.back().voxel, hit.voxel) << what;
            EXPECT_EQ(trace.steps.back().t, hit.t) << what;
          }
          check_voxels(grid, trace, what);
          cubes += count(trace, [](TraceKind k) { return k == TraceKind::cube; });
          spheres += count(trace, [](TraceKind k) { return k == TraceKind::sphere; });
          solids += solid;
        }
      }
    }
  }
  EXPECT_GT(cubes, 100u);
  EXPECT_GT(spheres, 100u);
  EXPECT_GT(solids, 100u);
}

}  // namespace
}  // namespace scarp::test
