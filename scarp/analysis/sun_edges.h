// SPDX-License-Identifier: MIT
// Exact comparisons of the edges of a field with rays to the sun.
#pragma once

#include <cstdint>

#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/ring_frame.h"
#include "scarp/analysis/shadow.h"

namespace scarp {

/// A sun ray in a frame that is swept away from the sun: per kUnit rings towards it, `across` sides and `rise` metres.
struct SweptSun {
  RingFrame frame;
  std::int64_t across;
  double rise;

  /// Rings are lines across the larger component of the ray.
  SweptSun(const HeightField& field, const SunRay& ray)
      : frame(field, origin(field, ray), direction(ray)),
        across(std::abs(ray.col) >= std::abs(ray.row) ? ray.row : ray.col),
        rise(ray.rise) {}

  /// Position of a sample across the rays, in 1/kUnit sides. An integer below 2^48: exact.
  double u(HorizonSample s) const {
    return static_cast<double>(frame.y(s.side) * SunRay::kUnit + frame.x(s.ring) * across);
  }

 private:
  static SweepDirection direction(const SunRay& ray);
  static Node origin(const HeightField& field, const SunRay& ray);
};

class SunEdges : public HorizonEdges {
 public:
  SunEdges(const SightGround& ground, const SweptSun& sun) : ground_(ground), sun_(sun) {}

  int edge_above(const HorizonLine& edge, HorizonSample sample) const override;
  int edge_above_target(const HorizonLine& edge, HorizonSample target) const override {
    return edge_above(edge, target);
  }
  double position(HorizonSample sample) const override { return sun_.u(sample); }
  /// Whether a sample is above the ray through another sample, or above the continuation of that ray.
  bool sample_above(HorizonSample sample, HorizonSample other) const;

 private:
  double height(HorizonSample sample) const { return *ground_.height(sun_.frame.node(sample)); }

  const SightGround& ground_;
  const SweptSun& sun_;
};

}  // namespace scarp
