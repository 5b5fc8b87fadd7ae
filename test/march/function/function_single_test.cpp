// SPDX-License-Identifier: MIT
// Terrain functions in single precision: the shader text, compiled as C++, against doubles. Lattices match to the bit,
// heights and bounds to within the errors that field/function_single.h derives, and marches to within what follows from
// these.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cases.h"
#include "field/terrain_functions.h"
#include "march/function/function_judge.h"
#include "march/function/function_rays.h"
#include "scarp/accel/function_words.h"
#include "scarp/base/error.h"
#include "scarp/field/function_single.h"
#include "scarp/march/function/device_function_ray.h"
#include "scarp/march/function/function_marches.glsl.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/function/lipschitz_local.glsl.h"
#include "scarp/march/function/noise.glsl.h"
#include "scarp/march/sampling/device_sampling.h"

namespace scarp::glsl {

static const ScarpInstruction* host_program = nullptr;
ScarpInstruction scarp_instruction(uint i) { return host_program[i]; }
bool scarp_uses(uint) { return true; }

}  // namespace scarp::glsl

namespace scarp::test {
namespace {

const int kPlaces = cases(20'000, 4000, 500);
const int kSegments = cases(3'000, 600, 60);
const int kRays = cases(2'000, 400, 20);

constexpr int kAll = 1 << 30;  // steps of a run

glsl::ScarpTwoFloat two(double x) {
  const auto high = static_cast<float>(x);
  return {high, static_cast<float>(x - static_cast<double>(high))};
}
double value(const glsl::ScarpTwoFloat& x) { return static_cast<double>(x.high) + static_cast<double>(x.low); }

// A function's program in the layout that the shaders read.
class Program {
 public:
  explicit Program(const FunctionProgram& program) : words_(function_words(program)) {
    glsl::host_program = words_.data();
    program_ = {static_cast<std::uint32_t>(words_.size()), program.result};
  }
  const glsl::ScarpProgram& operator*() const { return program_; }

 private:
  std::vector<glsl::ScarpInstruction> words_;
  glsl::ScarpProgram program_;
};

// Positions that 48 bits can hold, near the origin and far away.
double random_place(FunctionRandom& random) {
  const double reach = std::exp2(random.between(0, 30));
  return value(two(random.between(-reach, reach)));
}

TEST(NoiseInShaders, UsesTheSameLattice) {
  FunctionRandom random(1);
  for (int i = 0; i < kPlaces; ++i) {
    const double x = random_place(random) * (i % 2 ? 64 : 1), y = random_place(random);
    const auto col = static_cast<std::int64_t>(std::floor(x)), row = static_cast<std::int64_t>(std::floor(y));
    const glsl::ScarpLattice u = glsl::scarp_lattice(two(x)), v = glsl::scarp_lattice(two(y));
    ASSERT_EQ(u.cell, static_cast<std::uint32_t>(col)) << x;
    EXPECT_EQ(value(u.whole), std::floor(x));
    EXPECT_NEAR(u.place, x - std::floor(x), 0x1p-24);
    const std::uint32_t hash = lattice_hash(static_cast<std::uint32_t>(i), col, row);
    ASSERT_EQ(glsl::scarp_lattice_hash(static_cast<std::uint32_t>(i), u.cell, v.cell), hash);
    EXPECT_EQ(glsl::scarp_lattice_direction(hash).x, static_cast<float>(lattice_direction(hash)[0]));
    EXPECT_EQ(glsl::scarp_lattice_direction(hash).y, static_cast<float>(lattice_direction(hash)[1]));
    EXPECT_NEAR(glsl::scarp_lattice_value(hash), lattice_value(hash), 0x1p-23);
  }
}

TEST(NoiseInShaders, StaysWithinItsBound) {
  FunctionRandom random(2);
  for (const NoiseKind kind : {NoiseKind::value, NoiseKind::perlin, NoiseKind::simplex}) {
    const glsl::ScarpNoiseBound bound = glsl::scarp_noise_bound(static_cast<std::uint32_t>(kind));
    EXPECT_EQ(static_cast<double>(bound.n_off), function::noise_off(kind));
    EXPECT_EQ(static_cast<double>(bound.slope_off), function::noise_slope_off(kind));
    EXPECT_GE(static_cast<double>(bound.slope) * (1 + 0x1p-20), bound_of(kind).slope);
    double worst[3] = {};
    for (int i = 0; i < kPlaces; ++i) {
      const double x = random_place(random) * 0x1p-8, y = random_place(random) * 0x1p-8;
      const NoiseJet truth = noise_jet(kind, 7, value(two(x)), value(two(y)));
      const glsl::ScarpNoise noise = glsl::scarp_noise(static_cast<std::uint32_t>(kind), 7, two(x), two(y));
      const auto off = [](float a, double b) { return std::abs(static_cast<double>(a) - b); };
      worst[0] = std::max(worst[0], off(noise.n, truth.n));
      worst[1] = std::max({worst[1], off(noise.x, truth.x), off(noise.y, truth.y)});
      worst[2] = std::max({worst[2], off(noise.xx, truth.xx), off(noise.xy, truth.xy), off(noise.yy, truth.yy)});
    }
    fmt::print("noise {}: off by at most {:.2g}, {:.2g}, {:.2g}; bounds {:.2g}, {:.2g}, {:.2g}\n",
               static_cast<int>(kind), worst[0], worst[1], worst[2], bound.n_off, bound.slope_off, bound.curvature_off);
    EXPECT_LE(worst[0], static_cast<double>(bound.n_off));
    EXPECT_LE(worst[1], static_cast<double>(bound.slope_off));
    EXPECT_LE(worst[2], static_cast<double>(bound.curvature_off));
  }
}

TEST(FunctionsInShaders, HeightsStayWithinTheirBound) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    const Program program(function.program(FunctionUse::march));
    const SingleRounding rounding(function.program(FunctionUse::march));
    FunctionRandom random(3);
    double worst = 0;
    for (int i = 0; i < kPlaces; ++i) {
      const double x = random_place(random), y = random_place(random);
      const double height = value(glsl::scarp_height(*program, two(x), two(y)));
      const double off = std::abs(height - function.value(x, y)),
                   bound = rounding.at(std::max(std::abs(x), std::abs(y)));
      ASSERT_LE(off, bound) << named.name << " at " << x << ", " << y;
      worst = std::max(worst, off / bound);
    }
    fmt::print("{}: {:.2g} m within 8 km, {:.2g} m within 2^30 m; at most {:.2f} of it seen\n", named.name,
               rounding.at(8192), rounding.at(0x1p30), worst);
  }
}

TEST(FunctionsInShaders, BoundsHold) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    const Program program(function.program(FunctionUse::march));
    const SingleRounding rounding(function.program(FunctionUse::march));
    FunctionRandom random(4);
    double wider = 0;
    for (int i = 0; i < kSegments; ++i) {
      Ray ray = random_ray(function, random);
      ray.origin += dvec3(i % 3 == 0 ? 1e6 : 0, 0, 0);
      const auto prepared = device_function_ray(function, rounding, ray, FunctionUse::march, 1e5);
      if (!prepared.marches) continue;
      const auto s0 = static_cast<float>(random.between(0, 5000));
      const auto s1 = s0 + static_cast<float>(std::exp2(random.between(-12, 12)));
      const glsl::ScarpProof proof = glsl::scarp_proof(*program, prepared.ray, 0, s0, s1);
      const auto clearance = [&](double s) {
        const double t = prepared.begin + s * prepared.per_time;
        const dvec3 p = ray.at(t);
        return p.z - function.value(p.x, p.y);
      };
      for (int k = 0; k <= 16; ++k) {
        const double s = static_cast<double>(s0) + k / 16.0 * static_cast<double>(s1 - s0), h = clearance(s);
        if (s < static_cast<double>(proof.until)) {
          ASSERT_GT(h, 0) << named.name << ": " << s0 << " to " << s1;
        }
      }
      const auto middle = static_cast<double>(proof.middle), half = static_cast<double>(proof.half_);
      const double begin = clearance(middle - half), end = clearance(middle + half);
      ASSERT_LE(middle - half, static_cast<double>(s0));
      ASSERT_GE(middle + half, static_cast<double>(s1));
      ASSERT_LE(static_cast<double>(proof.begin), begin) << named.name << ": " << s0 << " to " << s1;
      ASSERT_GE(static_cast<double>(proof.begin_most), begin) << named.name << ": " << s0 << " to " << s1;
      ASSERT_LE(static_cast<double>(proof.end), end) << named.name << ": " << s0 << " to " << s1;
      ASSERT_GE(static_cast<double>(proof.end_most), end) << named.name << ": " << s0 << " to " << s1;
      // Where a segment shrinks to a point, the bounds are as accurate as heights are.
      const glsl::ScarpProof point = glsl::scarp_proof(*program, prepared.ray, 0, s0, s0);
      const double own =
          0x1p-20 * std::abs(clearance(static_cast<double>(s0))) + 0x1p-12 * static_cast<double>(point.half_);
      wider = std::max(wider, (static_cast<double>(point.wide) - own) / static_cast<double>(prepared.ray.rounding));
    }
    fmt::print("{}: bounds of points {:.2f} times as wide as heights are off\n", named.name, wider);
    EXPECT_LE(wider, 1) << named.name;
  }
}

TEST(FunctionsInShaders, MarchesMatchWithinSinglePrecision) {
  const auto march = [](const Program& program, const DeviceFunctionRay& ray, std::string_view name,
                        const MarchSettings& settings, double slope) {
    if (name == "lipschitz-local")
      return glsl::scarp_lipschitz_local(*program, ray.ray,
                                         {static_cast<float>(settings.lipschitz_local.tolerance), 1024, kAll}, false);
    glsl::ScarpSampling sampling = device_sampling(find_function_march(name).sampling, settings, slope, 0x1p-20, 1);
    if (name == "fixed-step") sampling.factor = static_cast<float>(settings.function.step);
    return glsl::scarp_function_march(*program, ray.ray, sampling, kAll);
  };
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    const Program program(function.program(FunctionUse::march));
    const SingleRounding rounding(function.program(FunctionUse::march));
    FunctionRandom random(5);
    int hits = 0, exhausted = 0;
    std::uint64_t cost = 0, cpu_cost = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = random_ray(function, random);
      const auto prepared = device_function_ray(function, rounding, ray, FunctionUse::march, 1e30);
      for (const FunctionMarchEntry& entry : function_marches()) {
        const glsl::ScarpFunctionHit answer =
            prepared.marches ? march(program, prepared, entry.name, {}, function.bound_everywhere().slope)
                             : glsl::scarp_function_miss();
        const Hit hit = hit_from_device(ray, prepared, answer);
        const double delta = 4 * static_cast<double>(prepared.ray.rounding);
        ASSERT_EQ(function_objection(entry.name, {}, function, ray, delta, hit), "")
            << entry.name << " over " << named.name << ", ray " << i << ", delta " << delta;
        if (entry.name != "lipschitz-local") continue;
        hits += bool(hit), exhausted += hit.status == HitStatus::exhausted;
        cost += answer.bounds;
        MarchStats stats;
        entry.cpu(function, ray, {}, &stats, FunctionUse::march);
        cpu_cost += stats.steps;
      }
    }
    fmt::print("{}: {} hits, {} exhausted of {}; {:.1f} bounds a ray, {:.1f} in double\n", named.name, hits, exhausted,
               kRays, static_cast<double>(cost) / kRays, static_cast<double>(cpu_cost) / kRays);
    EXPECT_GE(hits, kRays / 4);
    EXPECT_LE(exhausted, kRays / 100);
  }
}

