// SPDX-License-Identifier: MIT
// naive, fixed-step and relaxed: they follow their documentation, including their known errors.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "march/refinement_judge.h"
#include "scarp/base/error.h"
#include "scarp/march/height/height_sampling.h"
#include "scarp/march/height/height_table.h"

namespace scarp {
namespace {

HeightField flat() { return HeightField::own(std::vector<float>(101 * 101, 0.f), 101, 101); }

// One wall of a single column on flat ground.
HeightField wall() {
  std::vector<float> samples(101 * 101, 0.f);
  for (std::size_t row = 0; row < 101; ++row) samples[101 * row + 60] = 50;
  return HeightField::own(samples, 101, 101);
}

TEST(Naive, StopsWithinItsToleranceAboveAPlane) {
  const HeightField field = flat();
  MarchSettings settings;
  const Ray ray{{10, 50, 30}, {0.8, 0, -0.6}};
  MarchStats stats;
  const Hit hit = march_naive({&field, nullptr}, ray, settings, &stats);
  ASSERT_TRUE(hit);
  EXPECT_LT(hit.height, settings.naive.tolerance * hit.t);
  EXPECT_NEAR(hit.height, 30 - 0.6 * hit.t, 1e-12);
  EXPECT_NEAR(hit.t, 50, settings.naive.tolerance * 50 / 0.6 + settings.naive.min_step * 112.5);
  EXPECT_GT(stats.steps, 3u);
}

TEST(Naive, FindsAThinWallOnlyWithShortSteps) {
  const HeightField field = wall();
  const Ray ray{{0, 50.5, 20}, {1, 0, 0}};
  MarchSettings settings;
  settings.naive.min_step = 0.1;
  EXPECT_FALSE(march_naive({&field, nullptr}, ray, settings));
  settings.naive.step_factor = settings.naive.min_step = 1e-3;
  EXPECT_TRUE(march_naive({&field, nullptr}, ray, settings));
}

TEST(Naive, ReportsExhaustionAtTheStepLimit) {
  const HeightField field = flat();
  MarchSettings settings;
  settings.naive.max_steps = 3;
  settings.naive.step_factor = 1e-6;
  const Hit hit = march_naive({&field, nullptr}, {{0, 50, 20}, {1, 0, 0}}, settings);
  EXPECT_EQ(hit.status, HitStatus::exhausted);
  EXPECT_TRUE(std::isfinite(hit.t));
}

TEST(FixedStep, HitsAtASampleOrBetweenTwo) {
  const HeightField field = flat();
  const Ray ray{{10, 50, 30}, {0.8, 0, -0.6}};
  MarchSettings settings;
  settings.fixed_step.step = 0.7;
  MarchStats stats;
  const Hit between = march_fixed_step({&field, nullptr}, ray, settings, &stats);
  ASSERT_TRUE(between);
  EXPECT_NEAR(between.t, 50, 1e-12);
  EXPECT_EQ(stats.steps, 73u);  // samples at 0, 0.7, ..., 50.4
  settings.fixed_step.interpolate = false;
  const Hit sample = march_fixed_step({&field, nullptr}, ray, settings);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample.t, 50.4, 1e-12);
}

TEST(FixedStep, FindsAThinWallOnlyWithShortSteps) {
  const HeightField field = wall();
  const Ray ray{{0, 50.5, 20}, {1, 0, 0}};
  MarchSettings settings;
  settings.fixed_step.step = 8;
  EXPECT_FALSE(march_fixed_step({&field, nullptr}, ray, settings));
  settings.fixed_step.step = 0.5;
  const Hit hit = march_fixed_step({&field, nullptr}, ray, settings);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, 59.4, 1e-9);  // the wall rises by 50 from 59 to 60
}

