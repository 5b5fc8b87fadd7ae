// SPDX-License-Identifier: MIT
// sphere-trace against proofs by interval arithmetic and against closed forms: it loses no hits.
#include "scarp/march/shape/sphere_trace.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "cases.h"
#include "field/shape_zoo.h"
#include "scarp/base/error.h"
#include "scarp/march/shape/shape_exhaustive.h"
#include "scarp/march/shape/shape_table.h"

namespace scarp::test {
namespace {

using namespace shape;

const int kRays = cases(2000, 500, 200);
constexpr double kTolerance = SphereTraceSettings{}.tolerance;

dvec3 anywhere(FunctionRandom& random, double reach) {
  return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

// Rays from outside, aimed at positions around the origin; some graze the surface at the point nearest to a position.
Ray random_ray(const DistanceField& field, FunctionRandom& random) {
  Ray ray;
  double reach = 20;
  do {
    ray.origin = anywhere(random, reach);
    if (ray.origin.z < 0 && random.between(0, 1) < 0.8) ray.origin.z = -ray.origin.z;
    reach *= 1.01;
  } while (field.value(ray.origin) < 0.01);
  const double scale = std::exp2(random.between(-3, 3)), kind = random.between(0, 3);
  dvec3 at = anywhere(random, 8);
  if (kind < 1) {
    const dvec3 foot = at - field.value(at) * field.gradient(at);
    at = foot + field.normal(foot) * random.between(-0.01, 0.01);
    // Along the surface there.
    const dvec3 along = cross(field.normal(foot), anywhere(random, 1));
    ray.origin = at + along * 20.0;
    if (!(field.value(ray.origin) > 0.01)) return random_ray(field, random);
  }
  if (!(length(at - ray.origin) > 0.1)) at = ray.origin + dvec3(0, 0, -1);
  ray.direction = normalize(at - ray.origin) * scale;
  ray.t_max = 60 / scale;
  return ray;
}

struct Counts {
  int crossings = 0, clear = 0, undecided = 0, exhausted = 0, early = 0, inexact = 0;
  double steps = 0;
};

void expect_nothing_lost(const Shape& shape, const DistanceField& field, const Ray& ray, const std::string& name,
                         Counts& counts) {
  const FunctionJudgement judge = judge_shape(shape, ray, 1 << 16);
  MarchStats stats;
  const Hit hit = march_sphere_trace(field, ray, {}, &stats);
  counts.steps += stats.steps + stats.cell_tests;
  counts.exhausted += hit.status == HitStatus::exhausted;
  ASSERT_NE(hit.status, HitStatus::below) << name;
  ASSERT_EQ(occluded_sphere_trace(field, ray), bool(hit)) << name;
  const auto count_early = [&](const FunctionJudgement& proof, const Hit& at) {
    counts.inexact += proof.clear_until - at.t > 2 * kTolerance * at.t &&
                      field.value(ray.at(at.t)) > 2 * kTolerance * at.t * length(ray.direction);
  };
  switch (judge.verdict) {
    case FunctionVerdict::crossing:
      ++counts.crossings;
      ASSERT_NE(hit.status, HitStatus::miss) << name << ": lost the crossing at t = " << judge.crossed_by;
      if (hit) {
        ASSERT_LE(hit.t, judge.crossed_by + kTolerance * hit.t) << name;
        count_early(judge, hit);
      }
      break;
    case FunctionVerdict::clear:
      ++counts.clear;
      counts.early += bool(hit);
      break;
    case FunctionVerdict::undecided:
      // A touch, nearly one, or exhausted evaluations: the ray is proven to be free up to there.
      ++counts.undecided;
      if (hit) count_early(judge, hit);
      break;
  }
}

TEST(SphereTrace, LosesNoHits) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    FunctionRandom random(21);
    Counts counts;
    for (int i = 0; i < kRays; ++i) {
      expect_nothing_lost(named.shape, field, random_ray(field, random), named.name, counts);
      if (HasFatalFailure()) return;
    }
    fmt::print("{}: {} crossings, {} clear, {} undecided, {} exhausted, {} early, {} inexact, {:.1f} steps\n",
               named.name, counts.crossings, counts.clear, counts.undecided, counts.exhausted, counts.early,
               counts.inexact, counts.steps / kRays);
    // Enough rays of either kind to make the test meaningful.
    EXPECT_GE(counts.crossings, kRays / 40) << named.name;
    EXPECT_GE(counts.clear, kRays / 40) << named.name;
    // Not only conservative, but correct.
    EXPECT_LE(counts.exhausted, 1 + kRays / 200) << named.name;
    EXPECT_LE(counts.early + counts.inexact, 1 + kRays / 200) << named.name;
  }
}

RC_GTEST_PROP(SphereTrace, LosesNoHitsOnRandomTrees, (unsigned seed)) {
  FunctionRandom random(seed);
  const Shape shape = random_shape(random, 1 + static_cast<int>(seed % 4), true);
  const DistanceField field(shape);
  Counts counts;
  for (int i = 0; i < 4; ++i) {
    expect_nothing_lost(shape, field, random_ray(field, random), fmt::format("seed {}", seed), counts);
    RC_ASSERT(!::testing::Test::HasFatalFailure());
  }
}

// Closed forms: the first t where a ray from outside enters.
std::optional<double> enter_quadratic(double a, double b, double c) {
  const double d = b * b - a * c;
  if (d < 0) return {};
  const double t = (-b - std::sqrt(d)) / a;
  return t >= 0 ? std::optional(t) : std::nullopt;
}

TEST(SphereTrace, MatchesClosedForms) {
  FunctionRandom random(22);
  const DistanceField ball(make_shape(Sphere{2})), block(make_shape(Box{{3, 2, 1}})),
      floor(make_shape(HalfSpace{{0, 1, 2}, 1})), pillar(make_shape(Cylinder{1, 4}));
  int hits = 0;
  for (int i = 0; i < 4 * kRays; ++i) {
    Ray ray;
    ray.origin = anywhere(random, 30);
    ray.direction = anywhere(random, 3) - ray.origin * random.between(0.2, 2);
    const dvec3 o = ray.origin, d = ray.direction;
    const auto expect = [&](const DistanceField& field, std::optional<double> t, double clearance) {
      if (field.value(o) <= 0) return;
      const Hit hit = march_sphere_trace(field, ray);
      // Rays that pass closer than the tolerance may be reported either way.
      if (t) {
        ++hits;
        ASSERT_TRUE(hit || clearance < 1e-4) << "lost the hit at " << *t;
        if (hit && clearance > 1e-4) {
          ASSERT_NEAR(hit.t, *t, 1e-9 * (1 + *t));
        }
      } else if (clearance > 1e-4) {
        ASSERT_EQ(hit.status, HitStatus::miss);
      }
    };
    // Closeness to a graze: of the ball's discriminant, of the box's slabs, of the plane's slope.
    const double a = dot(d, d), b = dot(o, d);
    const double nearest = length(o - d * (b / a));
    expect(ball, enter_quadratic(a, b, dot(o, o) - 4), std::abs(nearest - 2));
    double in = 0, out = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
      const double half = axis == 0 ? 3 : axis == 1 ? 2 : 1;
      const double t0 = (-half - o[axis]) / d[axis], t1 = (half - o[axis]) / d[axis];
      in = std::max(in, std::min(t0, t1)), out = std::min(out, std::max(t0, t1));
    }
    expect(block, in <= out ? std::optional(in) : std::nullopt, std::abs(out - in) * length(d));
    const dvec3 n = dvec3(0, 1, 2) / std::sqrt(5.0);
    const double down = dot(d, n), t = (1 - dot(o, n)) / down;
    expect(floor, down < 0 && t >= 0 ? std::optional(t) : std::nullopt, std::abs(down));
    // An upright cylinder that is hit from its side.
    const double ha = d.x * d.x + d.y * d.y, hb = o.x * d.x + o.y * d.y, hc = o.x * o.x + o.y * o.y - 1;
    const auto side = enter_quadratic(ha, hb, hc);
    if (side && hc > 0 && std::abs(o.z + *side * d.z) < 3.9) {
      expect(pillar, side, std::abs(1 - std::abs(o.x * d.y - o.y * d.x) / std::sqrt(ha)));
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, kRays);
}

TEST(SphereTrace, MeasuresTInLengthsOfTheDirection) {
  const DistanceField ball(make_shape(Sphere{1}));
  for (const double scale : {1e-6, 1.0, 3e7}) {
    const Hit hit = march_sphere_trace(ball, {{0, 0, 5}, {0, 0, -scale}});
    ASSERT_TRUE(hit) << scale;
    EXPECT_NEAR(hit.t * scale, 4, 1e-12);
    EXPECT_NEAR(hit.height, 1, 1e-12);
  }
  Ray ray{{0, 0, 5}, {0, 0, -2}};
  ray.t_max = 1.999;
  EXPECT_EQ(march_sphere_trace(ball, ray).status, HitStatus::miss);
  ray.t_max = 2;  // closed
  EXPECT_TRUE(march_sphere_trace(ball, ray));
  ray.t_min = 2.5;  // inside
  ray.t_max = 9;
  EXPECT_EQ(march_sphere_trace(ball, ray).status, HitStatus::below);
  // From far away, with an infinite range.
  EXPECT_NEAR(march_sphere_trace(ball, {{1e7, 0, 0}, {-1, 0, 0}}).t, 1e7 - 1, 1e-8);
  EXPECT_EQ(march_sphere_trace(ball, {{1e7, 0, 0}, {1, 0, 0}}).status, HitStatus::miss);
  EXPECT_EQ(march_sphere_trace(ball, {{0, 0, 5}, {0, 1, 0}}).status, HitStatus::miss);
}

TEST(SphereTrace, RaysFromInsideHitLaterSurfaces) {
  const DistanceField two(
      make_shape(Union{{make_shape(Sphere{1}), make_shape(Moved{make_shape(Sphere{1}), {5, 0, 0}})}}));
  const Hit hit = march_sphere_trace(two, {{0.2, 0, 0}, {1, 0, 0}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, 3.8, 1e-9);
  EXPECT_EQ(march_sphere_trace(two, {{0.2, 0, 0}, {-1, 0, 0}}).status, HitStatus::below);
  EXPECT_EQ(march_sphere_trace(two, {{5, 0, 0}, {1, 0.3, 0}}).status, HitStatus::below);
  EXPECT_FALSE(occluded_sphere_trace(two, {{5, 0, 0}, {1, 0.3, 0}}));
  EXPECT_TRUE(occluded_sphere_trace(two, {{0.2, 0, 0}, {1, 0, 0}}));
  // Out of a box by a face, and straight along its middle.
  const DistanceField block(make_shape(Box{{1, 2, 3}}));
  EXPECT_EQ(march_sphere_trace(block, {{0, 0, 0}, {0, 0, 1}}).status, HitStatus::below);
}

TEST(SphereTrace, RaysFromInsideContinueThroughSeams) {
  const auto block = [](double half, double z) { return make_shape(Moved{make_shape(Box{{1, 1, half}}), {0, 0, z}}); };
  // Two blocks that touch, or nearly do, from z = 1 to 3, and one block from -3 to -1.
  for (const double gap : {-1e-3, 0.0, 1e-13, 1e-11, 1e-9, 1e-8, 1e-6, 1e-4}) {
    const DistanceField field(make_shape(Union{{block(0.5, 2.5 + gap), block(0.5, 1.5), block(1, -2)}}));
    const Ray down{{0.1, 0.2, 2.5}, {0.1, 0.05, -1}};
    const Hit hit = march_sphere_trace(field, down);
    ASSERT_EQ(hit.status, HitStatus::hit) << gap;
    EXPECT_TRUE(occluded_sphere_trace(field, down)) << gap;
    // At the lower block, or behind it if there is a visible gap.
    const double seam = 0.5, lower = 3.5;
    const bool in_gap = gap > 0 && std::abs(hit.t - seam) <= gap + kTolerance * seam;
    EXPECT_TRUE(in_gap || std::abs(hit.t - lower) <= kTolerance * lower) << gap << ": " << hit.t;
  }
  std::vector<Shape> bricks{make_shape(Moved{make_shape(Box{{1, 4, 4}}), {20, 0, 0}})};
  for (int i = 0; i < 5; ++i) bricks.push_back(make_shape(Moved{make_shape(Box{{0.5, 1, 1}}), {i, 0, 0}}));
  const DistanceField wall(make_shape(Union{bricks}));
  for (int i = -10; i <= 10; ++i) {
    const Hit hit = march_sphere_trace(wall, {{0, 0, 0}, {1, 0.01 * i, 0.003 * i}});
    ASSERT_EQ(hit.status, HitStatus::hit) << i;
    EXPECT_NEAR(hit.t, 19, kTolerance * 19) << i;
  }
}

// A ray from a hit: its origin is the reported position.
Ray sent_on(const Ray& ray, const Hit& hit, const dvec3& direction) {
  Ray on;
  on.origin = ray.at(hit.t);
  on.direction = direction;
  on.start = RayStart::on_surface;
  on.t_max = 40;
  return on;
}

// Steps sideways and along the ray have a different normal: from an edge a ray may enter the solid and leave it again
// at once.
bool is_on_edge(const DistanceField& field, const dvec3& p, const dvec3& direction) {
  const dvec3 n = field.normal(p);
  for (const dvec3& side : {cross(n, direction), direction - n * dot(n, direction)}) {
    for (const double step : {-1e-5, 1e-5}) {
      if (length(field.normal(p + step * side) - n) > 1e-3) return true;
    }
  }
  return false;
}

// Whether a ray from the surface enters the solid, and leaves it again, before t.
bool dips(const DistanceField& field, const Ray& ray, double t) {
  for (double at = t; at > 1e-9; at *= 0.98) {
    if (field.value(ray.at(at)) < -4 * field.rounding(30)) return true;
  }
  return false;
}

TEST(SphereTrace, RaysFromConvexSolidsEscape) {
  FunctionRandom random(23);
  for (const NamedShape& named : shape_zoo()) {
    const bool convex = named.name == "sphere" || named.name == "box" || named.name == "rounded box" ||
                        named.name == "half space" || named.name == "floor" || named.name == "capsule" ||
                        named.name == "cylinder" || named.name == "cone" || named.name == "frustum" ||
                        named.name == "ellipsoid" || named.name == "turned box" || named.name == "intersection";
    if (!convex) continue;
    const DistanceField field(named.shape);
    int free = 0, blocked = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = random_ray(field, random);
      const Hit hit = march_sphere_trace(field, ray);
      if (!hit) continue;
      const dvec3 p = ray.at(hit.t), n = field.normal(p), direction = normalize(anywhere(random, 1));
      if (is_on_edge(field, p, direction)) continue;
      const double away = dot(n, direction);
      const Hit next = march_sphere_trace(field, sent_on(ray, hit, direction));
      if (away > 1e-4) {
        ++free;
        ASSERT_EQ(next.status, HitStatus::miss) << named.name << ": hits itself at " << next.t << ", slope " << away;
        ASSERT_FALSE(occluded_sphere_trace(field, sent_on(ray, hit, direction)));
      } else if (away < -1e-4) {
        ++blocked;
        ASSERT_TRUE(next) << named.name << ", slope " << away;
        ASSERT_LE(next.t, 1e-3) << named.name;
      }
    }
    EXPECT_GT(free, kRays / 100) << named.name;
    EXPECT_GT(blocked, kRays / 100) << named.name;
  }
}

TEST(SphereTrace, RaysAlongAPlaneMiss) {
  const DistanceField floor(make_shape(HalfSpace{{0, 0, 1}, 0.3})), block(make_shape(Box{{3, 2, 1}}));
  for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
    Ray ray{{0.5, 0.25, 0.3}, {std::cos(angle), std::sin(angle), 0}};
    ray.start = RayStart::on_surface;
    EXPECT_EQ(march_sphere_trace(floor, ray).status, HitStatus::miss) << angle;
    ray.origin.z = 1;
    EXPECT_EQ(march_sphere_trace(block, ray).status, HitStatus::miss) << angle;
  }
}

