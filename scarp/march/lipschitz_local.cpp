// SPDX-License-Identifier: MIT
#include "scarp/march/lipschitz_local.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scarp/march/function_ray.h"

namespace scarp {
namespace {

// The shortest segment looked at, as a share of the ray's part over the ground, whatever the tolerance.
constexpr double kShortest = 0x1p-40;
// Lines are followed a little less far than to where they meet the ray: more than their rounding.
constexpr double kShort = 1 - 0x1p-20;

// What is proven about a segment: the ray is above the ground until `free`, and under it at `sunk`, if that is finite.
struct Proof {
  double free, sunk;
};

Proof proof_of(const FunctionRay& r, double t0, double t1) {
  const Ray& ray = r.ray();
  const SegmentBound b = r.bound(t0, t1);
  const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0), slack = r.rounding_of_height(t0, t1);
  Proof proof{t1, std::numeric_limits<double>::infinity()};
  const double least_height = ray.origin.z + ray.direction.z * (ray.direction.z < 0 ? t1 : t0);
  if (least_height - b.high > slack) return proof;
  // The clearance is within `wide` of mid + slope * s.
  const double mid = ray.origin.z + ray.direction.z * middle - b.mid, wide = b.rest + slack;
  const double slope = ray.direction.z * half - b.slope;
  const double begin = mid - slope - wide, end = mid + slope - wide;
  if (begin <= 0) {
    proof.free = t0;
  } else if (end <= 0) {
    proof.free = t0 + kShort * (t1 - t0) * begin / (begin - end);
  }
  const double begin_most = begin + 2 * wide, end_most = end + 2 * wide;
  if (end_most < 0) proof.sunk = begin_most > 0 ? t0 + (t1 - t0) * begin_most / (begin_most - end_most) : t0;
  return proof;
}

class LocalMarch {
 public:
  LocalMarch(const FunctionRay& r, const LipschitzLocalSettings& settings, MarchStats& stats)
      : r_(r), settings_(settings), stats_(stats), shortest_(kShortest * (r.t_exit - r.t_enter)) {}

  Hit run() {
    double t = r_.t_enter;
    if (r_.ray().start == RayStart::on_surface && t == r_.ray().t_min) {
      const std::optional<double> free = leave_surface();
      if (!free) return r_.hit(t);
      t = *free;
    } else {
      ++stats_.cell_tests;
      const double h = r_.clearance(t);
      if (std::abs(h) <= r_.rounding()) return r_.hit(t);
      if (h < 0) return r_.ended(HitStatus::below, t);
    }
    double length = r_.t_exit - t;
    while (t < r_.t_exit) {
      if (stats_.steps >= static_cast<std::uint32_t>(settings_.max_steps)) return r_.ended(HitStatus::exhausted, t);
      ++stats_.steps;
      const double end = std::min(t + length, r_.t_exit);
      const auto [free, sunk] = proof_of(r_, t, end);
      if (free == end) {
        t = end;
        length *= kGrowth;
        continue;
      }
      const double least = std::max(shortest_, settings_.tolerance * (t - r_.ray().t_min));
      if (length <= least) return last_interval(t, end);
      const double gained = free - t;
      // The first crossing is before `sunk`; otherwise it may be anywhere in the rest of the segment, or nowhere.
      length = std::max(least, sunk < end ? std::min((sunk - free) * kBeyond, kShrink * length)
                                          : std::max(gained, kShrink * (end - free)));
      t = free;
    }
    return {};
  }

 private:
  // Of segments: how much longer the next one is after a free one, and shorter after one that is not. Of the pairs
  // tried (1.5 to 4, 0.15 to 0.4) the one with the fewest bounds over most functions; doubling takes a seventh more.
  static constexpr double kGrowth = 1.5, kShrink = 0.4;
  static constexpr double kBeyond = 1 + 0x1p-10;  // a little beyond where the ray is known to be under the ground

  Hit last_interval(double t, double end) {
    ++stats_.cell_tests;
    const double h = r_.clearance(end);
    return r_.hit(h <= 0 ? r_.crossing(t, end, h, stats_) : t);
  }

  // From the surface: until when the ray provably gains height; nothing when it loses height at once.
  std::optional<double> leave_surface() {
    const double t = r_.t_enter;
    double length = r_.t_exit - t;
    while (true) {
      ++stats_.steps;
      const dvec2 gain = r_.gain(t, t + length);
      if (gain.x > 0) return t + length;
      if (gain.y < 0) return {};
      // Neither gains nor loses: along the ground, as far as can be told.
      if (length <= shortest_) return t + length;
      length *= 0.25;
    }
  }

  const FunctionRay& r_;
  const LipschitzLocalSettings& settings_;
  MarchStats& stats_;
  double shortest_;
};

}  // namespace

Hit march_lipschitz_local(const HeightFunction& function, const Ray& ray, const MarchSettings& settings,
                          MarchStats* stats, FunctionUse use) {
  MarchStats counted;
  Hit hit;
  const FunctionRay r(function, ray, use, settings.function.reach);
  if (r.begins_under) {
    hit.status = HitStatus::below;
  } else if (r.crosses()) {
    hit = LocalMarch(r, settings.lipschitz_local, counted).run();
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