TEST(FixedStep, SamplesTheEndOfTheRayRange) {
  const HeightField field = flat();
  Ray ray{{10, 50, 30}, {0.8, 0, -0.6}};
  MarchSettings settings;
  settings.fixed_step.step = 40;
  ray.t_max = 50;
  EXPECT_TRUE(march_fixed_step({&field, nullptr}, ray, settings));
  ray.t_max = 49.9;
  EXPECT_EQ(march_fixed_step({&field, nullptr}, ray, settings).status, HitStatus::miss);
}

TEST(FixedStep, ReportsBelowWallsAndExhaustion) {
  const HeightField field = flat();
  EXPECT_EQ(march_fixed_step({&field, nullptr}, {{10, 50, -1}, {1, 0, 0}}, {}).status, HitStatus::below);
  MarchSettings settings;
  settings.fixed_step.max_steps = 3;
  EXPECT_EQ(march_fixed_step({&field, nullptr}, {{10, 50, 9}, {1, 0, 0}}, settings).status, HitStatus::exhausted);
  HeightFieldSettings solid;
  solid.solid = true;
  const HeightField rock = HeightField::own(std::vector<float>(101 * 101, 0.f), 101, 101, solid);
  const Hit hit = march_fixed_step({&rock, nullptr}, {{-10, 50, -1}, {1, 0, 0}}, {});
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit.wall);
  EXPECT_EQ(hit.t, 10);
}

TEST(Relaxed, ApproachesAPlane) {
  const HeightField field = flat();
  const Hit hit = march_relaxed({&field, nullptr}, {{10, 50, 30}, {0.8, 0, -0.6}});
  ASSERT_TRUE(hit);
  EXPECT_LT(std::abs(hit.height), 0.0015 * hit.t);
  EXPECT_NEAR(hit.t, 50, 0.0015 * 50 / 0.6);
}

TEST(Relaxed, FollowsItsRecurrence) {
  // Over a plane h shrinks by 1 - 0.4 * 0.6 per step: the number of steps is known.
  const HeightField field = flat();
  MarchStats stats;
  march_relaxed({&field, nullptr}, {{10, 50, 30}, {0.8, 0, -0.6}}, {}, &stats);
  double t = 0;
  std::uint32_t steps = 1;
  for (; std::abs(30 - 0.6 * t) >= 0.0015 * t; ++steps) t += 0.4 * (30 - 0.6 * t);
  EXPECT_EQ(stats.steps, steps);
}

TEST(Relaxed, ReportsExhaustionRatherThanAHit) {
  // A level ray at a height from which 300 steps of 0.4 h do not reach the border.
  const HeightField field = flat();
  EXPECT_EQ(march_relaxed({&field, nullptr}, {{0, 50, 0.5}, {1, 0, 0}}).status, HitStatus::exhausted);
}

TEST(Relaxed, ReportsBelowWhenStartingBelow) {
  const HeightField field = flat();
  EXPECT_EQ(march_relaxed({&field, nullptr}, {{50, 50, -5}, {1, 0, 0}}).status, HitStatus::below);
}

TEST(SamplingMarches, RefineTheirHits) {
  for (const std::string_view march : {"naive", "fixed-step", "relaxed"}) {
    const test::CastAll cast = [&](const HeightField& field, std::span<const Ray> rays, const MarchSettings& settings) {
      std::vector<Hit> hits;
      for (const Ray& ray : rays)
        hits.push_back(find_height_march(march).cpu({&field, nullptr}, ray, settings, nullptr));
      return hits;
    };
    const test::RefinementErrors bisect = test::refinement_errors(march, Refinement::bisect, cast);
    const test::RefinementErrors secant = test::refinement_errors(march, Refinement::secant, cast);
    SCOPED_TRACE(march);
    EXPECT_GT(bisect.hits, 100);
    EXPECT_EQ(bisect.refined, bisect.hits);
    EXPECT_LT(bisect.plain, bisect.hits / 2);
    EXPECT_LT(bisect.along_refined, bisect.along_plain / 100);
    EXPECT_LT(secant.along_refined, secant.along_plain / 2);
  }
}

