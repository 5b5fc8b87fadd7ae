// SPDX-License-Identifier: MIT
// How far rounding can take a sampling march in single precision from the same march in double.
//
//   double   x0 ──▶ x1 ──▶ x2 ──▶ hit      x' = x + factor * h(x): an error e of a position becomes e |1 + factor h'|,
//   single   x0' ─▶ x1' ─▶ x2' ─▶ hit'     plus the rounding of one step
//
// As long as no test of the march is within that error of its limit, both take the same decisions, and their hits
// differ by no more than the error of the last position. Rays of which a test is closer are not judged.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "march/height/shader_ray.h"
#include "march/height/spiteful_text.h"
#include "scarp/base/march_trace.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/height_table.h"

namespace scarp::test {

struct SampledTwin {
  Hit hit;              ///< in double
  bool certain = true;  ///< rounding changes no decision
  double off = 0;       ///< bound on the distance between both hits, in metres along the ray
};

/// Follows a ray from t = 0 and its march in double, over bilinear ground without holes or wrap, with cells as wide as
/// a unit of height. The ray starts above the ground, its numbers are floats, and it is not parallel to an axis.
class TwinOfMarch {
 public:
  TwinOfMarch(const HeightTarget& target, std::string_view march, const MarchSettings& settings, const Ray& ray)
      : field_(*target.field), march_(march), settings_(settings), ray_(field_.grid_from_world(ray)) {
    MarchTrace trace;
    twin_.hit = find_height_march(march).traced(target, ray, settings, nullptr, trace);
    metres_per_t_ = length(ray.direction);
    steepness_ = std::hypot(1.0, target.slope) + 1;
    span();
    if (exit_ > enter_) follow(trace, target.slope);
  }
  const SampledTwin& twin() const { return twin_; }

 private:
  static constexpr double kUnit = 0x1p-24;

  // The part of the ray over the field, in metres, and the rounding of its ends: of a difference to the border, divided
  // by the component of the direction; and of points on the ray. A device divides with an error of 5 units.
  void span() {
    double scale = 0, slowest = 1;
    enter_ = 0, exit_ = HUGE_VAL;
    const int cells[] = {field_.cell_cols(), field_.cell_rows()};
    for (int axis = 0; axis < 3; ++axis) {
      scale = std::max(scale, std::abs(ray_.origin[axis]));
      if (axis == 2) break;
      const double d = ray_.direction[axis] / metres_per_t_;
      const double a = -ray_.origin[axis] / d, b = (cells[axis] - ray_.origin[axis]) / d;
      enter_ = std::max(enter_, std::min(a, b)), exit_ = std::min(exit_, std::max(a, b));
      slowest = std::min(slowest, std::abs(d));
    }
    scale += std::max(cells[0], cells[1]);
    end_error_ = kUnit * (16 * exit_ + 4 * scale / slowest);
    point_error_ = kUnit * (4 * scale + 16 * exit_);
  }

  // Bounds of the clearance's change per metre within the cells that the ray may be over.
  double growth(double x, double error, double factor) const {
    double most = 0;
    for (const double at : {x - error, x, x + error}) {
      const double t = std::clamp(at, enter_, exit_) / metres_per_t_;
      const Cell cell{std::clamp(static_cast<int>(ray_.origin.x + ray_.direction.x * t), 0, field_.cell_cols() - 1),
                      std::clamp(static_cast<int>(ray_.origin.y + ray_.direction.y * t), 0, field_.cell_rows() - 1)};
      const CellHeights h = *field_.cell_heights(cell);
      for (const double east : {h.h10 - h.h00, h.h11 - h.h01}) {
        for (const double south : {h.h01 - h.h00, h.h11 - h.h10}) {
          const double per_t = ray_.direction.z - east * ray_.direction.x - south * ray_.direction.y;
          most = std::max(most, std::abs(1 + factor * per_t / metres_per_t_));
        }
      }
    }
    return most;
  }

  void decide(double gap, double error) { twin_.certain = twin_.certain && std::abs(gap) > error; }

