// SPDX-License-Identifier: MIT
// The marches on a Vulkan device, on the oracle's fields and rays: their answers are within single precision
// (RoundingJudge), any-hit agrees with closest-hit, and validation is silent.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "march/height/entering_rays.h"
#include "march/height/rounding_judge.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "march/refinement_judge.h"
#include "march/sampling_rules.h"
#include "march/steep_waves.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/batch_states.glsl.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/height/ray_batch.glsl.h"
#include "vk/device_under_test.h"
#include "vk/spirv_layout.h"

namespace scarp::test {
namespace {

// Number of rays of each kind per field, and number of fields of each kind; the judge takes most of the time.
const int kRaysPerKind = cases(200, 50, 25);
constexpr int kFieldsPerKind = 2;

// Compiling a march for lavapipe takes longer than running it, so this happens once for all fields.
DeviceQueries& queries(std::string_view march) {
  static std::map<std::string_view, DeviceQueries> all;
  const auto found = all.find(march);
  if (found != all.end()) return found->second;
  return all
      .emplace(march, DeviceQueries(*device_under_test().device, find_height_march(march), {},
                                    {.statistics = true, .rays_at_once = 3000}))
      .first->second;
}

// Casts rays of all kinds over a field with all marches that run on devices.
void check(const Device& device, const FieldKind& fields, const std::vector<RayKind>& ray_kinds, int rays_per_kind,
           Random& random) {
  const HeightField field = fields.make(random);
  const DeviceGround ground(device, field);
  const DeviceTarget target{&field, &ground, slope_bound(field)};
  std::vector<Ray> rays;
  std::vector<std::string_view> kinds;
  for (const RayKind& kind : ray_kinds) {
    if ((fields.has & kind.aims_at) != kind.aims_at) continue;
    for (int i = 0; i < rays_per_kind; ++i) {
      rays.push_back(kind.make(field, random));
      kinds.push_back(kind.name);
    }
  }
  std::vector<RoundingJudge> judges;
  judges.reserve(rays.size());
  for (const Ray& ray : rays) judges.emplace_back(field, ray);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.gpu) continue;
    queries(march.name).closest_hits(target, rays, hits);
    queries(march.name).occluded(target, rays, blocked);
    int bad = 0;
    for (std::size_t i = 0; i < rays.size() && bad < 3; ++i) {
      std::string objection =
          march.guarantee == Guarantee::exact
              ? judges[i].objection(hits[i])
              : sampling_objection(march.name, {}, field, target.slope, rays[i], judges[i], hits[i]);
      if (blocked[i] != static_cast<bool>(hits[i])) objection += " any-hit contradicts closest-hit";
      if (objection.empty()) continue;
      ++bad;
      ADD_FAILURE() << march.name << ": " << objection << "\n  on " << fields.name << ", ray " << kinds[i] << ": "
                    << text(rays[i]) << "\n  " << text(hits[i]);
    }
  }
}

class ParityOnDevice : public OnDevice, public testing::WithParamInterface<std::size_t> {};

TEST_P(ParityOnDevice, AnswersMatchTheSurface) {
  Random random(GetParam());
  for (int i = 0; i < kFieldsPerKind; ++i) {
    check(device(), spiteful_fields()[GetParam()], spiteful_rays(), kRaysPerKind, random);
  }
}

class ParityAcrossTiles : public OnDevice {};

TEST_F(ParityAcrossTiles, AnswersMatchTheSurface) {
  Random random(1);
  for (const FieldKind& fields : wide_fields()) check(device(), fields, rays_across_tiles(), kRaysPerKind / 2, random);
}

