// SPDX-License-Identifier: MIT
// Marches over terrain functions against proofs by interval arithmetic: conservative marches lose no hits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cases.h"
#include "field/terrain_functions.h"
#include "march/function/function_rays.h"
#include "march/steep_waves.h"
#include "scarp/base/error.h"
#include "scarp/march/function/function_exhaustive.h"
#include "scarp/march/function/function_sampling.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/function/lipschitz_local.h"
#include "scarp/march/function/lipschitz_local_simd.h"
#include "scarp/march/function/presets.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/sampling/shrink_factor.h"

namespace scarp::test {
namespace {

const int kRays = cases(10'000, 2000, 60);

// The last interval of lipschitz-local: any of several crossings in it may be reported.
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

TEST(FunctionMarches, ConservativeMarchesLoseNoHits) {
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
    // The judge nearly always decides, and lipschitz-local agrees with it: the march is not only conservative, but
    // correct.
    EXPECT_LE(undecided, 1 + kRays / 500) << named.name;
    EXPECT_GE(crossings, kRays / 4) << named.name;
    EXPECT_LE(local.exhausted, kRays / 500) << named.name;
    EXPECT_EQ(local.early + local.inexact, 0) << named.name;
    if (HasFailure()) return;  // one function is enough
  }
}

// A ridge where two planes meet. Bounds know a crease to first order only: segments as long as the tolerance do not
// distinguish it from a ray that passes a thousandth of them above.
TEST(FunctionMarches, PassCloseToCreases) {
  const Function planes = make_function(Minimum{make_function(Plane{0, 0.1, 0}), make_function(Plane{0, -0.4, 0})});
  const HeightFunction ridge(planes);
  for (const double above : {1e-2, 1e-4, 1e-6, -1e-6, -1e-4}) {
    const Ray ray{{-1000, 3, above}, {1, 0, 0}, 0, 2345};
    const Hit hit = march_lipschitz_local(ridge, ray);
    EXPECT_EQ(hit.status, above > 0 ? HitStatus::miss : HitStatus::hit) << above;
    if (above < 0) {
      EXPECT_NEAR(hit.t, 1000 + 10 * above, kTolerance * 1000);
    }
  }
}

TEST(FunctionMarches, RaysFromTheSurfaceLoseNoHits) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    FunctionRandom random(12);
    int leaving = 0, exhausted = 0;
    for (int i = 0; i < kRays / 10; ++i) {
      const double x = random.between(-5000, 5000), y = random.between(-5000, 5000);
      Ray ray;
      ray.origin = {x, y, function.value(x, y)};
      const double azimuth = random.between(0, 6.28318);
      ray.direction = {std::cos(azimuth), std::sin(azimuth), random.between(-0.2, 0.8)};
      ray.t_max = 5000;
      ray.start = RayStart::on_surface;
      const Hit hit = march_lipschitz_local(function, ray);
      // A millimetre further, the ray is either free, and judged from there, or it has entered the ground.
      Ray later = ray;
      later.start = RayStart::free;
      later.t_min = 1e-3;
      const dvec3 p = later.at(later.t_min);
      const double clearance = p.z - function.value(p.x, p.y);
      // Rounding of heights, of the ray's own height, and of its start, which is also rounded.
      const FunctionBound near = function.bound({x - 1, x + 1, y - 1, y + 1});
      const double rounding =
          near.rounding + 0x1p-49 * (std::abs(p.z) + (1 + near.slope) * (std::abs(x) + std::abs(y) + 1));
      if (clearance < -rounding) {
        EXPECT_TRUE(hit && hit.t <= later.t_min) << named.name;
      } else if (clearance > rounding) {
        ++leaving;
        const FunctionJudgement judge = judge_function(named.function, later);
        if (judge.verdict == FunctionVerdict::crossing) {
          // A ray nearly along a crease takes many short segments: it may be given up, but not lost.
          exhausted += hit.status == HitStatus::exhausted;
          EXPECT_NE(hit.status, HitStatus::miss) << named.name << ": lost the crossing at t = " << judge.crossed_by;
          EXPECT_NE(hit.status, HitStatus::below) << named.name;
          if (hit) {
            EXPECT_LE(hit.t, judge.crossed_by + kTolerance * hit.t) << named.name;
          }
        }
        if (judge.verdict == FunctionVerdict::clear) {
          EXPECT_FALSE(hit) << named.name << " at t = " << hit.t;
        }
      }
    }
    EXPECT_GE(leaving, kRays / 40) << named.name;
    EXPECT_LE(exhausted, kRays / 2000) << named.name;
  }
}

