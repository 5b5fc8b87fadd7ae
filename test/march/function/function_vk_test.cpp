// SPDX-License-Identifier: MIT
// Terrain functions on a Vulkan device: all their marches return what single precision allows (function_judge.h),
// any-hit agrees with closest-hit, and validation is silent.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "field/terrain_functions.h"
#include "march/function/function_judge.h"
#include "march/function/function_rays.h"
#include "march/steep_waves.h"
#include "scarp/march/function/device_function_ray.h"
#include "scarp/march/function/function_batch.glsl.h"
#include "scarp/march/function/function_queries_vk.h"
#include "scarp/march/function/function_sampling.h"
#include "scarp/march/function/presets.h"
#include "scarp/march/sampling/shrink_factor.h"
#include "vk/device_under_test.h"
#include "vk/spirv_layout.h"

namespace scarp::test {
namespace {

#ifdef NDEBUG
constexpr int kDeviceRays = 200;
#else
constexpr int kDeviceRays = 40;
#endif

class FunctionsOnDevice : public OnDevice {};

DeviceFunctionQueries& queries(const FunctionMarchEntry& march) {
  static std::map<std::string_view, DeviceFunctionQueries> all;
  const auto found = all.find(march.name);
  if (found != all.end()) return found->second;
  return all.emplace(march.name, DeviceFunctionQueries(*device_under_test().device, march, {}, {.rays_at_once = 256}))
      .first->second;
}

TEST_F(FunctionsOnDevice, MarchesMatchWithinSinglePrecision) {
  const std::vector<NamedFunction> functions = terrain_functions();
  for (std::size_t f = 0; f < functions.size(); f += 3) {
    const NamedFunction& named = functions[f];
    const HeightFunction function(named.function);
    const DeviceFunction on_device(device(), function);
    const DeviceFunctionTarget target{&function, &on_device};
    FunctionRandom random(21);
    std::vector<Ray> rays;
    for (int i = 0; i < kDeviceRays; ++i) rays.push_back(random_ray(function, random));
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint32_t> steps(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    for (const FunctionMarchEntry& march : function_marches()) {
      ASSERT_TRUE(march.gpu) << march.name;
      if (march.name != "lipschitz-local" && f > 0) continue;
      queries(march).closest_hits(target, rays, hits, steps);
      queries(march).occluded(target, rays, blocked);
      int met = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto prepared =
            device_function_ray(function, on_device.rounding(FunctionUse::march), rays[i], FunctionUse::march, 1e30);
        EXPECT_EQ(function_objection(march.name, {}, function, rays[i], 4 * static_cast<double>(prepared.ray.rounding),
                                     hits[i]),
                  "")
            << march.name << " over " << named.name << ", ray " << i;
        EXPECT_EQ(blocked[i], static_cast<bool>(hits[i])) << march.name << " over " << named.name << ", ray " << i;
        met += bool(hits[i]);
        if (HasFailure()) return;
      }
      EXPECT_GE(met, kDeviceRays / 8) << march.name << " over " << named.name;
    }
  }
}

// Invocations share a vector and its loop iterations, and reach their last evaluations at different steps: tests the
// longest program, and the largest number of these evaluations.
TEST_F(FunctionsOnDevice, RaysDoNotAffectNeighbours) {
  const int kTogether = cases(16, 16, 4);
  Fractal fractal{.damping = 0.1, .octaves = {kMostOctaves, kMostOctaves, kMostOctaves}};
  Function sum = make_function(fractal);
  while (true) {
    ++fractal.seed;
    const Function more = make_function(Sum{sum, make_function(fractal)});
    if (HeightFunction(more).program(FunctionUse::march).code.size() > glsl::kScarpMostInstructions) break;
    sum = more;
  }
  const HeightFunction function(sum);
  const DeviceFunction on_device(device(), function);
  const DeviceFunctionTarget target{&function, &on_device};
  FunctionRandom random(22);
  std::vector<Ray> rays;
  for (int i = 0; i < kTogether; ++i) rays.push_back(random_ray(function, random));
  MarchSettings settings;
  settings.sampling.refinement = Refinement::bisect;
  settings.sampling.halvings = 60;
  for (const FunctionMarchEntry& march : function_marches()) {
    DeviceFunctionQueries together(device(), march, settings), alone(device(), march, settings, {.rays_at_once = 1});
    std::vector<Hit> hits(rays.size()), other(rays.size());
    together.closest_hits(target, rays, hits);
    alone.closest_hits(target, rays, other);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(hits[i].status, other[i].status) << march.name << ", ray " << i;
      EXPECT_EQ(hits[i].t, other[i].t) << march.name << ", ray " << i;
    }
  }
}

// castle stops within a millimetre of the ground, which is less than the error of a float: its rays to the sun start
// there.
TEST_F(FunctionsOnDevice, RaysFromTheSurfaceEscape) {
  const HeightFunction hills(make_function(Fractal{.wavelength = 200, .height = 20, .octaves = {3, 3, 3}}));
  const DeviceFunction on_device(device(), hills);
  const DeviceFunctionTarget target{&hills, &on_device};
  const MarchPreset& castle = find_march_preset("castle");
  std::vector<Ray> to_sun;
  for (int i = 0; i < 100; ++i) {
    const Ray down{{17.0 * i, 5.0 * i, 100}, {0.3, 0.1, -1}, 0, 400};
    const Hit hit = find_function_march("lipschitz-local").cpu(hills, down, {}, nullptr, FunctionUse::march);
    ASSERT_TRUE(hit);
    to_sun.push_back({.origin = down.at(hit.t), .direction = {0.1, 0, 1}, .t_max = 300, .start = RayStart::on_surface});
  }
  std::vector<std::uint8_t> blocked(to_sun.size());
  DeviceFunctionQueries(device(), find_function_march(castle.march), castle.settings).occluded(target, to_sun, blocked);
  EXPECT_EQ(std::count(blocked.begin(), blocked.end(), 1), 0);
}

TEST_F(FunctionsOnDevice, HitBelowGroundWithALargeShrinkFactor) {
  const HeightFunction function(endless_waves());
  const DeviceFunction on_device(device(), function);
  MarchSettings settings;
  settings.lipschitz.shrink = 0.7;
  const std::vector<Ray> rays = rays_over_waves(500);
  std::vector<Hit> hits(rays.size());
  DeviceFunctionQueries& lipschitz = queries(find_function_march("lipschitz"));
  lipschitz.set_march_settings(settings);
  lipschitz.closest_hits({&function, &on_device}, rays, hits);
  lipschitz.set_march_settings({});
  int same = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(hits[i]);
    same += std::abs(hits[i].t - march_lipschitz(function, rays[i], settings).t) < 1e-3;
  }
  EXPECT_GT(same, 475);
}