std::vector<std::size_t> all_fields() {
  std::vector<std::size_t> all(spiteful_fields().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

INSTANTIATE_TEST_SUITE_P(Spiteful, ParityOnDevice, testing::ValuesIn(all_fields()),
                         [](const auto& of) { return test_name(std::string(spiteful_fields()[of.param].name)); });

class QueriesOnDevice : public OnDevice {};

TEST_F(QueriesOnDevice, FollowRaysThatEnterBelowGround) {
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.gpu) continue;
    expect_entering_rays_go_on(march,
                               [&](const HeightField& field, const std::vector<Ray>& rays, std::vector<Hit>& hits) {
                                 const DeviceGround ground(device(), field);
                                 queries(march.name).closest_hits({&field, &ground, slope_bound(field)}, rays, hits);
                               });
  }
}

// A shrink factor that the slope does not justify: positions below the ground are hits, not losses.
TEST_F(QueriesOnDevice, HitBelowGroundWithALargeShrinkFactor) {
  const HeightField field = waves();
  const DeviceGround ground(device(), field);
  MarchSettings settings;
  settings.lipschitz.shrink = 0.7;
  const std::vector<Ray> rays = rays_over_waves(500);
  std::vector<Hit> hits(rays.size());
  queries("lipschitz").set_march_settings(settings);
  queries("lipschitz").closest_hits({&field, &ground, slope_bound(field)}, rays, hits);
  queries("lipschitz").set_march_settings({});
  expect_hits_under_the_ground(field, rays, hits);
}

// A ray that does not move along an axis, or hardly, on the rim of a hole: it hits ground on either side of the line.
TEST_F(QueriesOnDevice, HitHoleRimsParallelToTheRay) {
  constexpr int kNodes = 24;
  constexpr double kRelief = 5, kLeastFall = 0.1;
  // Floats position a hit to within 2^-18 of a cell (max_mip_lean.glsl.h); the ground rises by at most the relief per
  // cell.
  constexpr double kFarthestOff = 0x1p-18 * kRelief / kLeastFall;
  Random random(6);
  std::vector<float> samples(kNodes * kNodes);
  for (float& sample : samples) {
    sample = whole(random, 0, 9) == 0 ? std::numeric_limits<float>::quiet_NaN()
                                      : static_cast<float>(uniform(random, 0, kRelief));
  }
  for (const double cell : {1.0, 7.7, 0.71}) {
    const HeightField field = HeightField::own(samples, kNodes, kNodes, {.cell_x = cell, .cell_y = cell});
    const MaxPyramid pyramid(field);
    const DeviceGround ground(device(), field);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) {
      const double lean = whole(random, 0, 1) ? 0 : std::ldexp(whole(random, 0, 1) ? 1 : -1, -whole(random, 40, 60));
      const double line = whole(random, 1, kNodes - 2) * cell, from = uniform(random, 0.1, 0.9) * (kNodes - 1) * cell;
      const double along = whole(random, 0, 3) ? uniform(random, -1, 1) * cell : 0;
      Ray ray{{line, from, uniform(random, 4, 8)}, {lean * cell, along, -uniform(random, kLeastFall, 2)}};
      if (whole(random, 0, 1)) std::swap(ray.origin.x, ray.origin.y), std::swap(ray.direction.x, ray.direction.y);
      rays.push_back(ray);
    }
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    queries("max-mip").closest_hits({&field, &ground}, rays, hits);
    queries("max-mip").occluded({&field, &ground}, rays, blocked);
    int hit_count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit exact = march_max_mip({&field, &pyramid}, rays[i]);
      SCOPED_TRACE(text(rays[i]));
      EXPECT_EQ(hits[i].status, exact.status);
      EXPECT_EQ(blocked[i] != 0, static_cast<bool>(exact));
      if (exact && hits[i]) {
        EXPECT_NEAR(hits[i].t, exact.t, kFarthestOff);
      }
      hit_count += static_cast<bool>(exact);
    }
    EXPECT_GT(hit_count, 1000);
  }
}