const HeightFunction& bowl() {
  static const HeightFunction function(make_function(Sines{{{10, 100, 0, 0}}}));
  return function;
}

TEST(FunctionMarches, AcceptAnyDirection) {
  const HeightFunction plane(make_function(Plane{5}));
  // Upright, level, and with a direction of any length.
  const Hit down = march_lipschitz_local(plane, {{1, 2, 9}, {0, 0, -4}});
  ASSERT_TRUE(down);
  EXPECT_NEAR(down.t, 1, kTolerance);
  EXPECT_EQ(march_lipschitz_local(plane, {{1, 2, 9}, {0, 0, 1}}).status, HitStatus::miss);
  EXPECT_EQ(march_lipschitz_local(plane, {{1, 2, 9}, {1, 0, 0}}).status, HitStatus::miss);
  EXPECT_EQ(march_lipschitz_local(plane, {{1, 2, 4}, {0, 0, 1}}).status, HitStatus::below);
  EXPECT_EQ(march_lipschitz_local(bowl(), {{25, 2, 9}, {0, 0, 1}}).status, HitStatus::below);
  // Level, between the crests: sin(2 pi x / 100) = 0.5 at x = 25 / 3.
  const Hit level = march_lipschitz_local(bowl(), {{-25, 3, 5}, {0.5, 0, 0}});
  ASSERT_TRUE(level);
  EXPECT_NEAR(level.t, 2 * (25 + 25.0 / 3), 1e-4);
  for (const FunctionMarchEntry& march : function_marches()) {
    MarchStats stats;
    const Hit hit = march.cpu(bowl(), {{-25, 3, 5}, {0.5, 0, 0}, 0, 200}, {}, &stats, FunctionUse::march);
    ASSERT_TRUE(hit) << march.name;
    EXPECT_NEAR(hit.t, 2 * (25 + 25.0 / 3), 1);
    EXPECT_GT(stats.steps, 5u);
  }
}

TEST(FunctionMarches, RespectTheRayRange) {
  Ray ray{{-25, 3, 5}, {1, 0, 0}};
  ray.t_max = 33;
  EXPECT_EQ(march_lipschitz_local(bowl(), ray).status, HitStatus::miss);
  ray.t_max = 34;
  EXPECT_TRUE(march_lipschitz_local(bowl(), ray));
  ray.t_min = 50;  // inside the crest
  ray.t_max = 60;
  EXPECT_EQ(march_lipschitz_local(bowl(), ray).status, HitStatus::below);
}

TEST(FunctionMarches, StopAtTheirReach) {
  const Ray ray{{-25, 3, 5}, {2, 0, 0}};  // hits the ground after 33.3 m
  for (const FunctionMarchEntry& march : function_marches()) {
    MarchSettings settings;
    settings.function.reach = 30;
    EXPECT_EQ(march.cpu(bowl(), ray, settings, nullptr, FunctionUse::march).status, HitStatus::miss);
    settings.function.reach = 40;
    EXPECT_TRUE(march.cpu(bowl(), ray, settings, nullptr, FunctionUse::march)) << march.name;
  }
}

TEST(FunctionMarches, ReportExhaustionSeparatelyFromHits) {
  const Ray ray{{-25, 3, 5}, {1, 0, 0}, 0, 200};
  MarchSettings settings;
  settings.naive.max_steps = settings.fixed_step.max_steps = settings.relaxed.max_steps = 2;
  settings.lipschitz.max_steps = settings.lipschitz_local.max_steps = 2;
  for (const FunctionMarchEntry& march : function_marches()) {
    EXPECT_EQ(march.cpu(bowl(), ray, settings, nullptr, FunctionUse::march).status, HitStatus::exhausted) << march.name;
  }
}