  void follow(const MarchTrace& trace, double slope) {
    const bool naive = march_ == "naive", relaxed = march_ == "relaxed", fixed = march_ == "fixed-step";
    const double shrink = 1 / std::hypot(1.0, slope);
    const double factor = naive ? settings_.naive.step_factor : relaxed ? settings_.relaxed.step_factor : shrink;
    const double tolerance = naive     ? settings_.naive.tolerance
                             : relaxed ? settings_.relaxed.tolerance
                             : fixed   ? 0
                                       : settings_.lipschitz.tolerance / shrink;
    const double least = naive ? settings_.naive.min_step * exit_ : 0;
    double e = (enter_ > 0 ? end_error_ : 0) + 8 * kUnit * exit_, before = HUGE_VAL, x = enter_;
    for (const TraceStep& step : trace.steps) {
      if (step.kind != TraceKind::sample) continue;
      x = step.t * metres_per_t_;
      const double h = step.clearance;
      // 16 units of the relief of the cell and of the height above it (height_probe.glsl.h).
      const double h_error = steepness_ * (point_error_ + 32 * kUnit) + 16 * kUnit * std::abs(h);
      const double gap_error = h_error + (steepness_ + tolerance) * e + kUnit * x;
      decide((relaxed ? std::abs(h) : h) - tolerance * x, gap_error);
      if (before == HUGE_VAL) twin_.certain = twin_.certain && h > 0;
      // The hit is where the straight line through two clearances is 0.
      if (fixed && twin_.hit) twin_.off = e + 2 * gap_error / (before - h) * settings_.fixed_step.step;
      before = h;
      if (fixed) continue;
      decide(x - exit_, e + end_error_);
      twin_.off = e;
      const bool forced = naive && factor * std::abs(h) < least;
      if (naive) decide(factor * std::abs(h) - least, h_error + steepness_ * e + kUnit * exit_);
      e = (forced ? 1 : growth(x, e, factor)) * e + factor * h_error + 8 * kUnit * exit_;
      x += std::max(factor * (naive ? std::abs(h) : h), least);
    }
    if (!fixed && twin_.hit.status == HitStatus::miss) decide(x - exit_, e + end_error_);
  }

  const HeightField& field_;
  std::string_view march_;
  const MarchSettings& settings_;
  GridRay ray_;
  double metres_per_t_ = 1, steepness_ = 1, enter_ = 0, exit_ = 0, end_error_ = 0, point_error_ = 0;
  SampledTwin twin_;
};

/// Rays and the answers of a march in single precision to them: each must be that in double unless rounding decides.
class Twins {
 public:
  static constexpr int kSide = 65;
  static constexpr std::array<std::string_view, 4> kMarches = {"naive", "relaxed", "lipschitz", "fixed-step"};

  /// Gentle hills.
  static HeightField hills() {
    std::vector<float> samples;
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col)
        samples.push_back(static_cast<float>(3 * std::sin(0.21 * col) + 2.5 * std::cos(0.17 * row + 0.1 * col)));
    }
    return HeightField::own(std::move(samples), kSide, kSide);
  }
  /// Ray `i` of `rays`: from above the field, from beside it, or from hardly above its highest sample, nearly level.
  static ShaderRay ray(const HeightField& field, int i, int rays) {
    const int side = static_cast<int>(std::sqrt(rays));
    const double u = (i % side + 0.37) / side, v = (i / side + 0.61) / side;
    const dvec3 eyes[] = {{20.25, 31.5, 40}, {-150.5, -20.25, 60}, {3.5, 4.25, field.max_sample() + 0.0625}};
    const dvec3 eye = eyes[i % 3], target(60 * u + 3.1, 60 * v + 2.3, i % 3 == 2 ? eye.z - 0.25 * v : 0);
    return *shader_ray(field, {.origin = eye, .direction = target - eye});
  }

  explicit Twins(const HeightTarget& target) : target_(target) {}
  /// `time` counts from the ray's origin, in cells along the longer axis.
  void judge(std::string_view march, const ShaderRay& made, int status, double time) {
    const SampledTwin twin = TwinOfMarch(target_, march, {}, made.ray).twin();
    ++rays_;
    hits_ += static_cast<bool>(twin.hit);
    single_hits_ += status == glsl::kScarpHit;
    if (!twin.certain) return;
    ++judged_;
    ASSERT_EQ(status == glsl::kScarpHit, static_cast<bool>(twin.hit)) << march << ": " << text(made.ray);
    if (!twin.hit) return;
    const double metres = length(made.ray.direction);
    ASSERT_NEAR(time / made.speed * metres, twin.hit.t * metres, twin.off) << march << ": " << text(made.ray);
  }
  /// Most rays are judged, there are hits and misses, and both marches count as many hits unless rounding decides.
  void conclude() const {
    EXPECT_LE(std::abs(single_hits_ - hits_), rays_ - judged_);
    EXPECT_GT(judged_, 0.75 * rays_);
    EXPECT_GT(hits_, 0.2 * rays_);
    EXPECT_LT(hits_, 0.95 * rays_);
  }

 private:
  HeightTarget target_;
  int rays_ = 0, hits_ = 0, single_hits_ = 0, judged_ = 0;
};

}  // namespace scarp::test