TEST_F(QueriesOnDevice, RefineTheirHits) {
  for (const std::string_view march : {"naive", "fixed-step", "relaxed"}) {
    const CastAll cast = [&](const HeightField& field, std::span<const Ray> rays, const MarchSettings& settings) {
      const DeviceGround ground(device(), field);
      std::vector<Hit> hits(rays.size());
      queries(march).set_march_settings(settings);
      queries(march).closest_hits({&field, &ground}, rays, hits);
      queries(march).set_march_settings({});
      return hits;
    };
    const RefinementErrors bisect = refinement_errors(march, Refinement::bisect, cast);
    const RefinementErrors secant = refinement_errors(march, Refinement::secant, cast);
    SCOPED_TRACE(march);
    EXPECT_GT(bisect.hits, 100);
    EXPECT_EQ(bisect.refined, bisect.hits);
    EXPECT_LT(bisect.plain, bisect.hits / 2);
    EXPECT_LT(bisect.along_refined, bisect.along_plain / 100);
    EXPECT_LT(secant.along_refined, secant.along_plain / 2);
  }
}

TEST_F(QueriesOnDevice, AreUnaffectedBySlicing) {
  Random random(3);
  const HeightField field = spiteful_fields()[4].make(random);
  const DeviceGround ground(device(), field);
  std::vector<Ray> rays;
  for (int i = 0; i < 1000; ++i) rays.push_back(spiteful_rays()[1].make(field, random));
  std::vector<Hit> hits(rays.size()), other(rays.size());
  std::vector<DeviceRayCost> costs(rays.size()), none(rays.size());
  DeviceQueries whole(device(), find_height_march("max-mip"), {}, {.statistics = true});
  DeviceQueries sliced(device(), find_height_march("max-mip"), {}, {.rays_at_once = 77});
  whole.closest_hits({&field, &ground}, rays, hits, costs);
  sliced.closest_hits({&field, &ground}, rays, other, none);
  // 13 slices, each with a second pass if any of its rays starts below the ground.
  EXPECT_LE(whole.passes().size(), 2u);
  EXPECT_GE(sliced.passes().size(), 13u);
  EXPECT_LE(sliced.passes().size(), 26u);
  std::uint64_t steps = 0, hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(hits[i].status, other[i].status);
    EXPECT_EQ(hits[i].t, other[i].t);
    EXPECT_GE(costs[i].fetches + 3, costs[i].steps);
    EXPECT_EQ(none[i].steps, 0u);
    steps += costs[i].steps;
    hit_count += static_cast<bool>(hits[i]);
  }
  EXPECT_GT(hit_count, 300u);
  EXPECT_GT(steps, hit_count);
}

// Marches that are interrupted every few turns.
TEST_F(QueriesOnDevice, AreUnaffectedByInterruptions) {
  constexpr int kFewTurns = 5, kFewSteps = 60, kFewRays = 4;
  MarchSettings settings;
  settings.naive.max_steps = settings.fixed_step.max_steps = settings.relaxed.max_steps = kFewSteps;
  settings.lipschitz.max_steps = kFewSteps;
  settings.sampling = {.refinement = Refinement::bisect, .halvings = 7};
  std::map<std::string_view, DeviceQueries> at_once, interrupted;
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.gpu) continue;
    at_once.try_emplace(march.name, device(), march, settings, DeviceQuerySettings{.statistics = true});
    interrupted.try_emplace(march.name, device(), march, settings,
                            DeviceQuerySettings{.statistics = true, .turns_at_once = kFewTurns});
  }
  Random random(5);
  int more_runs = 0;
  const std::size_t every = static_cast<std::size_t>(cases(1, 1, 5));
  for (std::size_t at = 0; at < spiteful_fields().size(); at += every) {
    const FieldKind& fields = spiteful_fields()[at];
    const HeightField field = fields.make(random);
    const DeviceGround ground(device(), field);
    const DeviceTarget target{&field, &ground, slope_bound(field)};
    std::vector<Ray> rays;
    for (const RayKind& kind : spiteful_rays()) {
      if ((fields.has & kind.aims_at) != kind.aims_at) continue;
      for (int i = 0; i < kFewRays; ++i) rays.push_back(kind.make(field, random));
    }
    std::vector<Hit> hits(rays.size()), other(rays.size());
    std::vector<std::uint8_t> blocked(rays.size()), other_blocked(rays.size());
    std::vector<DeviceRayCost> costs(rays.size()), other_costs(rays.size());
    for (auto& [march, whole] : at_once) {
      DeviceQueries& in_pieces = interrupted.at(march);
      whole.closest_hits(target, rays, hits, costs);
      // Two passes where a ray was left to the second pass.
      EXPECT_LE(whole.passes().size(), 2u);
      in_pieces.closest_hits(target, rays, other, other_costs);
      more_runs += in_pieces.passes().size() > 1;
      whole.occluded(target, rays, blocked);
      in_pieces.occluded(target, rays, other_blocked);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(fmt::format("{} on {}: {}", march, fields.name, text(rays[i])));
        ASSERT_EQ(text(other[i]), text(hits[i]));
        ASSERT_EQ(other[i].t, hits[i].t);
        ASSERT_EQ(other_blocked[i], blocked[i]);
        ASSERT_EQ(other_costs[i].steps, costs[i].steps);
        ASSERT_EQ(other_costs[i].fetches, costs[i].fetches);
      }
    }
  }
  EXPECT_GT(more_runs, 5);
}