TEST(FunctionMarches, AreFoundByName) {
  std::vector<std::string_view> names;
  for (const FunctionMarchEntry& march : function_marches()) {
    names.push_back(march.name);
    EXPECT_EQ(&find_function_march(march.name), &march);
  }
  EXPECT_EQ(names, (std::vector<std::string_view>{"naive", "fixed-step", "relaxed", "lipschitz", "lipschitz-local"}));
  EXPECT_THROW(find_function_march("max-mip"), Error);
  EXPECT_THROW(find_height_march("lipschitz-local"), Error);
}

TEST(FunctionMarches, ValidateTheirSettings) {
  const auto bad = [](auto change) {
    MarchSettings settings;
    validate(settings);
    change(settings);
    EXPECT_THROW(validate(settings), Error);
  };
  bad([](MarchSettings& s) { s.lipschitz_local.tolerance = -1; });
  bad([](MarchSettings& s) { s.lipschitz_local.max_steps = 0; });
  bad([](MarchSettings& s) { s.function.step = 0; });
  bad([](MarchSettings& s) { s.function.reach = 0; });
  bad([](MarchSettings& s) { s.function.step_share = -1; });
  bad([](MarchSettings& s) { s.sampling.tolerance = NAN; });
  bad([](MarchSettings& s) { s.sampling.halvings = 0; });
  bad([](MarchSettings& s) { s.relaxed.tolerance = 0; });
  EXPECT_EQ(find_refinement("secant"), Refinement::secant);
  EXPECT_THROW(find_refinement("newton"), Error);
}

// The effect of the settings over a ramp: a ray along x at height 2 is 102 - t above it.
TEST(FunctionMarches, PresetsSetTheDocumentedValues) {
  const HeightFunction ramp(make_function(Plane{0, 1, 0}));
  const Ray ray{{-100, 0, 2}, {1, 0, 0}, 0, 200};
  const auto steps = [&](std::string_view name, double& t) {
    const MarchPreset& preset = find_march_preset(name);
    validate(preset.settings);
    MarchStats stats;
    const Hit hit = find_function_march(preset.march).cpu(ramp, ray, preset.settings, &stats, FunctionUse::march);
    EXPECT_TRUE(hit) << name;
    t = hit.t;
    return stats.steps;
  };
  // After n steps of fraction s the clearance is 102 (1 - s)^n, and t is 102 minus that.
  const auto expected = [](double share, double tolerance) {
    std::uint32_t n = 0;
    for (double h = 102; !(h < tolerance * (102 - h)); h *= 1 - share) ++n;
    return n + 1;
  };
  double t = 0;
  EXPECT_EQ(steps("elevated", t), expected(0.4, 0.0015));
  EXPECT_EQ(steps("rainforest", t), expected(0.8, 0.001));
  EXPECT_LT(t, 102);
  EXPECT_EQ(steps("iq2002", t), 12u);  // 0, 10, ..., 110
  EXPECT_NEAR(t, 102, 1e-12);
  EXPECT_EQ(steps("castle", t), 2u);
  EXPECT_EQ(t, 102);
  // Without the minimum step, 2^-40 of the distance, it would approach the ramp for ever: it ends below the ramp by no
  // more than that.
  EXPECT_LE(steps("snowy", t), 64u);
  EXPECT_TRUE(t > 102 && t <= 102 + 200 * 0x1p-40);
  EXPECT_THROW(find_march_preset("comanche"), Error);
}

