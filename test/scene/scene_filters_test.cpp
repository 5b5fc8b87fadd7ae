// SPDX-License-Identifier: MIT
// Filters over functions and shapes: behind a rejected hit the ray continues, and hits every surface that it enters
// from outside; compared with closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_query.h"

namespace scarp::test {
namespace {

constexpr double kTolerance = 1e-5;  // ten times that of the marches at a distance of 1

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  dvec3 inside(double side) { return {in(-side, side), in(-side, side), in(-side, side)}; }

 private:
  std::mt19937_64 engine_;
};

// Calls of a filter that rejects everything; hits within the tolerance count as one.
std::vector<double> all_hits(const Scene& scene, const Ray& ray, HitStatus& last) {
  std::vector<double> hits;
  const SceneQuery query = scene.query({.accept = [&](const Ray&, const Hit& hit) {
    if (hits.empty() || hit.t > hits.back() + kTolerance) hits.push_back(hit.t);
    return false;
  }});
  last = query.closest_hit(ray).status;
  return hits;
}

void expect_hits(const Scene& scene, const Ray& ray, const std::vector<double>& expected) {
  HitStatus last;
  const std::vector<double> hits = all_hits(scene, ray, last);
  ASSERT_EQ(hits.size(), expected.size());
  for (std::size_t i = 0; i < hits.size(); ++i) ASSERT_NEAR(hits[i], expected[i], kTolerance * (1 + expected[i]));
  ASSERT_EQ(last, HitStatus::miss);
  // The first accepted hit is one of these.
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto from = [&](const Ray&, const Hit& hit) { return hit.t > hits[i] - kTolerance; };
    const Hit hit = scene.query({.accept = from}).closest_hit(ray);
    ASSERT_TRUE(hit);
    ASSERT_NEAR(hit.t, hits[i], kTolerance * (1 + hits[i]));
    ASSERT_TRUE(scene.query({.accept = from}).occluded(ray));
  }
}

