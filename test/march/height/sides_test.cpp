// SPDX-License-Identifier: MIT
// Rules on which hits count: those from below are those of the same ground upside down, and a filter removes hits and
// nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/rounding.h"

namespace scarp::test {
namespace {

constexpr std::int16_t kNoSample = -32768;

// The same ground, its heights times `sign`. With holes the samples are integers: then the codes of both pyramids bound
// the same heights.
HeightField turned(const HeightField& field, int sign) {
  HeightFieldSettings settings = field.settings();
  settings.offset *= sign;
  if (sign < 0) settings.solid = false;
  settings.nodata = {};
  std::vector<float> samples;
  std::vector<std::int16_t> whole;
  const double middle = 0.5 * (field.min_sample() + field.max_sample());
  const double unit = std::max((field.max_sample() - middle) / 1000, 1e-30);
  field.visit([&](const auto& grid) {
    for (int row = 0; row < grid.rows; ++row) {
      for (int col = 0; col < grid.cols; ++col) {
        const auto sample = grid.at(col, row);
        const bool hole = grid.is_nodata(sample);
        samples.push_back(static_cast<float>(sign * static_cast<double>(sample)));
        whole.push_back(
            hole ? kNoSample
                 : static_cast<std::int16_t>(sign * std::lround((static_cast<double>(sample) - middle) / unit)));
      }
    }
  });
  if (field.nodata_count() == 0) return HeightField::own(std::move(samples), field.cols(), field.rows(), settings);
  settings.offset += sign * middle * settings.scale;
  settings.scale *= unit;
  settings.nodata = kNoSample;
  return HeightField::own(std::move(whole), field.cols(), field.rows(), settings);
}

Ray upside_down(Ray ray) {
  ray.origin.z = -ray.origin.z, ray.direction.z = -ray.direction.z;
  return ray;
}

Hit upside_down(Hit hit) {
  hit.height = -hit.height;
  if (hit.status == HitStatus::below) hit.status = HitStatus::miss;
  return hit;
}

// Whether, among the rays within rounding of this ray, some hit and some do not.
bool grazes(const HeightTarget& target, const Ray& ray, double t) {
  const HeightField& field = *target.field;
  const GridRay local = field.grid_from_world(ray);
  const HeightFieldSettings& settings = field.settings();
  const dvec3 step = 2.0 * dvec3(settings.cell_x * rounding_of_line(field, local, 0, 0),
                                 settings.cell_y * rounding_of_line(field, local, 1, 0),
                                 settings.scale * settings.exaggeration * rounding_of_clearance(field, local, t));
  int hits = 0;
  for (int i = 0; i < 27; ++i) {
    Ray beside = ray;
    beside.origin += step * dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    hits += occluded_max_mip(target, beside);
  }
  return hits > 0 && hits < 27;
}

// Calls new_field(target), then check(target, ray), for every kind of field and of ray.
template <class NewField, class Check>
void for_all(const NewField& new_field, const Check& check) {
  Random random(5);
  for (const FieldKind& kind : spiteful_fields()) {
    for (int i = 0; i < cases(20, 3, 1); ++i) {
      const HeightField field = kind.make(random);
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid};
      new_field(target);
      for (const RayKind& rays : spiteful_rays()) {
        if ((rays.aims_at & kind.has) != rays.aims_at) continue;
        for (int j = 0; j < cases(400, 100, 20); ++j) {
          check(target, rays.make(field, random));
          if (testing::Test::HasFatalFailure()) FAIL() << kind.name << ", " << rays.name;
        }
      }
    }
  }
}

TEST(Sides, BelowMatchesAboveOfTheInvertedField) {
  int hits = 0;
  std::optional<HeightField> field, other_field;
  std::optional<MaxPyramid> pyramid, other_pyramid;
  std::vector<Hit> own, other;
  const auto turn = [&](const HeightTarget& target) {
    field = turned(*target.field, 1), other_field = turned(*target.field, -1);
    pyramid.emplace(*field), other_pyramid.emplace(*other_field);
  };
  for_all(turn, [&](const HeightTarget&, const Ray& ray) {
    const HeightTarget target{&*field, &*pyramid}, upside{&*other_field, &*other_pyramid};
    const Hit hit = march_max_mip_by_rules(target, ray, HitRules{.sides = Sides::below});
    const Hit expected = upside_down(march_max_mip(upside, upside_down(ray)));
    if (hit != expected) {
      // At the rims of holes, pyramid levels decide which line through a node gives the time of the hit, and whether a
      // graze within rounding is a touch.
      ASSERT_GT(field->nodata_count(), 0);
      const GridRay local = field->grid_from_world(ray);
      if (hit && expected) {
        ASSERT_LE(std::abs(hit.t - expected.t), 2 * rounding_of_node_time(*field, local, 0));
      } else {
        ASSERT_TRUE(grazes(upside, upside_down(ray), hit ? hit.t : expected.t));
      }
    }
    all_hits_from_below_exhaustive(target, ray, own);
    all_hits_exhaustive(upside, upside_down(ray), other);
    ASSERT_EQ(own.size(), other.size());
    for (std::size_t i = 0; i < own.size(); ++i) ASSERT_EQ(own[i], upside_down(other[i]));
    hits += hit.status == HitStatus::hit;
  });
  EXPECT_GT(hits, cases(100'000, 5000, 500));
}

TEST(Sides, BothReturnsTheEarlierHit) {
  int from_below = 0, from_above = 0;
  for_all([](const HeightTarget&) {},
          [&](const HeightTarget& target, const Ray& ray) {
            if (ray.start == RayStart::on_surface) return;
            const Hit above = march_max_mip(target, ray),
                      below = march_max_mip_by_rules(target, ray, HitRules{Sides::below});
            const Hit both = march_max_mip_by_rules(target, ray, HitRules{Sides::both});
            ASSERT_EQ(both, below && !(above && above.t <= below.t) ? below : above);
            (both == above ? from_above : from_below) += both.status == HitStatus::hit;
          });
  EXPECT_GT(from_below, 0);
  EXPECT_GT(from_above, 0);
}

// The hits of a ray are alternately from above and from below.
TEST(Sides, BothAlternatesBetweenSides) {
  Random random(8);
  const HeightField field = test::hills(65, 65, Surface::bilinear);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  int passed = 0;
  for (int i = 0; i < cases(20'000, 2000, 500); ++i) {
    Ray ray = along_hills(field, random, false);
    ray.direction.z *= 0.2;
    std::vector<Hit> above, below;
    all_hits_max_mip(target, ray, above);
    all_hits_from_below_exhaustive(target, ray, below);
    std::vector<double> expected;
    for (const Hit& hit : above) expected.push_back(hit.t);
    for (const Hit& hit : below) expected.push_back(hit.t);
    std::sort(expected.begin(), expected.end());
    // By rounding, grazes are crossings or touches.
    const double near = 1e-9;
    bool grazes = false;
    for (std::size_t j = 1; j < expected.size(); ++j) grazes = grazes || expected[j] - expected[j - 1] < near;
    if (grazes) continue;
    std::vector<double> found;
    for (;;) {
      const Hit hit = march_max_mip_by_rules(target, ray, HitRules{Sides::both});
      if (!hit) break;
      found.push_back(hit.t);
      ASSERT_LE(found.size(), expected.size());
      ray.t_min = hit.t, ray.start = RayStart::on_surface, ray.start_cell = hit.cell;
    }
    ASSERT_EQ(found.size(), expected.size()) << i;
    for (std::size_t j = 0; j < found.size(); ++j) ASSERT_NEAR(found[j], expected[j], near);
    passed += static_cast<int>(found.size());
  }
  EXPECT_GT(passed, cases(5000, 500, 100));
}

TEST(HitFilters, RemoveOnlyRejectedHits) {
  int accepted = 0, none = 0;
  std::vector<Hit> all;
  for_all([](const HeightTarget&) {},
          [&](const HeightTarget& target, const Ray& ray) {
            all_hits_max_mip(target, ray, all);
            // Hits in cells selected by a hash; the first of the remaining ones counts.
            const auto counts = [](const Hit& hit) { return (hit.cell.col * 7 + hit.cell.row * 13) % 3 == 0; };
            const HitFilter accept = counts;
            const Hit hit = march_max_mip_by_rules(target, ray, HitRules{.accept = &accept});
            const auto first = std::find_if(all.begin(), all.end(), counts);
            if (hit) {
              ASSERT_TRUE(counts(hit));
              ++accepted;
            } else {
              none += !all.empty();
            }
            if (first == all.end() ? !hit : hit == *first) return;
            // Where a ray touches several cells at once, the filter is called for each.
            const GridRay local = target.field->grid_from_world(ray);
            const double node = rounding_of_node_time(*target.field, local, 0);
            const bool beside = std::any_of(all.begin(), all.end(),
                                            [&](const Hit& one) { return hit.t - one.t <= node && one.t <= hit.t; });
            ASSERT_TRUE(hit && beside);
          });
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(none, 1000);
}

TEST(HitFilters, ReceiveTInUnitsOfTheRay) {
  const HeightField flat = HeightField::own(std::vector<float>(9 * 9), 9, 9);
  const MaxPyramid pyramid(flat);
  std::vector<double> asked;
  const HitFilter accept = [&](const Hit& hit) {
    asked.push_back(hit.t);
    return true;
  };
  const Hit hit =
      march_max_mip_by_rules({&flat, &pyramid}, {{4.5, 4.5, 1}, {0x1p-600, 0, -0x1p-600}}, HitRules{.accept = &accept});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, 0x1p600);
  EXPECT_EQ(asked, std::vector{0x1p600});
}

TEST(Sides, SolidGroundHasNoWallsFromBelow) {
  const HeightField flat = HeightField::own(std::vector<float>(9 * 9), 9, 9, {.solid = true});
  const MaxPyramid pyramid(flat);
  const HeightTarget target{&flat, &pyramid};
  const Ray out{{4, 4, -1}, {1, 0, 0}}, up{{4, 4, -1}, {0, 0, 1}};
  for (const Sides sides : {Sides::below, Sides::both}) {
    EXPECT_FALSE(march_max_mip_by_rules(target, out, HitRules{sides}));
    EXPECT_EQ(march_max_mip_by_rules(target, up, HitRules{sides}).t, 1);
  }
  EXPECT_TRUE(march_max_mip_by_rules(target, {{-1, 4, -1}, {1, 0, 0}}, HitRules{Sides::both}).wall);
}

}  // namespace
}  // namespace scarp::test