// castle ends within a millimetre of the ground at any distance, and a ray to the sun starts there.
TEST(FunctionMarches, RaysFromTheSurfaceEscapeWithEveryPreset) {
  const HeightFunction hills(make_function(Fractal{.wavelength = 200, .height = 20, .octaves = {3, 3, 3}}));
  for (const MarchPreset& preset : march_presets()) {
    const FunctionMarchEntry& march = find_function_march(preset.march);
    int met = 0;
    for (int i = 0; i < 100; ++i) {
      const Ray down{{17.0 * i, 5.0 * i, 100}, {0.3, 0.1, -1}, 0, 400};
      const Hit hit = march.cpu(hills, down, preset.settings, nullptr, FunctionUse::march);
      if (!hit || down.at(hit.t).z < hills.value(down.at(hit.t).x, down.at(hit.t).y)) continue;
      ++met;
      const Ray to_sun{.origin = down.at(hit.t), .direction = {0.1, 0, 1}, .t_max = 300, .start = RayStart::on_surface};
      EXPECT_FALSE(march.cpu(hills, to_sun, preset.settings, nullptr, FunctionUse::shadow)) << preset.name;
    }
    // Those without a tolerance end below the ground.
    if (preset.name == "castle") {
      EXPECT_GT(met, 20);
    }
  }
}

// A ramp, on which every march's last interval is known.
TEST(FunctionMarches, FixedStepCountsItsSamples) {
  const HeightFunction ramp(make_function(Plane{0, 1, 0}));
  const Ray ray{{-100, 0, 2}, {2, 0, 0}, 0, 60};  // over x = 2 at t = 51
  MarchSettings settings;
  settings.function.step = 3;  // t = 0, 1.5, ..., 51 exactly: the 35th
  MarchStats stats;
  Hit hit = march_fixed_step(ramp, ray, settings, &stats);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, 51);
  EXPECT_EQ(stats.steps, 35u);
  settings.function.step = 4;  // 50, 52
  EXPECT_NEAR(march_fixed_step(ramp, ray, settings).t, 51, 1e-12);
  settings.fixed_step.interpolate = false;
  EXPECT_EQ(march_fixed_step(ramp, ray, settings).t, 52);
  settings.sampling.refinement = Refinement::bisect;
  settings.sampling.halvings = 10;
  EXPECT_EQ(march_fixed_step(ramp, ray, settings).t, 51);  // a dyadic fraction of the step
  settings.sampling.refinement = Refinement::none;
  settings.function.step_share = 0.5;  // 0, 2, 4, 6, 9, 13.5, 20.25, 30.375, 45.5625, 60 (68.3, the end)
  hit = march_fixed_step(ramp, ray, settings, &stats);
  EXPECT_EQ(hit.t, 60);
  EXPECT_EQ(stats.steps, 10u);
  // A ray that starts below the ramp is reported as below; a ray that rises above it and enters again is not.
  EXPECT_EQ(march_fixed_step(ramp, {{10, 0, 2}, {1, 0, 0}, 0, 60}, settings).status, HitStatus::below);
  EXPECT_EQ(march_fixed_step(bowl(), {{10, 0, 5}, {1, 0, 0}, 0, 60}, {}).status, HitStatus::below);
  EXPECT_TRUE(march_fixed_step(bowl(), {{10, 0, 5}, {1, 0, 0}, 0, 160}, {}));
}

TEST(FunctionMarches, RefineTheLastInterval) {
  const HeightFunction ramp(make_function(Plane{0, 1, 0}));
  const Ray ray{{-100, 0, 2}, {1, 0, 0}, 0, 200};  // clearance 102 - t, which is 0.01 t at 102 / 1.01
  MarchSettings settings;
  settings.relaxed.tolerance = settings.naive.tolerance = 0.01;
  for (const std::string_view name : {"naive", "relaxed"}) {
    const FunctionMarch march = find_function_march(name).cpu;
    settings.sampling.refinement = Refinement::none;
    const Hit plain = march(ramp, ray, settings, nullptr, FunctionUse::march);
    settings.sampling.refinement = Refinement::bisect;
    const Hit halved = march(ramp, ray, settings, nullptr, FunctionUse::march);
    settings.sampling.refinement = Refinement::secant;
    const Hit secant = march(ramp, ray, settings, nullptr, FunctionUse::march);
    EXPECT_GT(plain.t - halved.t, 0.01);
    // 24 halvings of an interval shorter than 2; the secant reaches the limit of the last sample, 0.01 of its t.
    EXPECT_NEAR(halved.t, 102 / 1.01, 2 * 0x1p-24);
    EXPECT_NEAR(secant.t, 102 - 0.01 * plain.t, 1e-12);
  }
  // Clearance in metres that counts as a hit at any distance.
  settings.sampling = {.refinement = Refinement::bisect, .tolerance = 3};
  settings.relaxed.tolerance = 0;
  EXPECT_NEAR(march_relaxed(ramp, ray, settings).t, 99, 4 * 0x1p-24);
}