// Exceeds lavapipe's loop limit: the ray runs just above a slope for 100,000 cells, then hits a wall. One hole, far
// from the ray, makes `lipschitz` climb through all levels at each step.
TEST_F(QueriesOnDevice, FinishLongMarches) {
  constexpr int kCols = 100'001;
  constexpr float kNodata = -1;
  const auto ground_at = [](int col, int row) {
    if (row == 3 && col == 0) return kNodata;
    return col == kCols - 1 ? 3.0F : row < 2 ? 4.0F * static_cast<float>(1 - row) : 0.0F;
  };
  std::vector<float> samples;
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < kCols; ++col) samples.push_back(ground_at(col, row));
  }
  HeightFieldSettings holes;
  holes.nodata = kNodata;
  const HeightField field = HeightField::own(samples, kCols, 4, holes);
  const DeviceGround ground(device(), field);
  const DeviceTarget target{&field, &ground, slope_bound(field)};
  // In the row of cells between heights of 4 and 0, where the ground is at height 1.
  const Ray ray{{10.5, 2.25, 1.5}, {1, 0, 0}};
  // Steps are no shorter than the spacing of floats at 100,000 metres, and hits are reported at a smaller clearance
  // than that.
  constexpr double kLeastStep = 1e-6;  // of the distance: a tenth of a metre
  MarchSettings settings;
  constexpr int kManySteps = 10'000'000;
  settings.naive = {.min_step = kLeastStep, .tolerance = kLeastStep / 10, .max_steps = kManySteps};
  settings.fixed_step.max_steps = kManySteps;
  settings.relaxed = {.tolerance = kLeastStep / 10, .max_steps = kManySteps};
  settings.lipschitz = {.tolerance = kLeastStep / 2, .max_steps = kManySteps};
  constexpr std::uint32_t kLavapipeTurns = 65'535;
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.gpu) continue;
    SCOPED_TRACE(march.name);
    DeviceQueries asked(device(), march, settings, {.statistics = true});
    std::vector<Hit> hits(1);
    std::vector<DeviceRayCost> costs(1);
    std::vector<std::uint8_t> blocked(1);
    asked.closest_hits(target, {&ray, 1}, hits, costs);
    asked.occluded(target, {&ray, 1}, blocked);
    EXPECT_GT(costs[0].steps, kLavapipeTurns);
    ASSERT_EQ(hits[0].status, HitStatus::hit);
    EXPECT_TRUE(blocked[0]);
    EXPECT_EQ(hits[0].cell.col, kCols - 2);
    EXPECT_EQ(hits[0].cell.row, 0);
  }
}