TEST_F(FunctionsOnDevice, ReportErrors) {
  FunctionMarchEntry unknown = find_function_march("naive");
  unknown.name = "max-mip";
  EXPECT_EQ(test::refusal([&] { DeviceFunctionQueries(device(), unknown); }),
            "march 'max-mip': does not run over functions on Vulkan devices (available: naive, fixed-step, relaxed, "
            "lipschitz, lipschitz-local)");
  const HeightFunction plane(make_function(Plane{5}));
  const DeviceFunction on_device(device(), plane);
  std::vector<Ray> rays(2);
  std::vector<Hit> hits(1);
  EXPECT_EQ(test::refusal([&] {
              queries(find_function_march("lipschitz-local")).closest_hits({&plane, &on_device}, rays, hits);
            }),
            "batch: 2 rays, room for 1 answers and 0 costs");
}

constexpr std::uint32_t kShader[] = {
#include "scarp/march/function/lipschitz_local.comp.inc"
};

TEST(FunctionBatchLayout, MatchesTheShaders) {
  using glsl::ScarpMarchState, glsl::ScarpFunctionRay, glsl::ScarpFunctionHit, glsl::FunctionBatch,
      glsl::ScarpInstruction;
  EXPECT_TRUE(has_struct(kShader, {offsetof(ScarpFunctionRay, origin), offsetof(ScarpFunctionRay, origin_low),
                                   offsetof(ScarpFunctionRay, direction), offsetof(ScarpFunctionRay, direction_low),
                                   offsetof(ScarpFunctionRay, exit), offsetof(ScarpFunctionRay, travelled),
                                   offsetof(ScarpFunctionRay, speed), offsetof(ScarpFunctionRay, rounding),
                                   offsetof(ScarpFunctionRay, flags), offsetof(ScarpFunctionRay, state)}));
  EXPECT_TRUE(has_array_stride(kShader, sizeof(ScarpFunctionRay)));
  EXPECT_TRUE(has_struct(kShader, {offsetof(ScarpFunctionHit, status), offsetof(ScarpFunctionHit, time),
                                   offsetof(ScarpFunctionHit, bounds), offsetof(ScarpFunctionHit, heights),
                                   offsetof(ScarpFunctionHit, state)}));
  EXPECT_TRUE(has_struct(
      kShader, {offsetof(ScarpMarchState, s), offsetof(ScarpMarchState, before), offsetof(ScarpMarchState, h_before),
                offsetof(ScarpMarchState, steps), offsetof(ScarpMarchState, phase)}));
  EXPECT_TRUE(has_array_stride(kShader, sizeof(ScarpFunctionHit)));
  EXPECT_TRUE(has_struct(
      kShader, {offsetof(FunctionBatch, code), offsetof(FunctionBatch, rays), offsetof(FunctionBatch, hits),
                offsetof(FunctionBatch, count), offsetof(FunctionBatch, instructions), offsetof(FunctionBatch, result),
                offsetof(FunctionBatch, settings), offsetof(FunctionBatch, run_steps)}));
  using glsl::ScarpSampling;
  EXPECT_TRUE(has_struct(
      kShader,
      {offsetof(ScarpSampling, march), offsetof(ScarpSampling, factor), offsetof(ScarpSampling, least),
       offsetof(ScarpSampling, tolerance), offsetof(ScarpSampling, height), offsetof(ScarpSampling, max_steps),
       offsetof(ScarpSampling, refinement), offsetof(ScarpSampling, halvings), offsetof(ScarpSampling, proven)}));
  EXPECT_TRUE(has_array_stride(kShader, sizeof(ScarpInstruction)));
  EXPECT_EQ(sizeof(ScarpInstruction), 64u);
}

TEST(FunctionBatchLayout, ConstantsMatchTheShaders) {
  EXPECT_EQ(glsl::kScarpRadial, static_cast<std::uint32_t>(FunctionOp::radial));
  EXPECT_EQ(glsl::kScarpNoiseSlope, static_cast<std::uint32_t>(FunctionOp::noise_slope));
  EXPECT_EQ(glsl::kScarpReciprocal, static_cast<std::uint32_t>(FunctionOp::reciprocal));
  EXPECT_EQ(glsl::kScarpSimplexNoise, static_cast<std::uint32_t>(NoiseKind::simplex));
  EXPECT_EQ(glsl::kScarpRegisters, kFunctionRegisters);
}

}  // namespace
}  // namespace scarp::test
