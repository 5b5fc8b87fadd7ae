// SPDX-License-Identifier: MIT
// max-mip-easy: the shader text as C++ and the listed march, judged by their documented bound.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "march/height/easy_judge.h"
#include "march/height/easy_reordered.h"
#include "march/height/entering_rays.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_easy_ground.h"
#include "scarp/scene/scene_field.h"

namespace scarp::test {
namespace {

using easy::Ground;

const HeightMarchEntry& easy_march() { return find_height_march("max-mip-easy"); }

const int kRaysPerPair = cases(20'000, 2'000, 40);
constexpr int kRaysPerField = 250;
const int kAimedRays = cases(3'000'000, 300'000, 3'000);

std::vector<std::size_t> plain_kinds(const std::vector<FieldKind>& kinds) {
  std::vector<std::size_t> plain;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Random random(i);
    if (kinds[i].has == kPlain && takes(HeightFields::plain, kinds[i].make(random))) plain.push_back(i);
  }
  return plain;
}

// As the text requires.
bool is_within_limits(glm::vec3 origin, glm::vec3 direction) {
  constexpr float kLimit = 1e6f;
  const auto longest = [](glm::vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  return longest(origin) <= kLimit && longest(direction) <= kLimit && longest(direction) >= 1 / kLimit;
}

EasyAnswer answer_of(const Ground::EasyHit& hit) {
  return {hit.hit, hit.below, double{hit.t}, {hit.cell.x, hit.cell.y}, double{hit.place.x}, double{hit.place.y}};
}

// Casts a ray of floats, closest and any hit, and with operations reordered; returns the errors.
std::string cast(const HeightField& field, const MaxPyramid& pyramid, glm::vec3 origin, glm::vec3 direction,
                 float t_max, double* worst = nullptr) {
  Ground ground(field, pyramid);
  const Ground::EasyHit hit = ground.max_mip_easy(origin, direction, t_max, false);
  if (ground.max_mip_easy(origin, direction, t_max, true).hit != hit.hit) return "any-hit contradicts closest-hit";
  const EasyJudge judge(field, {dvec3(origin), dvec3(direction)}, double{t_max});
  std::string objection = judge.objection(answer_of(hit));
  if (objection.empty()) objection = judge.objection(cast_reordered(field, pyramid, origin, direction, t_max));
  if (worst) *worst = std::max(*worst, judge.worst());
  return objection;
}

// Calls check(field, pyramid, ray, words) for rays of all kinds over all fields that the march supports.
template <class Check>
void for_each_ray(const Check& check) {
  for (const bool wide : {false, true}) {
    const auto& fields = wide ? wide_fields() : spiteful_fields();
    const auto& kinds = wide ? rays_across_tiles() : spiteful_rays();
    const int rays = wide ? kRaysPerPair / 20 : kRaysPerPair;
    for (const std::size_t of : plain_kinds(fields)) {
      for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        Random random(1000 * of + kind);
        for (int done = 0; done < rays; done += kRaysPerField) {
          const HeightField field = fields[of].make(random);
          if (!field.has_cells()) continue;
          const MaxPyramid pyramid(field);
          for (int i = 0; i < std::min(rays, kRaysPerField); ++i) {
            const Ray ray = kinds[kind].make(field, random);
            check(field, pyramid, ray, fmt::format("{}, {}: {}", fields[of].name, kinds[kind].name, text(ray)));
            if (testing::Test::HasFatalFailure()) return;
          }
        }
      }
    }
  }
}

TEST(MaxMipEasy, MatchesARayDisplacedByTheBound) {
  double worst = 0;
  int rays = 0;
  for_each_ray([&](const HeightField& field, const MaxPyramid& pyramid, const Ray& ray, const std::string& words) {
    const GridRay local = field.grid_from_world(ray);
    const glm::vec3 origin(local.origin + ray.t_min * local.direction), direction(local.direction);
    if (!is_within_limits(origin, direction)) return;
    ++rays;
    const float t_max = static_cast<float>(std::min(ray.t_max - ray.t_min, 1e9));
    ASSERT_EQ(cast(field, pyramid, origin, direction, t_max, &worst), "") << words;
  });
  EXPECT_GT(rays, kRaysPerPair * 100);
  RecordProperty("worst_share_of_delta", fmt::format("{}", worst));
}

// The listed march also has statuses, walls and rays from the surface, which a shader lacks.
TEST(MaxMipEasy, ListedMarchMatchesARayDisplacedByTheBound) {
  int from_surface = 0;
  for_each_ray([&](const HeightField& field, const MaxPyramid& pyramid, const Ray& ray, const std::string& words) {
    const HeightTarget target{&field, &pyramid};
    const Hit hit = easy_march().cpu(target, ray, {}, nullptr);
    ASSERT_EQ(easy_march().occluded(target, ray, {}), static_cast<bool>(hit)) << words;
    // Measured from the beginning of the range, in lengths of a direction that is 1 to 2.
    GridRay local = field.grid_from_world(ray);
    const dvec3 d = local.direction;
    const int exponent = std::ilogb(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
    for (int axis = 0; axis < 3; ++axis) {
      local.origin[axis] += ray.t_min * d[axis];
      local.direction[axis] = std::ldexp(d[axis], -exponent);
    }
    if (ray.start == RayStart::on_surface) {
      ++from_surface;
      // easy_above().
      const CellHeights h = field.cell_heights(ray.start_cell).value();
      const double u = std::clamp(local.origin.x - ray.start_cell.col, 0.0, 1.0),
                   v = std::clamp(local.origin.y - ray.start_cell.row, 0.0, 1.0);
      const double high = std::max({h.h00, h.h10, h.h01, h.h11}), low = std::min({h.h00, h.h10, h.h01, h.h11});
      const int cells = std::max(field.cell_cols(), field.cell_rows());
      const double lift = 0x1p-18 * (std::max(std::abs(high), std::abs(low)) + (cells + 1) * (high - low));
      local.origin.z = height_in_cell(Surface::bilinear, h, u, v) + std::max(lift, 1e-30);
    }
    const EasyJudge judge(field, local, std::ldexp(ray.t_max - ray.t_min, exponent), ray.start == RayStart::free);
    if (hit.status == HitStatus::below) {
      ASSERT_TRUE(judge.may_begin_below() && ray.start == RayStart::free) << words;
      return;
    }
    if (hit) {
      ASSERT_TRUE(hit.t >= ray.t_min && hit.t <= ray.t_max) << words << text(hit);
    }
    ASSERT_TRUE(!hit.wall || field.settings().solid);
    const double t = std::ldexp(hit.t - ray.t_min, exponent);
    ASSERT_EQ(judge.objection({static_cast<bool>(hit), hit.wall, t, hit.cell, hit.u, hit.v}), "") << words << text(hit);
  });
  EXPECT_GT(from_surface, kRaysPerPair);
}

// Rays through nodes and edges that end below all ground: all of them hit.
TEST(MaxMipEasy, NoRayIsLostBetweenCells) {
  constexpr int kFields = 3;
  Random random(5);
  int lost = 0, wrong = 0;
  for (int i = 0; i < kFields; ++i) {
    const int cols = whole(random, 60, 200), rows = whole(random, 60, 200);
    std::vector<float> samples(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 6));
    const HeightField field = HeightField::own(std::move(samples), cols, rows);
    const MaxPyramid pyramid(field);
    Ground ground(field, pyramid);
    for (int j = 0; j < kAimedRays / kFields; ++j) {
      // Integers: half of the rays hit nodes exactly.
      dvec2 through(whole(random, 1, cols - 2), whole(random, 1, rows - 2));
      if (j % 4 == 1) through.x += uniform(random, -1, 1);
      if (j % 4 == 2) through.y += uniform(random, -1, 1);
      const dvec2 last(whole(random, 1, cols - 2), whole(random, 1, rows - 2));
      if (last == through) continue;
      const double share = j % 8 < 4 ? 1 : uniform(random, 0.1, 2);
      const dvec2 first = through + share * (through - last);
      const double z = field.height(through.x, field.depth() - through.y).value(), down = z + 1;
      const glm::vec3 origin(dvec3(first, z + share * down)), direction(dvec3(last - through, -down));
      const float t_max = static_cast<float>(1 + share);
      const Ground::EasyHit hit = ground.max_mip_easy(origin, direction, t_max, false);
      lost += !hit.hit || !ground.max_mip_easy(origin, direction, t_max, true).hit;
      wrong += !EasyJudge(field, {dvec3(origin), dvec3(direction)}, double{t_max}).objection(answer_of(hit)).empty();
    }
  }
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(wrong, 0);
}

// The border is closed: a ray on the last line that does not move along the axis is over the last cell.
TEST(MaxMipEasy, IncludesTheBorder) {
  const HeightField field = HeightField::own(std::vector<float>(7 * 5, 2.0f), 7, 5);
  const MaxPyramid pyramid(field);
  Ground ground(field, pyramid);
  for (const float col : {0.0f, 3.0f, 6.0f}) {
    for (const float row : {0.0f, 2.0f, 4.0f}) {
      EXPECT_TRUE(ground.max_mip_easy({col, row, 9}, {0, 0, -1}, 1e9f, false).hit) << col << ", " << row;
      EXPECT_TRUE(ground.max_mip_easy({col, row, 9}, {0, 0, -1}, 7.0f, false).hit) << col << ", " << row;
      EXPECT_FALSE(ground.max_mip_easy({col, row, 9}, {0, 0, -1}, 6.5f, false).hit) << col << ", " << row;
      EXPECT_FALSE(ground.max_mip_easy({col, row, 9}, {0, 0, 1}, 1e9f, false).hit) << col << ", " << row;
    }
  }
  EXPECT_TRUE(ground.max_mip_easy({-9, 4, 3}, {1, 0, -0.1f}, 1e9f, false).hit);
  EXPECT_TRUE(ground.max_mip_easy({6, 9, 2.6f}, {0, -1, -0.1f}, 1e9f, false).hit);
  EXPECT_FALSE(ground.max_mip_easy({6.001f, 2, 9}, {0, 0, -1}, 1e9f, false).hit);
  EXPECT_FALSE(ground.max_mip_easy({2, -0.001f, 9}, {0, 0, -1}, 1e9f, false).hit);
}

// Above a plane, no ray along it or up from it is blocked where it starts.
TEST(MaxMipEasy, NeverHitsWhereARayStarts) {
  Random random(6);
  constexpr int kCols = 300, kRows = 200, kPlanes = 10;
  for (int plane = 0; plane < kPlanes; ++plane) {
    const double steep = plane < 2 ? 0 : 3, level = plane == 0 ? 0 : 100;
    const double a = uniform(random, -steep, steep), b = uniform(random, -steep, steep);
    std::vector<float> samples;
    for (int row = 0; row < kRows; ++row) {
      for (int col = 0; col < kCols; ++col) samples.push_back(static_cast<float>(level + a * col + b * row));
    }
    const HeightField field = HeightField::own(std::move(samples), kCols, kRows);
    const MaxPyramid pyramid(field);
    Ground ground(field, pyramid);
    int hits = 0;
    for (int i = 0; i < kAimedRays / 100; ++i) {
      const glm::vec3 from(uniform(random, 0, kCols - 1), uniform(random, 0, kRows - 1), 2000);
      const Ground::EasyHit hit = ground.max_mip_easy(from, {0, 0, -1}, 1e9f, false);
      ASSERT_TRUE(hit.hit);
      const double x = uniform(random, -1, 1), y = uniform(random, -1, 1);
      const double up = i % 2 ? 0 : std::pow(10, uniform(random, -6, 1));
      hits += ground.max_mip_easy(ground.easy_above(hit), dvec3(x, y, a * x + b * y + up), 1e9f, true).hit;
    }
    EXPECT_EQ(hits, 0) << a << ", " << b;
  }
}

TEST(MaxMipEasy, VisitsAsFewBlocksAsMaxMip) {
  const HeightField field = hills(1000, 1500, Surface::bilinear);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  Random random(8);
  std::uint64_t easy_steps = 0, steps = 0;
  for (int i = 0; i < 2000; ++i) {
    MarchStats stats;
    const Ray ray = along_hills(field, random, false);
    const Hit hit = easy_march().cpu(target, ray, {}, &stats);
    if (hit.status == HitStatus::below) continue;
    easy_steps += stats.steps;
    EXPECT_EQ(march_max_mip(target, ray, {}, &stats).status, hit.status) << text(ray);
    steps += stats.steps;
  }
  EXPECT_LT(static_cast<double>(easy_steps), 1.1 * static_cast<double>(steps));
}

TEST(MaxMipEasy, NormalsMatchTheSurface) {
  Random random(7);
  const HeightField field = hills(40, 30, Surface::bilinear);
  const MaxPyramid pyramid(field);
  Ground ground(field, pyramid);
  const HeightFieldSettings& to = field.settings();
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 from(uniform(random, 0, 39), uniform(random, 0, 29), 1000);
    const Ground::EasyHit hit = ground.max_mip_easy(from, {0, 0, -1}, 1e9f, false);
    // Rows go south.
    const dvec3 n = dvec3(ground.easy_normal(hit)) / dvec3(to.cell_x, -to.cell_y, to.scale * to.exaggeration);
    const dvec3 expected = field.normal({hit.cell.x, hit.cell.y}, double{hit.place.x}, double{hit.place.y});
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(n[axis] / length(n), expected[axis], 1e-5);
  }
}