TEST(SphereTrace, RaysFromConcavitiesHitTheOtherSide) {
  // From the inner side of a ring across its hole, and out of a bowl.
  const DistanceField ring(make_shape(Torus{3, 1}));
  Ray ray{{2, 0, 0}, {-1, 0, 0}};
  ray.start = RayStart::on_surface;
  const Hit across = march_sphere_trace(ring, ray);
  ASSERT_TRUE(across);
  EXPECT_NEAR(across.t, 4, 1e-9);
  const DistanceField bowl(
      make_shape(Subtraction{make_shape(Box{{4, 4, 2}}), make_shape(Moved{make_shape(Sphere{3}), {0, 0, 2}})}));
  FunctionRandom random(24);
  for (int i = 0; i < kRays; ++i) {
    // From one point on the inside of the bowl to another: a chord of the sphere.
    const auto inside = [&] {
      const double z = -random.between(0.2, 1), a = random.between(0, 6.28), r = std::sqrt(1 - z * z);
      return dvec3(0, 0, 2) + 3.0 * dvec3(r * std::cos(a), r * std::sin(a), z);
    };
    const dvec3 from = inside(), to = inside();
    if (length(to - from) < 0.01) continue;
    Ray chord{from, to - from};
    chord.start = RayStart::on_surface;
    const Hit hit = march_sphere_trace(bowl, chord);
    ASSERT_TRUE(hit);
    // At a flat angle the position of the hit is less accurate.
    ASSERT_NEAR(hit.t, 1, 1e-9 / length(to - from));
  }
}