TEST(FunctionMarches, LipschitzHitsBelowGroundWithALargeShrinkFactor) {
  const HeightFunction function(endless_waves());
  const double proven = largest_proven_shrink(function.bound_everywhere().slope);
  MarchSettings too_large, smaller;
  too_large.lipschitz.shrink = 0.7;
  smaller.lipschitz.shrink = 0.5 * proven;
  ASSERT_LT(proven, 0.5);
  int late = 0, under = 0;
  for (const Ray& ray : rays_over_waves(500)) {
    const Hit hit = march_lipschitz(function, ray, too_large), judge = march_lipschitz_local(function, ray);
    ASSERT_TRUE(hit);
    const dvec3 p = ray.at(hit.t);
    late += hit.t > judge.t + 0.1;
    under += p.z < function.value(p.x, p.y) - 0.1;
    EXPECT_LE(march_lipschitz(function, ray, smaller).t, judge.t);
  }
  EXPECT_GT(late, 25);
  EXPECT_GT(under, 10);
}

// From beyond the domain of functions, below the ground there: it enters the ground later.
TEST(FunctionMarches, FollowRaysThatEnterBelowGround) {
  const HeightFunction function(make_function(Sines{{{10, 100, 0.5 * std::numbers::pi, 0}}}));
  const Ray ray{{-kFunctionReach - 10, 25, 5}, {1, 1, 0}, 0, 200};
  for (const FunctionMarchEntry& march : function_marches()) {
    const Hit hit = march.cpu(function, ray, {}, nullptr, FunctionUse::march);
    if (march.name == "lipschitz-local") {
      EXPECT_EQ(hit.status, HitStatus::below) << "as documented";
    } else {
      EXPECT_NEAR(hit.t, 100 + 100.0 / 12 - 25, 1) << march.name;
    }
  }
}

TEST(FunctionMarches, SimdIsBitIdentical) {
  std::vector<NamedFunction> functions = terrain_functions();
  functions.push_back({"both at once", make_function(Maximum{functions[2].function, functions[9].function}), false});
  for (const NamedFunction& named : functions) {
    const HeightFunction function(named.function);
    FunctionRandom random(14);
    std::vector<Ray> rays;
    for (int i = 0; i < 150; ++i) {
      Ray ray = random_ray(function, random);
      if (i % 3 == 0) {
        ray.origin.z = function.value(ray.origin.x, ray.origin.y);
        ray.start = RayStart::on_surface;
      }
      if (i % 7 == 0) ray.origin.z -= 3000;
      if (i % 11 == 0) ray.direction = {0, 0, -1};
      if (i % 13 == 0) ray.origin.x += 1e7;
      rays.push_back(ray);
    }
    MarchSettings settings;
    settings.lipschitz_local.max_steps = 60;
    for (const std::size_t count : {rays.size(), std::size_t{1}, std::size_t{0}}) {
      std::vector<Hit> hits(count);
      std::vector<std::uint32_t> steps(count);
      closest_hits_lipschitz_local_simd(function, std::span(rays).first(count), hits, settings, steps,
                                        FunctionUse::shadow);
      for (std::size_t i = 0; i < count; ++i) {
        MarchStats stats;
        const Hit hit = march_lipschitz_local(function, rays[i], settings, &stats, FunctionUse::shadow);
        ASSERT_EQ(hits[i].status, hit.status) << named.name << ", ray " << i;
        ASSERT_EQ(hits[i].t, hit.t) << named.name << ", ray " << i;
        ASSERT_EQ(hits[i].height, hit.height);
        ASSERT_EQ(steps[i], stats.steps + stats.cell_tests) << named.name << ", ray " << i;
      }
    }
  }
}

TEST(FunctionMarches, LocalBoundsNeedFewerEvaluations) {
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