TEST_F(QueriesOnDevice, ReportErrors) {
  const HeightField field = HeightField::own(std::vector<float>(16, 1.0F), 4, 4);
  const DeviceGround ground(device(), field);
  EXPECT_EQ(test::refusal([&] { DeviceQueries(device(), find_height_march("exhaustive")); }),
            "march 'exhaustive': does not run on Vulkan devices (available: max-mip, naive, fixed-step, relaxed, "
            "lipschitz)");
  std::vector<Ray> rays(2);
  std::vector<Hit> hits(1);
  EXPECT_EQ(test::refusal([&] {
              queries("max-mip").closest_hits({&field, &ground}, rays, hits);
            }),
            "batch: 2 rays, room for 1 answers and 0 costs");
  hits.resize(2);
  EXPECT_NE(test::refusal([&] { queries("lipschitz").closest_hits({&field, &ground}, rays, hits); }), "");
  EXPECT_NE(test::refusal([&] { DeviceQueries(device(), find_height_march("max-mip"), {}, {.rays_at_once = 0}); }), "");
  EXPECT_EQ(
      test::refusal([&] { DeviceQueries(device(), find_height_march("max-mip"), {}, {.turns_at_once = 60'001}); }),
      "device queries: 60001 turns at once (must be 1 to 60000)");
  MarchSettings settings;
  settings.naive.max_steps = 0;
  EXPECT_NE(test::refusal([&] { DeviceQueries(device(), find_height_march("naive"), settings); }), "");
}

TEST(Marches, ListedForDevicesRunThere) {
  for (const HeightMarchEntry& march : height_marches()) {
    EXPECT_EQ(march.gpu, device_march_names().find(std::string(march.name)) != std::string::npos) << march.name;
  }
}

constexpr std::uint32_t kShader[] = {
#include "scarp/march/height/max_mip.comp.inc"
};
constexpr std::uint32_t kExactShader[] = {
#include "scarp/march/height/max_mip_exact.comp.inc"
};
constexpr std::uint32_t kSamplingShader[] = {
#include "scarp/march/height/height_marches_second.comp.inc"
};

TEST(BatchLayout, MatchesTheShaders) {
  using glsl::RayBatch;
  EXPECT_TRUE(is_laid_out_like<glsl::RayBlock>(kShader));
  EXPECT_TRUE(is_laid_out_like<glsl::HitBlock>(kShader));
  EXPECT_TRUE(
      has_struct(kShader, {offsetof(RayBatch, ground), offsetof(RayBatch, rays), offsetof(RayBatch, hits),
                           offsetof(RayBatch, count), offsetof(RayBatch, settings), offsetof(RayBatch, turns),
                           offsetof(RayBatch, resume), offsetof(RayBatch, states), offsetof(RayBatch, under_way)}));
  using glsl::BatchMarch, glsl::BatchWalk, glsl::ScarpWalk;
  EXPECT_TRUE(has_struct(kExactShader, {offsetof(BatchWalk, hit), offsetof(BatchWalk, walk), offsetof(BatchWalk, z),
                                        offsetof(BatchWalk, z_low)}));
  EXPECT_TRUE(has_struct(
      kExactShader,
      {offsetof(ScarpWalk, frame), offsetof(ScarpWalk, level), offsetof(ScarpWalk, col), offsetof(ScarpWalk, row),
       offsetof(ScarpWalk, t_in), offsetof(ScarpWalk, side), offsetof(ScarpWalk, through), offsetof(ScarpWalk, begun),
       offsetof(ScarpWalk, start), offsetof(ScarpWalk, relief)}));
  EXPECT_TRUE(is_laid_out_like<BatchWalk>(kExactShader));
  EXPECT_TRUE(is_laid_out_like<BatchMarch>(kSamplingShader));
}

}  // namespace
}  // namespace scarp::test