TEST(SphereTrace, ShadowsMatchTheJudge) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    FunctionRandom random(25);
    int leaving = 0, blocked = 0;
    for (int i = 0; i < kRays / 4; ++i) {
      const Ray ray = random_ray(field, random);
      const Hit hit = march_sphere_trace(field, ray);
      if (!hit) continue;
      Ray on = sent_on(ray, hit, normalize(anywhere(random, 1)));
      const Hit next = march_sphere_trace(field, on);
      ASSERT_EQ(occluded_sphere_trace(field, on), bool(next)) << named.name;
      // A millimetre further, the ray is either free, and judged from there, or it has entered the solid.
      Ray later = on;
      later.start = RayStart::free;
      later.t_min = 1e-3;
      const double f = field.value(later.at(later.t_min));
      if (f < -1e-6) {
        ASSERT_TRUE(next && next.t <= later.t_min) << named.name << ": " << f;
        ++blocked;
      } else if (f > 1e-6) {
        const FunctionJudgement judge = judge_shape(named.shape, later, 1 << 16);
        if (judge.verdict == FunctionVerdict::crossing) {
          ASSERT_TRUE(next && next.t <= judge.crossed_by + kTolerance * next.t) << named.name;
        } else if (judge.verdict == FunctionVerdict::clear) {
          ++leaving;
          ASSERT_FALSE(next && next.t > later.t_min) << named.name << " at t = " << next.t;
          ASSERT_TRUE(!next || is_on_edge(field, on.origin, on.direction) || dips(field, on, later.t_min))
              << named.name << ": hits itself at t = " << next.t;
        }
      }
    }
    EXPECT_GT(leaving + blocked, 0) << named.name;
  }
}

