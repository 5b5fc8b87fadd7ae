// SPDX-License-Identifier: MIT
// Terrain function instructions on plain numbers. They define the heights.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/field/function_program.h"

namespace scarp::function {

inline double combine(double k0, double a, double k1, double b, double k2) { return k0 * a + k1 * b + k2; }
inline double turned_place(double k0, double a, double k1, double b) { return k0 * a + k1 * b; }
inline double multiply(double a, double b) { return a * b; }
inline double square(double a) { return a * a; }
inline double absolute(double a) { return std::abs(a); }
inline double clamp(double a, double low, double high) { return std::min(std::max(a, low), high); }
inline double sine(double a) { return std::sin(a); }
inline double cosine(double a) { return std::cos(a); }
inline double minimum(double a, double b) { return std::min(a, b); }
inline double maximum(double a, double b) { return std::max(a, b); }
inline double reciprocal(double a) { return 1 / a; }

/// Weight of a in the smooth minimum.
inline double smooth_share(double a, double b, double radius) { return clamp(0.5 + 0.5 * (b - a) / radius, 0, 1); }
inline double smooth_minimum(double a, double b, double radius) {
  const double t = smooth_share(a, b, radius);
  return b + t * (a - b) - radius * t * (1 - t);
}

inline double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
inline double fade_slope(double t) { return 30 * (t * t) * ((t - 1) * (t - 1)); }
inline constexpr double kSteepestFade = 1.875;  // maximum slope of the fade, at 1/2

inline double terrace_phase(double a, double step, double rise, double& floor) {
  const double steps = a / step;
  floor = std::floor(steps);
  return clamp((steps - floor - (1 - rise)) / rise, 0, 1);
}
inline double terrace(double a, double step, double rise) {
  double floor = 0;
  const double phase = terrace_phase(a, step, rise, floor);
  return step * (floor + fade(phase));
}
inline double terrace_slope(double a, double step, double rise) {
  double floor = 0;
  return fade_slope(terrace_phase(a, step, rise, floor)) / rise;
}

/// Phase of the mask at a distance from its centre: 0 from the outer radius on, 1 within the inner.
inline double radial_phase(double distance, double inner, double outer) {
  return clamp((outer - distance) / (outer - inner), 0, 1);
}
inline double radial(double x, double y, const FunctionInstruction& in) {
  const double dx = x - in.k0, dy = y - in.k1;
  return fade(radial_phase(std::sqrt(dx * dx + dy * dy), in.k2, in.k3));
}
/// Derivatives of radial() in x and y.
inline void radial_slope(double x, double y, const FunctionInstruction& in, double& out_x, double& out_y) {
  const double dx = x - in.k0, dy = y - in.k1;
  const double distance = std::sqrt(dx * dx + dy * dy);
  const double slope = -fade_slope(radial_phase(distance, in.k2, in.k3)) / (in.k3 - in.k2);
  out_x = distance > 0 ? slope * (dx / distance) : 0;
  out_y = distance > 0 ? slope * (dy / distance) : 0;
}

inline double noise_value(const FunctionInstruction& in, double a, double b) { return noise(in.kind, in.seed, a, b); }
inline void noise_slope(const FunctionInstruction& in, double a, double b, double& n, double& x, double& y) {
  const NoiseJet jet = noise_jet(in.kind, in.seed, a, b);
  n = jet.n, x = jet.x, y = jet.y;
}
inline void noise_curvature(const FunctionInstruction& in, double a, double b, double& n, double& x, double& y,
                            double& xx, double& xy, double& yy) {
  const NoiseJet jet = noise_jet(in.kind, in.seed, a, b);
  n = jet.n, x = jet.x, y = jet.y, xx = jet.xx, xy = jet.xy, yy = jet.yy;
}

}  // namespace scarp::function