// Rays that enter below the ground stop immediately.
TEST(MaxMipEasy, StopsRaysFromBelow) {
  for (const bool solid : {false, true}) {
    const HeightField field = bowl_field(false, solid);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for (const Ray& ray : entering_rays(field, false, 300)) {
      const Hit hit = easy_march().cpu(target, ray, {}, nullptr), judge = march_exhaustive(target, ray);
      EXPECT_EQ(hit.status, solid ? HitStatus::hit : HitStatus::below);
      EXPECT_EQ(hit.wall, solid);
      if (solid) {
        EXPECT_NEAR(hit.t, judge.t, 1e-6 * judge.t);
      }
    }
    EXPECT_EQ(easy_march().cpu(target, {{2, 20, 10}, {1, 0, 0}}, {}, nullptr).status, HitStatus::below);
  }
}

TEST(MaxMipEasy, RejectsUnsupportedFields) {
  const float hole = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [](float last, const HeightFieldSettings& settings) {
    const HeightField field = HeightField::own<float>({1, 2, 3, 4, 5, last}, 3, 2, settings);
    const MaxPyramid pyramid(field);
    const std::string message = refusal([&] { easy_march().cpu({&field, &pyramid}, {}, {}, nullptr); });
    EXPECT_EQ(refusal([&] { scene_heights(field, easy_march()); }), message);
    return message;
  };
  const std::string takes = "march: max-mip-easy takes only bilinear ground without holes or wrap, and this ground ";
  EXPECT_EQ(refused(6, {}), "");
  EXPECT_EQ(refused(6, {.solid = true}), "");
  EXPECT_EQ(refused(hole, {}), takes + "has holes (use max-mip)");
  EXPECT_EQ(refused(6, {.surface = Surface::triangles}), takes + "consists of triangles (use max-mip)");
  EXPECT_EQ(refused(6, {.wrap = Wrap::periodic}), takes + "wraps (use max-mip)");
}

// The shader text is meant for pasting.
TEST(MaxMipEasy, SourceIsShortAndSelfContained) {
  std::ifstream file(SCARP_SOURCE_DIR "/scarp/march/height/max_mip_easy.glsl.h");
  int lines = 0;
  for (std::string line; std::getline(file, line); ++lines) {
    EXPECT_EQ(line.find("#include"), std::string::npos) << line;
    EXPECT_EQ(line.find("SCARP_"), std::string::npos) << line;
  }
  EXPECT_GT(lines, 100);
  EXPECT_LE(lines, 300);
}

}  // namespace
}  // namespace scarp::test