TEST(SphereTrace, ReportsExhaustionSeparatelyFromHits) {
  const DistanceField lattice(make_shape(Repeated{make_shape(Sphere{1}), {3, 3, 3}}));
  MarchSettings settings;
  settings.sphere_trace.max_steps = 3;
  MarchStats stats;
  const Hit hit = march_sphere_trace(lattice, {{1.5, 1.5, 1.5}, {1, 0.02, 0.01}}, settings, &stats);
  EXPECT_EQ(hit.status, HitStatus::exhausted);
  EXPECT_GE(stats.steps + stats.cell_tests, 3u);
  EXPECT_LE(stats.steps + stats.cell_tests, 5u);
  EXPECT_GT(hit.t, 0);
  settings.sphere_trace = {.tolerance = -1};
  EXPECT_THROW(validate(settings), Error);
  settings.sphere_trace = {.max_steps = 0};
  EXPECT_THROW(validate(settings), Error);
}

TEST(SphereTrace, IsListed) {
  const ShapeMarchEntry& march = find_shape_march("sphere-trace");
  EXPECT_EQ(march.cpu, march_sphere_trace);
  EXPECT_EQ(march.guarantee, Guarantee::conservative);
  EXPECT_EQ(shape_marches().size(), 1u);
  EXPECT_THROW(find_shape_march("max-mip"), Error);
}

}  // namespace
}  // namespace scarp::test
