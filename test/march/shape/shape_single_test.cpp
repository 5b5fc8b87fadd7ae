// SPDX-License-Identifier: MIT
// Distance fields in single precision: the shader text, compiled as C++, against doubles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "march/shape/shape_judge.h"
#include "scarp/accel/function_words.h"
#include "scarp/accel/shape_words.h"
#include "scarp/base/error.h"
#include "scarp/march/function/device_function_ray.h"
#include "scarp/march/function/function_heights.glsl.h"
#include "scarp/march/shape/shape_grounds.glsl.h"
#include "scarp/march/shape/sphere_trace.glsl.h"

namespace scarp::glsl {

static const ShapeWords* host_shape = nullptr;
static const DistanceProgram* host_program = nullptr;
static std::vector<std::vector<ScarpInstruction>> host_functions;
static std::size_t host_function = 0;
static const HeightField *host_field = nullptr, *host_holes = nullptr;
ScarpShapeInstruction scarp_shape_instruction(uint i) { return host_shape->code[i]; }
float scarp_shape_number(uint i) { return host_shape->numbers[i]; }
bool scarp_shape_uses(uint) { return true; }

ScarpInstruction scarp_instruction(uint i) { return host_functions[host_function][i]; }
bool scarp_uses(uint) { return true; }
float scarp_field_sample(int col, int row) {
  return host_field->visit([&](const auto& grid) { return static_cast<float>(grid.at(col, row)); });
}
bool scarp_field_hole(int col, int row) { return !host_holes->cell_heights({col, row}); }

float scarp_shape_function(uint index, float x, float y) {
  host_function = index;
  const FunctionProgram& program = host_program->functions[index]->program(FunctionUse::march);
  return scarp_height({static_cast<uint>(program.code.size()), program.result}, scarp_two(x), scarp_two(y)).high;
}
float scarp_shape_field(uint index, vec3 q, float shrink) {
  const std::size_t i = index - host_program->functions.size();
  host_field = host_program->fields[i].get();
  host_holes = host_program->holes[i].get();
  const HeightFieldSettings& s = host_field->settings();
  const ScarpSolidField field{{host_field->cell_cols(), host_field->cell_rows()},
                              {host_field->cols(), host_field->rows()},
                              static_cast<float>(s.cell_x),
                              static_cast<float>(s.cell_y),
                              static_cast<float>(s.scale * s.exaggeration),
                              static_cast<float>(host_field->height_from_sample(0)),
                              s.surface == Surface::triangles,
                              host_field->wraps(),
                              host_holes != nullptr};
  return scarp_field_ground(field, q, shrink);
}

}  // namespace scarp::glsl

