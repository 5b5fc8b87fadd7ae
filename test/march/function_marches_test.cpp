// SPDX-License-Identifier: MIT
// Marches over terrain functions against proofs by interval arithmetic: the conservative ones lose nothing.
#include "scarp/march/function_marches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/terrain_functions.h"
#include "scarp/base/error.h"
#include "scarp/march/function_exhaustive.h"
#include "scarp/march/lipschitz_local.h"

namespace scarp::test {
namespace {

#ifdef NDEBUG
constexpr int kRays = 10'000;
#else
constexpr int kRays = 60;
#endif

// Eyes near the ground and high above it; rays along the ground, up, steeply down, and of any length.
Ray random_ray(const HeightFunction& function, FunctionRandom& random) {
  const double x = random.between(-5000, 5000), y = random.between(-5000, 5000);
  const double azimuth = random.between(0, 6.28318), kind = random.between(0, 4);
  const double above = kind < 1 ? random.between(0.01, 2) : random.between(5, 300);
  const double rise = kind < 2 ? random.between(-0.05, 0.05) : random.between(-1, 0.2);
  const double scale = std::exp2(random.between(-3, 3));
  Ray ray;
  ray.origin = {x, y, function.value(x, y) + above};
  ray.direction = dvec3(std::cos(azimuth), std::sin(azimuth), rise) * scale;
  ray.t_max = 10000 / scale;
  return ray;
}

// The last interval of lipschitz-local: of several crossings in it any may be told.
constexpr double kTolerance = LipschitzLocalSettings{}.tolerance;

struct Counts {
  int hits = 0, misses = 0, exhausted = 0, early = 0, inexact = 0;
};

void expect_nothing_lost(const NamedFunction& named, const FunctionJudgement& judge, const Ray& ray, const Hit& hit,
                         double tolerance, Counts& counts) {
  counts.hits += hit.status == HitStatus::hit;
  counts.misses += hit.status == HitStatus::miss;
  counts.exhausted += hit.status == HitStatus::exhausted;
  EXPECT_NE(hit.status, HitStatus::below) << named.name;
  if (judge.verdict == FunctionVerdict::crossing) {
    EXPECT_NE(hit.status, HitStatus::miss) << named.name << ": lost the crossing at t = " << judge.crossed_by;
    if (hit) {
      EXPECT_LE(hit.t, judge.crossed_by + tolerance * (hit.t - ray.t_min)) << named.name;
      counts.inexact += judge.clear_until - hit.t > 2 * kTolerance * (hit.t - ray.t_min);
    }
  } else if (judge.verdict == FunctionVerdict::clear) {
    counts.early += bool(hit);
  }
}

TEST(FunctionMarches, ConservativeOnesLoseNothing) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    FunctionRandom random(11);
    Counts global, local;
    int crossings = 0, undecided = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = random_ray(function, random);
      const FunctionJudgement judge = judge_function(named.function, ray);
      crossings += judge.verdict == FunctionVerdict::crossing;
      undecided += judge.verdict == FunctionVerdict::undecided;
      expect_nothing_lost(named, judge, ray, march_lipschitz(function, ray), 0, global);
      expect_nothing_lost(named, judge, ray, march_lipschitz_local(function, ray), kTolerance, local);
    }
    // The judge decides nearly always, and lipschitz-local agrees with it: not only conservative, but right.
    EXPECT_LE(undecided, 1 + kRays / 500) << named.name;
    EXPECT_GE(crossings, kRays / 4) << named.name;
    EXPECT_LE(local.exhausted, kRays / 500) << named.name;
    EXPECT_LE(local.early + local.inexact, 1 + kRays / 500) << named.name;
    if (HasFailure()) return;  // one function says enough
  }
}

TEST(FunctionMarches, RaysFromTheSurfaceLoseNothing) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    FunctionRandom random(12);
    int leaving = 0;
    for (int i = 0; i < kRays / 10; ++i) {
      const double x = random.between(-5000, 5000), y = random.between(-5000, 5000);
      Ray ray;
      ray.origin = {x, y, function.value(x, y)};
      const double azimuth = random.between(0, 6.28318);
      ray.direction = {std::cos(azimuth), std::sin(azimuth), random.between(-0.2, 0.8)};
      ray.t_max = 5000;
      ray.start = RayStart::on_surface;
      const Hit hit = march_lipschitz_local(function, ray);
      // A millimetre on, the ray is either free, and judged from there, or it has gone into the ground.
      Ray later = ray;
      later.start = RayStart::free;
      later.t_min = 1e-3;
      const dvec3 p = later.at(later.t_min);
      const double clearance = p.z - function.value(p.x, p.y);
      if (clearance < -1e-9) {
        EXPECT_TRUE(hit && hit.t <= later.t_min) << named.name;
      } else if (clearance > 1e-9) {
        ++leaving;
        const FunctionJudgement judge = judge_function(named.function, later);
        if (judge.verdict == FunctionVerdict::crossing) {
          EXPECT_TRUE(hit && hit.t <= judge.crossed_by + kTolerance * hit.t) << named.name;
        }
        if (judge.verdict == FunctionVerdict::clear) {
          EXPECT_FALSE(hit) << named.name << " at t = " << hit.t;
        }
      }
    }
    EXPECT_GE(leaving, kRays / 40) << named.name;
  }
}

