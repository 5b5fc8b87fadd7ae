// SPDX-License-Identifier: MIT
// Private to the station: a probe that records the samples of a march (base/march_trace.h), for naive, fixed-step,
// relaxed and lipschitz over any field.
#pragma once

#include <limits>

#include "scarp/base/march_trace.h"
#include "scarp/march/usual_ray.h"

namespace scarp {

template <class Probe>
class TracedProbe : public Probe {
 public:
  using Sample = typename Probe::Sample;

  TracedProbe(const Probe& probe, MarchTrace& trace) : Probe(probe), trace_(trace) {}

  Sample at(double t) const {
    const Sample sample = Probe::at(t);
    TraceStep step{.kind = !sample.valid ? TraceKind::hole
                           : refines_    ? TraceKind::refinement
                                         : TraceKind::sample,
                   .t = t,
                   .t_out = t};
    step.clearance = sample.valid ? metres(sample) : std::numeric_limits<double>::quiet_NaN();
    trace_.steps.push_back(step);
    return sample;
  }
  double free_time(const Sample& sample, double shrink) const {
    const double free = Probe::free_time(sample, shrink);
    trace_.steps.back().free = free / this->per_metre();
    return free;
  }
  /// The samples that follow refine a hit (refined_hit()).
  void refines() const { refines_ = true; }

 private:
  static double metres(const Sample& sample) {
    if constexpr (requires { sample.metres; }) {
      return sample.metres;
    } else {
      return sample.clearance;
    }
  }

  MarchTrace& trace_;
  mutable bool refines_ = false;
};

/// Runs a march: `over(run)` calls run(probe, counted) for the ray, if need be at usual length.
template <class Over, class March>
Hit traced_over(const Ray& ray, MarchTrace& trace, const Over& over, const March& march) {
  trace.steps.clear();
  const Hit hit =
      over([&](const auto& probe, MarchStats& counted) { return march(TracedProbe(probe, trace), counted); });
  if (const double longest = longest_of(ray.direction); !is_usual(longest) && is_direction(longest))
    trace.scale_times(std::ilogb(longest));
  return hit;
}

}  // namespace scarp