// As PassCloseToCreases of function_marches_test, within float precision of times: 1000 / 2^22.
TEST(FunctionsInShaders, PassCloseToCreases) {
  const HeightFunction ridge(make_function(Minimum{make_function(Plane{0, 0.1, 0}), make_function(Plane{0, -0.4, 0})}));
  const Program program(ridge.program(FunctionUse::march));
  const SingleRounding rounding(ridge.program(FunctionUse::march));
  for (const double above : {1e-2, 1e-4, -1e-4, -1e-2}) {
    const Ray ray{{-1000, 3, above}, {1, 0, 0}, 0, 2345};
    const auto prepared = device_function_ray(ridge, rounding, ray, FunctionUse::march, 1e30);
    for (const bool any : {false, true}) {
      const Hit hit =
          hit_from_device(ray, prepared, glsl::scarp_lipschitz_local(*program, prepared.ray, {1e-6f, 1024, kAll}, any));
      EXPECT_EQ(hit.status, above > 0 ? HitStatus::miss : HitStatus::hit) << above;
    }
  }
}

TEST(FunctionsInShaders, RaysEscapeTheSurface) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    const Program program(function.program(FunctionUse::march));
    const SingleRounding rounding(function.program(FunctionUse::march));
    FunctionRandom random(6);
    int judged = 0, left = 0;
    for (int i = 0; i < kRays; ++i) {
      Ray ray = random_ray(function, random);
      ray.origin.z = function.value(ray.origin.x, ray.origin.y);
      ray.direction.z = length(ray.direction) * random.between(-0.2, 0.8);
      ray.start = RayStart::on_surface;
      const auto prepared = device_function_ray(function, rounding, ray, FunctionUse::march, 1e30);
      if (!prepared.marches) continue;
      const Hit hit = hit_from_device(ray, prepared,
                                      glsl::scarp_lipschitz_local(*program, prepared.ray, {1e-6f, 1024, kAll}, false));
      // Once the ray is above or below the surface by more than rounding, it is judged as free.
      const double delta = 4 * static_cast<double>(prepared.ray.rounding), speed = length(ray.direction);
      Ray later = ray;
      later.start = RayStart::free;
      double h = 0;
      const dvec2 slope = function.gradient(ray.origin.x, ray.origin.y, FunctionUse::march);
      bool rises = ray.direction.z - dot(slope, dvec2(ray.direction)) > 0.1 * speed;
      for (double metres = delta; metres < 100 && std::abs(h) <= 2 * delta; metres *= 2) {
        later.t_min = metres / speed;
        const dvec3 p = later.at(later.t_min);
        h = p.z - function.value(p.x, p.y);
        rises = rises && h > 0.1 * metres;
      }
      if (std::abs(h) <= 2 * delta) continue;
      ++judged;
      const bool at_once = hit && hit.t <= later.t_min;
      if (h < 0) {
        EXPECT_TRUE(at_once) << named.name << ", ray " << i;
      } else if (at_once) {
        // Along the surface either answer is right; on the way out a hit is wrong.
        EXPECT_FALSE(rises) << named.name << ", ray " << i;
      } else {
        left += rises;
        EXPECT_EQ(function_objection("lipschitz-local", {}, function, later, 2 * delta, hit), "")
            << named.name << ", ray " << i;
      }
      if (HasFailure()) return;
    }
    fmt::print("{}: {} of {} rays from the surface judged, {} left it\n", named.name, judged, kRays, left);
    EXPECT_GE(judged, kRays / 2) << named.name;
    EXPECT_GE(left, kRays / 4) << named.name;
  }
}

TEST(FunctionsInShaders, RejectValuesBeyondFloatRange) {
  const Function high = make_function(Plane{0x1p29, 0, 0});
  const Function higher = make_function(Product{high, make_function(Product{high, high})});
  EXPECT_THROW(SingleRounding(compile(higher, FunctionUse::march)), Error);
}

}  // namespace
}  // namespace scarp::test