const HeightFunction& bowl() {
  static const HeightFunction function(make_function(Sines{{{10, 100, 0, 0}}}));
  return function;
}

TEST(FunctionMarches, FollowRaysOfAnyDirection) {
  const HeightFunction plane(make_function(Plane{5}));
  // Upright, level, and with a direction of any length.
  const Hit down = march_lipschitz_local(plane, {{1, 2, 9}, {0, 0, -4}});
  ASSERT_TRUE(down);
  EXPECT_NEAR(down.t, 1, 1e-6);
  EXPECT_EQ(march_lipschitz_local(plane, {{1, 2, 9}, {0, 0, 1}}).status, HitStatus::miss);
  EXPECT_EQ(march_lipschitz_local(plane, {{1, 2, 9}, {1, 0, 0}}).status, HitStatus::miss);
  EXPECT_EQ(march_lipschitz_local(plane, {{1, 2, 4}, {0, 0, 1}}).status, HitStatus::below);
  EXPECT_EQ(march_lipschitz_local(bowl(), {{25, 2, 9}, {0, 0, 1}}).status, HitStatus::below);
  // Level, between the crests: sin(2 pi x / 100) = 0.5 at x = 25 / 3.
  const Hit level = march_lipschitz_local(bowl(), {{-25, 3, 5}, {0.5, 0, 0}});
  ASSERT_TRUE(level);
  EXPECT_NEAR(level.t, 2 * (25 + 25.0 / 3), 1e-4);
  for (const auto march : {march_naive, march_relaxed, march_lipschitz}) {
    MarchStats stats;
    const Hit hit = march(bowl(), {{-25, 3, 5}, {0.5, 0, 0}, 0, 200}, {}, &stats, FunctionUse::march);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit.t, 2 * (25 + 25.0 / 3), 1);
    EXPECT_GT(stats.steps, 5u);
  }
}

TEST(FunctionMarches, RespectTheRange) {
  Ray ray{{-25, 3, 5}, {1, 0, 0}};
  ray.t_max = 33;
  EXPECT_EQ(march_lipschitz_local(bowl(), ray).status, HitStatus::miss);
  ray.t_max = 34;
  EXPECT_TRUE(march_lipschitz_local(bowl(), ray));
  ray.t_min = 50;  // inside the crest
  ray.t_max = 60;
  EXPECT_EQ(march_lipschitz_local(bowl(), ray).status, HitStatus::below);
}

TEST(FunctionMarches, TellUsedUpStepsFromHits) {
  const Ray ray{{-25, 3, 5}, {1, 0, 0}, 0, 200};
  EXPECT_EQ(march_lipschitz_local(bowl(), ray, {.max_steps = 2}).status, HitStatus::exhausted);
  MarchSettings settings;
  settings.naive.max_steps = settings.relaxed.max_steps = settings.lipschitz.max_steps = 2;
  for (const auto march : {march_naive, march_relaxed, march_lipschitz}) {
    EXPECT_EQ(march(bowl(), ray, settings, nullptr, FunctionUse::march).status, HitStatus::exhausted);
  }
  EXPECT_THROW(validate(LipschitzLocalSettings{.tolerance = -1}), Error);
  EXPECT_THROW(validate(LipschitzLocalSettings{.max_steps = 0}), Error);
}

TEST(FunctionMarches, LocalBoundsTakeFewerEvaluations) {
  const HeightFunction function(make_function(Fractal{}));
  FunctionRandom random(13);
  double global = 0, local = 0;
  for (int i = 0; i < 400; ++i) {
    const Ray ray = random_ray(function, random);
    MarchSettings settings;
    settings.lipschitz.max_steps = 100'000;
    MarchStats stats;
    march_lipschitz(function, ray, settings, &stats);
    global += stats.steps;
    march_lipschitz_local(function, ray, {}, &stats);
    local += stats.steps + stats.cell_tests;
  }
  EXPECT_GE(global, 2 * local);
}

}  // namespace
}  // namespace scarp::test
