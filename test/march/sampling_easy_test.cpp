// SPDX-License-Identifier: MIT
// The easy texts of naive, fixed-step, relaxed and lipschitz, as C++, against the CPU's marches over the same
// functions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "cases.h"
#include "field/terrain_functions.h"
#include "march/function/function_rays.h"
#include "march/sampling_easy_judge.h"
#include "scarp/march/function/function_ray.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/march_state.glsl.h"
#include "scarp/vk/glsl_cpp.h"

namespace scarp::glsl {

static const HeightFunction* host_ground = nullptr;
float scarp_ground(vec2 p) { return static_cast<float>(host_ground->value(double{p.x}, double{p.y})); }

// The texts, with `float&` for `out float` and float literals (test/march/CMakeLists.txt).
#include "easy/fixed_step.h"
#include "easy/lipschitz.h"
#include "easy/naive.h"
#include "easy/relaxed.h"

}  // namespace scarp::glsl

namespace scarp::test {
namespace {

const int kRays = cases(10'000, 1'000, 200);

// Runs a text with the numbers of `settings`.
int run_text(std::string_view march, const MarchSettings& settings, double slope, const Ray& ray, float& t) {
  const auto number = [](double value) { return static_cast<float>(value); };
  const glsl::vec3 o(ray.origin), d(ray.direction);
  const float t_max = number(ray.t_max);
  if (march == "naive") {
    const NaiveSettings& s = settings.naive;
    return glsl::scarp_naive(o, d, t_max, number(s.step_factor), number(s.min_step), number(s.tolerance), s.max_steps,
                             t);
  }
  if (march == "relaxed") {
    const RelaxedSettings& s = settings.relaxed;
    return glsl::scarp_relaxed(o, d, t_max, number(s.step_factor), number(s.tolerance), s.max_steps, t);
  }
  if (march == "lipschitz") {
    const LipschitzSettings& s = settings.lipschitz;
    return glsl::scarp_lipschitz(o, d, t_max, number(slope), number(s.tolerance), s.max_steps, t);
  }
  return glsl::scarp_fixed_step(o, d, t_max, number(settings.function.step), settings.fixed_step.max_steps, t);
}

int status_of(const Hit& hit) {
  switch (hit.status) {
    case HitStatus::hit:
      return glsl::kScarpHit;
    case HitStatus::below:
      return glsl::kScarpBelow;
    case HitStatus::exhausted:
      return glsl::kScarpExhausted;
    case HitStatus::miss:
    case HitStatus::invalid:
      break;
  }
  return glsl::kScarpMiss;
}

// A ray of floats within the height range of the ground, which the texts do not know. One in 16 starts below the
// ground.
Ray float_ray(const HeightFunction& function, FunctionRandom& random, int i) {
  Ray ray = random_ray(function, random);
  const FunctionBound& all = function.bound_everywhere();
  if (i % 16 == 0) ray.origin.z = function.value(ray.origin.x, ray.origin.y) - random.between(0.01, 20);
  ray.origin = dvec3(glm::vec3(ray.origin.x, ray.origin.y, std::clamp(ray.origin.z, all.low, all.high)));
  ray.direction = dvec3(glm::vec3(ray.direction));
  const FunctionRay part(function, ray, FunctionUse::march, 1e30, FunctionRay::Unrounded{});
  ray.t_max = double{std::nextafter(static_cast<float>(part.t_exit), 0.0f)};
  return ray;
}

struct NamedGround {
  std::string name;
  Function function;
};

// "hills" of `scarp render --function`, waves, ridges with creases, and terraces.
std::vector<NamedGround> grounds() {
  std::vector<NamedGround> all{{"hills", make_function(Fractal{.wavelength = 1600, .height = 320, .gain = 0.45})}};
  for (const NamedFunction& named : terrain_functions()) {
    if (named.name == "sines" || named.name == "simplex ridged" || named.name == "terraces")
      all.push_back({named.name, named.function});
  }
  return all;
}

class EasySampling : public testing::TestWithParam<std::string> {};

TEST_P(EasySampling, MatchesTheCpu) {
  const std::string& march = GetParam();
  const MarchSettings settings;
  for (const NamedGround& ground : grounds()) {
    const HeightFunction function(ground.function);
    glsl::host_ground = &function;
    FunctionRandom random(11);
    int counts[4] = {}, several = 0, lost = 0;
    double worst = 0, wide = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = float_ray(function, random, i);
      const EasyAnswers answers = easy_answers(march, settings, function, ray);
      // The judge follows the rule of the CPU.
      const Hit hit = find_function_march(march).cpu(function, ray, settings, nullptr, FunctionUse::march);
      const bool timed = hit || hit.status == HitStatus::exhausted;
      if (!answers.lost) {
        ASSERT_EQ(status_of(hit), answers.exact.status) << march << " over " << ground.name << ", ray " << i;
        if (timed) {
          // A thousandth of the bound below: rounding of the judge itself decides nothing.
          ASSERT_LE(std::abs(hit.t - answers.exact.t), 0x1p-10 * answers.exact.off)
              << march << " over " << ground.name << ", ray " << i;
        }
      }
      float t = 0;
      const int status = run_text(march, settings, function.bound_everywhere().slope, ray, t);
      ASSERT_EQ(answers.objection(status, double{t}), "") << march << " over " << ground.name << ", ray " << i;
      // The points of fixed-step are known beforehand.
      if (status == glsl::kScarpHit && march != "fixed-step") {
        ASSERT_TRUE(may_hit_at(march, settings, function, ray, double{t})) << "ray " << i;
      }
      ++counts[status];
      lost += answers.lost;
      if (answers.lost || answers.allowed.size() != 1) {
        ++several;
      } else if (timed) {
        worst = std::max(worst, std::abs(double{t} - hit.t) / answers.allowed[0].off);
        wide += answers.allowed[0].off / ray.t_max / kRays;
      }
    }
    fmt::print(
        "{} over {}: {} miss, {} hit, {} below, {} exhausted; {} with several answers, {} of them not followed; "
        "t within {:.2g} of the range on average, {:.2f} of its bound seen\n",
        march, ground.name, counts[0], counts[1], counts[2], counts[3], several, lost, wide, worst);
    EXPECT_GE(counts[glsl::kScarpHit], kRays / 8) << ground.name;
    // The bounds must decide most rays. Rays close to the ground, where the tolerance is not larger than rounding,
    // may decide either way.
    EXPECT_LE(several, kRays / 6) << ground.name;
    EXPECT_LE(lost, kRays / 50) << ground.name;
  }
}

// A ray over a plane at height 0, with a direction that is not a unit vector.
int over_plane(std::string_view march, const MarchSettings& settings, double height, double fall, float& t) {
  const HeightFunction plane(make_function(Plane{}));
  glsl::host_ground = &plane;
  return run_text(march, settings, 0, {{3, 5, height}, {3, 4, -fall}, 0, 100}, t);
}

TEST_P(EasySampling, ReportsEachStatus) {
  const std::string& march = GetParam();
  MarchSettings settings;
  float t = 0;
  EXPECT_EQ(over_plane(march, settings, 40, 0, t), glsl::kScarpMiss);
  EXPECT_EQ(over_plane(march, settings, 40, 1, t), glsl::kScarpHit);
  // The ray crosses the plane at t = 40. Marches with a tolerance stop where the clearance, (40 - t) / |direction|, is
  // within that fraction of t. No float on the way to t has more than 12 roundings: stride, count, point and quotient.
  const double tolerance = march == "naive"       ? settings.naive.tolerance
                           : march == "relaxed"   ? settings.relaxed.tolerance
                           : march == "lipschitz" ? settings.lipschitz.tolerance
                                                  : 0;
  const double rounding = 12 * 0x1p-24 * 40;
  EXPECT_LE(t, 40 + rounding);
  EXPECT_GE(t, 40 - tolerance * 40 * std::sqrt(26.0) - rounding);
  const bool hits_at_start = march == "naive";
  EXPECT_EQ(over_plane(march, settings, -1, 0, t), hits_at_start ? glsl::kScarpHit : glsl::kScarpBelow);
  settings.naive.max_steps = settings.relaxed.max_steps = settings.lipschitz.max_steps = 3;
  settings.fixed_step.max_steps = 3;
  EXPECT_EQ(over_plane(march, settings, 40, 1, t), glsl::kScarpExhausted);
  EXPECT_GT(t, 0);
}

// Steps of the full height, as for flat ground, lead below a slope.
TEST(EasyLipschitz, IsExhaustedBelowGroundSteeperThanItsSlope) {
  const HeightFunction steep(make_function(Plane{0, 2, 0}));
  glsl::host_ground = &steep;
  const Ray ray{{-50, 0, 30}, {1, 0, 0}, 0, 1000};
  float t = 0;
  EXPECT_EQ(run_text("lipschitz", {}, 0, ray, t), glsl::kScarpExhausted);
  EXPECT_GT(t, 65);  // where the ray crosses the ground
  EXPECT_EQ(run_text("lipschitz", {}, 2, ray, t), glsl::kScarpHit);
  EXPECT_LE(t, 65);
}

// For pasting: no preprocessor, no literal suffixes, nothing that a reader does not know.
TEST_P(EasySampling, SourceIsShortAndSelfContained) {
  std::string name = GetParam();
  std::replace(name.begin(), name.end(), '-', '_');
  std::ifstream file(SCARP_SOURCE_DIR "/scarp/march/sampling/" + name + "_easy.glsl");
  int lines = 0;
  for (std::string line; std::getline(file, line); ++lines) {
    EXPECT_NE(line.substr(0, 1), "#");
    EXPECT_EQ(line.find("SCARP_"), std::string::npos) << line;
    EXPECT_EQ(line.find(".0f"), std::string::npos) << line;
  }
  EXPECT_GE(lines, 30);
  EXPECT_LE(lines, 60);
}

INSTANTIATE_TEST_SUITE_P(Marches, EasySampling, testing::Values("naive", "fixed-step", "relaxed", "lipschitz"),
                         [](const auto& march) {
                           std::string name = march.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace scarp::test