namespace scarp::test {
namespace {

#ifdef NDEBUG
constexpr int kPositions = 5'000, kRays = 2'000;
#else
constexpr int kPositions = 200, kRays = 20;
#endif

glsl::ScarpSphereTrace settings(const ShapeSingleRounding& rounding) {
  return {1e-6f, 1024, 1 << 30, static_cast<float>(shape_ray_growth(rounding))};
}
// Largest error along a ray.
double most_off(const ShapeSingleRounding& rounding, const glsl::ScarpFunctionRay& ray) {
  return static_cast<double>(ray.rounding) +
         shape_ray_growth(rounding) * static_cast<double>(ray.speed) * static_cast<double>(ray.exit);
}

std::uint32_t use(const ShapeWords& words, const DistanceProgram& program) {
  glsl::host_shape = &words;
  glsl::host_program = &program;
  glsl::host_functions.clear();
  for (const auto& function : program.functions)
    glsl::host_functions.push_back(function_words(function->program(FunctionUse::march)));
  return static_cast<std::uint32_t>(words.code.size());
}

void expect_values(const std::string& name, const Shape& shape, FunctionRandom& random, double& worst) {
  const DistanceField field(shape);
  const ShapeWords words = shape_words(field.program());
  const std::uint32_t count = use(words, field.program());
  const ShapeSingleRounding rounding(field);
  for (int i = 0; i < kPositions; ++i) {
    const double reach = std::exp2(random.between(-1, 10));
    const glsl::vec3 p(static_cast<float>(random.between(-reach, reach)),
                       static_cast<float>(random.between(-reach, reach)),
                       static_cast<float>(random.between(-reach, reach)));
    const double off = std::abs(static_cast<double>(glsl::scarp_shape_distance(count, p)) - field.value(dvec3(p)));
    const double bound = rounding.at(length(dvec3(p)));
    ASSERT_LE(off, bound) << name;
    worst = std::max(worst, off / bound);
  }
}

TEST(ShapesInShaders, ValuesStayWithinTheirBound) {
  FunctionRandom random(1);
  double worst = 0;
  for (const NamedShape& named : shape_zoo()) expect_values(named.name, named.shape, random, worst);
  for (int i = 0; i < kPositions / 50; ++i) {
    expect_values(fmt::format("random shape {}", i), random_shape(random, 4, true), random, worst);
    if (HasFailure()) return;
  }
  fmt::print("values off by at most {:.2f} of the bound\n", worst);
}

TEST(ShapesInShaders, MarchesMatchWithinSinglePrecision) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    const ShapeWords words = shape_words(field.program());
    const std::uint32_t count = use(words, field.program());
    const ShapeSingleRounding rounding(field);
    FunctionRandom random(2);
    int hits = 0, exhausted = 0, below = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = shape_ray(random);
      const auto prepared = device_shape_ray(field, rounding, ray);
      const auto march = [&](bool any) {
        return prepared.marches ? glsl::scarp_sphere_trace(count, prepared.ray, settings(rounding), any)
                                : glsl::scarp_function_miss();
      };
      const Hit hit = hit_from_device(ray, prepared, march(false));
      const double delta = 4 * most_off(rounding, prepared.ray);
      ASSERT_EQ(shape_objection(field, ray, delta, hit), "") << named.name << ", ray " << i;
      ASSERT_EQ(march(true).status == glsl::kScarpFunctionHit, bool(hit)) << named.name << ", ray " << i;
      hits += bool(hit), exhausted += hit.status == HitStatus::exhausted, below += hit.status == HitStatus::below;
    }
    fmt::print("{}: {} hits, {} below, {} exhausted of {}\n", named.name, hits, below, exhausted, kRays);
    EXPECT_GE(hits, kRays / 20) << named.name;
    EXPECT_LE(exhausted, kRays / 50) << named.name;
  }
}

TEST(ShapesInShaders, RaysEscapeTheSurface) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    const ShapeWords words = shape_words(field.program());
    const std::uint32_t count = use(words, field.program());
    const ShapeSingleRounding rounding(field);
    FunctionRandom random(3);
    int left = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray seen = shape_ray(random);
      const Hit at = march_sphere_trace(field, seen);
      if (!at) continue;
      Ray ray;
      ray.origin = seen.at(at.t);
      const dvec3 normal = field.normal(ray.origin);
      ray.direction =
          normal + 0.9 * normalize(dvec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
      ray.t_max = 100;
      ray.start = RayStart::on_surface;
      const auto prepared = device_shape_ray(field, rounding, ray);
      const double r = most_off(rounding, prepared.ray);
      // Outside the shape's box, hence outside the shape.
      if (!prepared.marches) {
        ++left;
        continue;
      }
      // At a concave edge it may enter the solid at once.
      bool leaves = true;
      for (double metres = r; metres < 64 * r; metres *= 2)
        leaves = leaves && field.value(ray.at(metres / length(ray.direction))) > 0.1 * metres;
      if (!leaves) continue;
      ++left;
      const Hit hit =
          hit_from_device(ray, prepared, glsl::scarp_sphere_trace(count, prepared.ray, settings(rounding), false));
      Ray later = ray;
      later.start = RayStart::free;
      later.t_min = 32 * r / length(ray.direction);
      ASSERT_TRUE(!hit || hit.t > later.t_min) << named.name << ", ray " << i << " hits where it begins";
      ASSERT_EQ(shape_objection(field, later, 4 * r, hit), "") << named.name << ", ray " << i;
    }
    EXPECT_GE(left, kRays / 50) << named.name;
  }
}

}  // namespace
}  // namespace scarp::test