TEST(Filters, SeeEveryHillOfAFunction) {
  constexpr int kSamples = 4000;
  const HeightFunction waves(
      make_function(Sines{{{.amplitude = 3, .wavelength = 31}, {.amplitude = 1, .wavelength = 7.3, .towards = 1.1}}}));
  const Scene scene(scene_function(waves));
  Random random(1);
  int rays = 0, most = 0;
  for (int i = cases(2000, 300, 50); i > 0; --i) {
    Ray ray{.origin = {random.in(-50, 50), random.in(-50, 50), random.in(-3, 6)}, .t_max = 1};
    ray.direction = {random.in(-150, 150), random.in(-150, 150), random.in(-4, 4)};
    // Where the ray crosses the ground, by samples a few centimetres apart; rays that nearly touch it are skipped.
    std::vector<double> falls;
    const auto clearance = [&](double t) { return ray.at(t).z - waves.value(ray.at(t).x, ray.at(t).y); };
    double before = clearance(0), least = std::abs(before);
    if (before < 0) continue;
    for (int j = 1; j <= kSamples; ++j) {
      const double t0 = double(j - 1) / kSamples, t1 = double(j) / kSamples, after = clearance(t1);
      const double middle = clearance(0.5 * (t0 + t1));
      if ((before > 0) == (after > 0)) least = std::min({least, std::abs(before), std::abs(middle), std::abs(after)});
      if (before > 0 && after <= 0) {
        double low = t0, high = t1;
        for (int k = 0; k < 60; ++k) {
          const double at = 0.5 * (low + high);
          (clearance(at) > 0 ? low : high) = at;
        }
        falls.push_back(high);
      }
      before = after;
    }
    if (least < 1e-4) continue;
    ++rays;
    most = std::max(most, static_cast<int>(falls.size()));
    expect_hits(scene, ray, falls);
    // For directions of any length.
    if (rays % 10 == 0 && !falls.empty()) {
      Ray shorter = ray;
      shorter.direction *= 0x1p-600, shorter.t_max *= 0x1p600;
      HitStatus last;
      const std::vector<double> hits = all_hits(scene, shorter, last);
      ASSERT_NEAR(hits.front() * 0x1p-600, falls.front(), kTolerance);
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(rays, cases(1000, 100, 10));
  EXPECT_GE(most, 4);
}

TEST(Filters, SeeEveryBallFromOutside) {
  Random random(2);
  int rays = 0, most = 0;
  for (int round = cases(2000, 300, 50); round > 0; --round) {
    std::vector<std::pair<dvec3, double>> balls;
    std::vector<Shape> parts;
    for (int i = 0; i < 60; ++i) {
      balls.emplace_back(random.inside(3), random.in(0.2, 0.7));
      parts.push_back(make_shape(shape::Moved{make_shape(shape::Sphere{balls.back().second}), balls.back().first}));
    }
    const Scene scene(scene_shape(DistanceField(make_shape(shape::Union{parts}))));
    for (int i = 0; i < 5; ++i) {
      Ray ray{.origin = random.inside(3) + dvec3(0, 0, 15), .t_max = 3};
      ray.direction = random.inside(2) - ray.origin;
      // Where the ray is in a ball; rays that nearly graze a ball, or leave one where they enter another, are skipped.
      std::vector<std::pair<double, double>> in;
      bool clear = true;
      const double square = dot(ray.direction, ray.direction);
      for (const auto& [centre, radius] : balls) {
        const double closest = dot(centre - ray.origin, ray.direction) / square, off = length(ray.at(closest) - centre);
        clear = clear && std::abs(off - radius) > 1e-3;
        if (off >= radius) continue;
        const double half = std::sqrt((radius - off) * (radius + off) / square);
        in.emplace_back(closest - half, closest + half);
      }
      std::sort(in.begin(), in.end());
      std::vector<double> entries;
      double end = -1;
      for (const auto& [enter, leave] : in) {
        clear = clear && std::abs(enter - end) > 1e-3;
        if (enter > end) entries.push_back(enter);
        end = std::max(end, leave);
      }
      if (!clear) continue;
      ++rays;
      most = std::max(most, static_cast<int>(entries.size()));
      expect_hits(scene, ray, entries);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(rays, cases(5000, 500, 50));
  EXPECT_GE(most, 4);
}

TEST(Filters, PassSeamsAndGrazes) {
  const Shape left = make_shape(shape::Moved{make_shape(shape::Box{{1, 1, 1}}), {-1, 0, 0}}),
              right = make_shape(shape::Moved{make_shape(shape::Box{{1, 1, 1}}), {1, 0, 0}}),
              far = make_shape(shape::Moved{make_shape(shape::Sphere{1}), {6, 0, 0}});
  const Scene scene(scene_shape(DistanceField(make_shape(shape::Union{{left, right, far}}))));
  expect_hits(scene, {.origin = {-5, 0.2, 0.3}, .direction = {1, 0, 0}, .t_max = 20},
              {3, 11 - std::sqrt(1 - 0.04 - 0.09)});
  // Along a face, and past a ball: apart from touches, the ray has no hits.
  for (const dvec3& from : {dvec3(-5, 0, 1), dvec3(-5, 1, 0), dvec3(-5, 1, 1)}) {
    HitStatus last;
    all_hits(scene, {.origin = from, .direction = {1, 0, 0}, .t_max = 20}, last);
    EXPECT_NE(last, HitStatus::hit);
  }
}

// Starts in the solid and on it.
TEST(Filters, RespectTheStartOfTheRay) {
  const Scene scene(scene_shape(DistanceField(make_shape(shape::Sphere{1}))));
  const SceneQuery none = scene.query({.accept = [](const Ray&, const Hit&) { return false; }});
  EXPECT_EQ(none.closest_hit({{0, 0, 0}, {0, 0, -1}}).status, HitStatus::below);
  const Ray down{{0, 0, 5}, {0, 0, -1}};
  const Hit top = scene.closest_hit(down);
  EXPECT_EQ(none.closest_hit({down.at(top.t), {0, 0, 1}}, &top).status, HitStatus::miss);
  EXPECT_EQ(none.closest_hit({down.at(top.t), {0, 0, -1}}, &top).status, HitStatus::miss);
  const Scene waves(scene_function(HeightFunction(make_function(Sines{{{.amplitude = 2, .wavelength = 20}}}))));
  const SceneQuery nothing = waves.query({.accept = [](const Ray&, const Hit&) { return false; }});
  EXPECT_EQ(nothing.closest_hit({{5, 0, -1}, {0, 0, -1}}).status, HitStatus::below);
  // A ray along flat ground touches it everywhere: the step limit ends the march.
  const Scene flat(scene_function(HeightFunction(make_function(Plane{}))));
  EXPECT_NE(flat.query({.accept = [](const Ray&, const Hit&) { return false; }})
                .closest_hit({.origin = {0, 0, 0}, .direction = {1, 0, 0}, .t_max = 100})
                .status,
            HitStatus::hit);
}

TEST(Filters, RequireMarchesThatContinue) {
  const Scene naive(scene_function(HeightFunction(make_function(Plane{})), find_function_march("naive")));
  const Ray down{{0, 0, 3}, {0, 0, -1}};
  EXPECT_TRUE(naive.query({.accept = [](const Ray&, const Hit&) { return true; }}).closest_hit(down));
  EXPECT_EQ(
      refusal([&] { naive.query({.accept = [](const Ray&, const Hit&) { return false; }}).closest_hit(down); }),
      "scene: the filter rejected a hit on a function; naive cannot continue behind it (use another march, or exclude "
      "the object by its mask)");
}

}  // namespace
}  // namespace scarp::test