// Over a hole there is no clearance to refine from, and a secant that ends over one leaves the hit where it was.
TEST(SamplingMarches, DoNotRefineAcrossHoles) {
  constexpr float kNodata = -99;
  std::vector<float> samples(101 * 101, 0.f);
  for (std::size_t row = 0; row < 101; ++row) samples[101 * row + 50] = kNodata;
  HeightFieldSettings holes;
  holes.nodata = kNodata;
  const HeightField field = HeightField::own(samples, 101, 101, holes);
  const Ray ray{{45, 50, 5}, {1, 0, -1}};  // over the hole, x = 49 to 51, it goes under the ground
  MarchSettings settings;
  settings.fixed_step.step = 7 * std::sqrt(2.0);
  settings.fixed_step.interpolate = false;
  for (const Refinement refinement : {Refinement::none, Refinement::secant}) {
    settings.sampling.refinement = refinement;
    const Hit hit = march_fixed_step({&field, nullptr}, ray, settings);
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit.t, 7);
  }
  settings.sampling.refinement = Refinement::bisect;
  const Hit behind = march_fixed_step({&field, nullptr}, ray, settings);
  ASSERT_TRUE(behind);
  EXPECT_NEAR(behind.t, 6, 1e-5);
  settings.naive.step_factor = 1e-9;
  settings.naive.min_step = 0.1;  // of 55: t = 0, 5.5, 11
  EXPECT_EQ(march_naive({&field, nullptr}, ray, settings).status, HitStatus::miss) << "out of the hole, under ground";
}

TEST(SamplingMarches, AcceptTolerancesInMetresAtAnyDistance) {
  const HeightField field = flat();
  MarchSettings settings;
  settings.naive.tolerance = settings.relaxed.tolerance = 0;
  settings.sampling = {.refinement = Refinement::bisect, .tolerance = 3};
  for (const std::string_view march : {"naive", "relaxed"}) {
    const Hit hit = find_height_march(march).cpu({&field, nullptr}, {{10, 50, 30}, {0.8, 0, -0.6}}, settings, nullptr);
    ASSERT_TRUE(hit) << march;
    EXPECT_NEAR(hit.t, 45, 1e-4) << march;
  }
}

TEST(SamplingMarches, DoNotDependOnTheLengthOfTheDirection) {
  const HeightField field = wall();
  for (const HeightMarch march : std::array<HeightMarch, 2>{march_naive, march_relaxed}) {
    const Hit one = march({&field, nullptr}, {{0, 20, 40}, {1, 0.3, -0.5}}, {}, nullptr);
    const Hit four = march({&field, nullptr}, {{0, 20, 40}, {4, 1.2, -2}}, {}, nullptr);
    ASSERT_EQ(one.status, four.status);
    EXPECT_DOUBLE_EQ(one.t, 4 * four.t);
  }
}

TEST(MarchTable, NamesAreUniqueAndTheOracleIsFirst) {
  EXPECT_EQ(height_marches().front().name, "exhaustive");
  for (const HeightMarchEntry& entry : height_marches()) EXPECT_EQ(&find_height_march(entry.name), &entry);
  try {
    find_height_march("max mip");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'max mip'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("relaxed"), std::string::npos);
  }
}

TEST(MarchSettings, AreValidatedIndividually) {
  EXPECT_NO_THROW(validate({}));
  const auto refused = [](auto&& change) {
    MarchSettings settings;
    change(settings);
    try {
      validate(settings);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused([](MarchSettings& s) { s.naive.min_step = 0; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.naive.step_factor = std::nan(""); }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.naive.tolerance = -1; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.naive.max_steps = 0; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.fixed_step.step = 0; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.fixed_step.max_steps = 0; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.relaxed.tolerance = 0; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.relaxed.max_steps = -3; }));
  EXPECT_TRUE(refused([](MarchSettings& s) { s.bisect.halvings = 61; }));
}

}  // namespace
}  // namespace scarp
