// SPDX-License-Identifier: MIT
// Vectors and the scalar walk agree on single rays: over every kind of field and ray of the oracle's suite, next to the
// ground, through nodes and along borders, on every instruction set that this machine has.
#include "scarp/march/height/max_mip_ahead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "march/instruction_sets.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_resume.h"

namespace scarp::test {
namespace {

using max_mip::Ahead;

const int kRaysPerPair = cases(10'000, 1000, 16);
const int kRays = cases(100'000, 10'000, 400);
constexpr int kRaysPerField = 500;

// Returns the number of rays that vectors decide.
int compare(const HeightTarget& target, const std::vector<Ray>& rays, const std::string& what) {
  if (!max_mip::looks_ahead(target)) return 0;
  int decided = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].start != RayStart::free) continue;
    const bool expected = resume_occluded_max_mip(target, rays[i], max_mip::kNotClear);
    double t_clear;
    const Ahead ahead = max_mip::look_ahead(target, rays[i], t_clear);
    if (ahead == Ahead::open) {
      EXPECT_EQ(resume_occluded_max_mip(target, rays[i], t_clear), expected)
          << what << ", from " << t_clear << ", " << i;
    } else {
      ++decided;
      EXPECT_EQ(ahead == Ahead::hit, expected) << what << ", ray " << i;
    }
    EXPECT_EQ(occluded_max_mip(target, rays[i]), expected) << what << ", ray " << i;
    if (testing::Test::HasFailure()) return decided;
  }
  return decided;
}
int compare_on_all(const HeightTarget& target, const std::vector<Ray>& rays, const std::string& what) {
  int decided = 0;
  for (const std::int64_t set : instruction_sets()) {
    const InstructionSet only(set);
    decided = std::max(decided, compare(target, rays, what + ", " + hwy::TargetName(set)));
  }
  return decided;
}

TEST(MaxMipAhead, MatchesTheScalarWalk) {
  Random random(91);
  for (const FieldKind& fields : spiteful_fields()) {
    for (int part = 0; part < kRaysPerPair; part += kRaysPerField) {
      const HeightField field = fields.make(random);
      const MaxPyramid pyramid(field);
      std::vector<Ray> rays;
      for (const RayKind& kind : spiteful_rays()) {
        if ((fields.has & kind.aims_at) != kind.aims_at) continue;
        for (int i = 0; i < std::min(kRaysPerField, kRaysPerPair); ++i) rays.push_back(kind.make(field, random));
      }
      compare_on_all({&field, &pyramid}, rays, std::string(fields.name));
      if (HasFailure()) return;
    }
  }
}

// The field spans several blocks, and its sides are not powers of two. The rays start within metres of the ground and
// travel far.
TEST(MaxMipAhead, FollowsRaysAlongHills) {
  Random random(92);
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const HeightField field = hills(413, 270, surface);
    const MaxPyramid pyramid(field);
    std::vector<Ray> rays;
    for (int i = 0; i < kRays; ++i) {
      Ray ray = along_hills(field, random, false);
      if (i % 3 == 0) ray.t_max = uniform(random, 0, 100);
      if (i % 5 == 0) ray.t_min = uniform(random, -100, 50);
      rays.push_back(ray);
    }
    const int decided = compare_on_all({&field, &pyramid}, rays, "hills");
    if (HasFailure()) return;
    if (!max_mip::looks_ahead({&field, &pyramid})) GTEST_SKIP() << "vectors of this machine are too short";
    // Only rays that pass the ground within the margins remain undecided: far fewer than half.
    EXPECT_GT(decided, kRays / 2);
  }
}

// From nodes, edges and points of cells, and from outside through them; above the ground by less than float precision,
// or below it; along axes and diagonals; over ground that is rough from sample to sample.
template <class T>
void rough_ground(Random& random, double relief, int cols, int rows) {
  std::vector<T> samples;
  for (int i = 0; i < cols * rows; ++i) samples.push_back(static_cast<T>(uniform(random, 0, relief)));
  const HeightField field = HeightField::own(std::move(samples), cols, rows);
  const MaxPyramid pyramid(field);
  std::vector<Ray> rays;
  for (int i = 0; i < kRays / 4; ++i) {
    const auto along = [&](int axis, int side) {
      const double node = std::floor(uniform(random, 0, side));
      return i / (axis + 1) % 3 == 0 ? std::min(node + uniform(random, 0, 1), side - 1.0) : node;
    };
    Ray ray;
    const double x = along(0, cols), y = along(1, rows), lift = relief * std::exp2(-uniform(random, 1, 55));
    ray.origin = {x, y, *field.height(x, y) + (i % 7 == 0 ? -lift : lift)};
    const double turn =
        i % 3 == 2 ? uniform(random, 0, 6.3) : std::floor(uniform(random, 0, 8)) * (std::numbers::pi / 4);
    const auto exact = [&](double v) { return i % 3 == 1 ? std::round(v) : v; };  // -1, 0, 1
    ray.direction = {exact(std::cos(turn)), exact(std::sin(turn)),
                     relief * uniform(random, -1, 1) * uniform(random, 0, i % 4 == 0 ? 0.01 : 1)};
    if (i % 5 == 0) ray.direction.x *= std::exp2(-uniform(random, 0, 60));
    // Through the same point, from farther back.
    if (i % 4 == 1) {
      const double back = uniform(random, 0, 100);
      ray.origin -= back * ray.direction;
    }
    if (i % 11 == 0) ray.t_max = std::ldexp(1.0, static_cast<int>(uniform(random, -10, 10)));
    rays.push_back(ray);
  }
  compare_on_all({&field, &pyramid}, rays, "relief " + std::to_string(relief));
}
TEST(MaxMipAhead, StartsJustAboveRoughGround) {
  Random random(93);
  for (const double relief : {0.5, 40.0, 4000.0}) {
    rough_ground<float>(random, relief, 65, 65);
    rough_ground<std::int16_t>(random, relief, 3, 70);
    rough_ground<std::uint16_t>(random, relief, 67, 2);
    if (HasFailure()) return;
  }
}

// Nearly level rays through the highest node, and others that nearly run along its lines.
TEST(MaxMipAhead, TouchesTheHighestSample) {
  Random random(94);
  const int side = 17;
  std::vector<float> samples(side * side, 0.f);
  samples[8 * side + 8] = 100;
  const HeightField field = HeightField::own(std::move(samples), side, side);
  const MaxPyramid pyramid(field);
  std::vector<Ray> rays;
  for (int i = 0; i < kRays; ++i) {
    const double turn = uniform(random, 0, 1.5707), slope = std::exp2(-uniform(random, 1, 46));
    Ray ray;
    ray.direction = {std::cos(turn), i % 3 == 0 ? slope : std::sin(turn), i % 2 ? slope : -slope};
    ray.origin = dvec3{8, 8, 100 + (i % 5 == 0 ? slope : 0)} - uniform(random, 0, 20) * ray.direction;
    rays.push_back(ray);
  }
  compare_on_all({&field, &pyramid}, rays, "touches");
}

TEST(MaxMipAhead, HandlesUnusualNumbers) {
  const HeightField field = hills(129, 65, Surface::bilinear);
  const MaxPyramid pyramid(field);
  compare_on_all({&field, &pyramid}, rays_of_unusual_numbers(field), "unusual numbers");
}

}  // namespace
}  // namespace scarp::test
