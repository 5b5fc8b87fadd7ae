// SPDX-License-Identifier: MIT
// Distance fields on a Vulkan device: `sphere-trace` returns what single precision allows (shape_judge.h), any-hit
// agrees with closest-hit, and validation is silent.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "march/shape/shape_judge.h"
#include "scarp/base/error.h"
#include "scarp/march/function/device_function_ray.h"
#include "scarp/march/shape/shape_batch.glsl.h"
#include "scarp/march/shape/shape_queries_vk.h"
#include "vk/device_under_test.h"
#include "vk/spirv_layout.h"

namespace scarp::test {
namespace {

#ifdef NDEBUG
constexpr int kShapeRays = 500;
#else
constexpr int kShapeRays = 60;
#endif

// Compiling a shader for lavapipe takes longer than tracing its rays: shape_single_test covers all shapes.
bool is_one_of(const std::string& name) {
  for (const char* one : {"turned box", "cone", "scaled, moved torus", "intersection", "smooth subtraction", "lattice",
                          "touching lattice of bounds", "forty solids", "quarry with holes", "cave"}) {
    if (name == one) return true;
  }
  return false;
}

class ShapesOnDevice : public OnDevice {};

TEST_F(ShapesOnDevice, MarchesMatchWithinSinglePrecision) {
  DeviceShapeQueries queries(device(), find_shape_march("sphere-trace"), {}, {.rays_at_once = 256});
  int shapes = 0;
  for (const NamedShape& named : shape_zoo()) {
    if (!is_one_of(named.name)) continue;
    ++shapes;
    const DistanceField field(named.shape);
    const DeviceShape on_device(device(), field);
    FunctionRandom random(11);
    std::vector<Ray> rays;
    for (int i = 0; i < kShapeRays; ++i) rays.push_back(shape_ray(random));
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint32_t> steps(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    queries.closest_hits({&field, &on_device}, rays, hits, steps);
    queries.occluded({&field, &on_device}, rays, blocked);
    std::size_t met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glsl::ScarpFunctionRay ray = device_shape_ray(field, on_device.rounding(), rays[i]).ray;
      const double delta = 4 * (static_cast<double>(ray.rounding) +
                                shape_ray_growth(on_device.rounding()) * static_cast<double>(ray.speed * ray.exit));
      EXPECT_EQ(shape_objection(field, rays[i], delta, hits[i]), "") << named.name << ", ray " << i;
      EXPECT_EQ(blocked[i], static_cast<bool>(hits[i])) << named.name << ", ray " << i;
      EXPECT_GE(steps[i], static_cast<std::uint32_t>(hits[i] ? 1 : 0));
      met += static_cast<bool>(hits[i]);
      if (HasFailure()) return;
    }
    EXPECT_GE(met, rays.size() / 40) << named.name;
  }
  EXPECT_EQ(shapes, 10);
}

TEST_F(ShapesOnDevice, RejectShapesThatTakeTooLong) {
  const auto function = std::make_shared<HeightFunction>(make_function(Fractal{.octaves = {24, 24, 24}}));
  std::vector<Shape> grounds;
  for (int i = 0; i < 100; ++i)
    grounds.push_back(make_shape(shape::Moved{make_shape(shape::FunctionGround{function}), {0, 0, -i}}));
  const DistanceField shape(make_shape(shape::Union{grounds}));
  try {
    DeviceShape(device(), shape);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("those of its functions included"), std::string::npos) << error.what();
  }
}

constexpr std::uint32_t kShapeShader[] = {
#include "scarp/march/shape/sphere_trace.comp.inc"
};

TEST(ShapeBatchLayout, MatchesTheShaders) {
  using glsl::ShapeBatch, glsl::ScarpShapeInstruction;
  EXPECT_TRUE(has_struct(
      kShapeShader, {offsetof(ShapeBatch, code), offsetof(ShapeBatch, numbers), offsetof(ShapeBatch, grounds),
                     offsetof(ShapeBatch, rays), offsetof(ShapeBatch, hits), offsetof(ShapeBatch, count),
                     offsetof(ShapeBatch, instructions), offsetof(ShapeBatch, tolerance),
                     offsetof(ShapeBatch, max_steps), offsetof(ShapeBatch, run_steps), offsetof(ShapeBatch, growth)}));
  using glsl::ScarpShapeGround;
  EXPECT_TRUE(has_struct(kShapeShader, {offsetof(ScarpShapeGround, data), offsetof(ScarpShapeGround, holes),
                                        offsetof(ScarpShapeGround, count), offsetof(ScarpShapeGround, result),
                                        offsetof(ScarpShapeGround, has_holes), offsetof(ScarpShapeGround, none)}));
  EXPECT_TRUE(has_array_stride(kShapeShader, sizeof(ScarpShapeGround)));
  EXPECT_TRUE(has_array_stride(kShapeShader, sizeof(ScarpShapeInstruction)));
  EXPECT_EQ(sizeof(ScarpShapeInstruction), 32u);
}

TEST(ShapeBatchLayout, ConstantsMatchTheShaders) {
  EXPECT_EQ(glsl::kScarpShapeEllipsoid, static_cast<std::uint32_t>(DistanceOp::ellipsoid));
  EXPECT_EQ(glsl::kScarpShapeFieldGround, static_cast<std::uint32_t>(DistanceOp::field_ground));
  EXPECT_EQ(glsl::kScarpShapeUnite, static_cast<std::uint32_t>(DistanceOp::unite));
  EXPECT_EQ(glsl::kScarpShapeSmoothSubtract, static_cast<std::uint32_t>(DistanceOp::smooth_subtract));
  EXPECT_EQ(glsl::kScarpShapeSkipCopy, static_cast<std::uint32_t>(DistanceOp::skip_copy));
  EXPECT_EQ(glsl::kScarpShapeRegisters, kDistancePositions);
  EXPECT_EQ(glsl::kScarpShapeRegisters, kDistanceValues);
}

}  // namespace
}  // namespace scarp::test
