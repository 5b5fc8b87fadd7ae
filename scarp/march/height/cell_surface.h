// SPDX-License-Identifier: MIT
// Clearance (ray height - surface height) of a ray in one cell, in closed form.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/field/sample_grid.h"

namespace scarp {

/// Height of a crossing between two nodes. Rounding must not move it beyond either: the pyramid bounds the nodes.
inline double edge_height(double a, double b, double f) {
  return std::clamp(a + std::clamp(f, 0.0, 1.0) * (b - a), std::min(a, b), std::max(a, b));
}

/// Clearance along the ray inside one bilinear cell: f(s) = a s^2 + b s + c, s = t - t_in.
struct CellQuadratic {
  double a, b, c;
  double surface;  // height at s = 0

  /// u, v: position in the cell at s = 0; du, dv, dz: the ray's direction; z its height at s = 0.
  CellQuadratic(const CellHeights& h, double u, double v, double du, double dv, double z, double dz) {
    const double hu = h.h10 - h.h00, hv = h.h01 - h.h00, twist = (h.h11 - h.h01) - hu;
    a = curvature(h, du, dv);
    b = dz - (hu * du + hv * dv + twist * (u * dv + v * du));
    surface = h.h00 + hu * u + hv * v + twist * u * v;
    c = z - surface;
  }

  static double curvature(const CellHeights& h, double du, double dv) {
    return ((h.h10 - h.h00) - (h.h11 - h.h01)) * du * dv;
  }

  double at(double s) const { return (a * s + b) * s + c; }

  // The root where f falls, hit by a descending ray. Without cancellation, as in Ramsey et al. 2004.
  double falling_root() const {
    const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
    return b < 0 ? 2 * c / (root - b) : -(b + root) / (2 * a);
  }
  // Whether f, positive at both ends of [0, length], reaches zero in between.
  bool dips(double length) const { return a > 0 && b < 0 && -b < 2 * a * length && b * b >= 4 * a * c; }
  double vertex_value() const { return c - b * b / (4 * a); }
  // Whether f has its maximum in between.
  bool peaks(double length) const { return a < 0 && b > 0 && b < -2 * a * length; }
};

/// Clearance along the ray over one triangle of a cell: f(s) = c + b s. `south_east` selects the triangle.
struct CellPlane {
  double b, c;
  double surface;  // height at s = 0

  CellPlane(const CellHeights& h, bool south_east, double u, double v, double du, double dv, double z, double dz) {
    const double hu = south_east ? h.h11 - h.h01 : h.h10 - h.h00, hv = south_east ? h.h11 - h.h10 : h.h01 - h.h00;
    b = dz - (hu * du + hv * dv);
    surface = south_east ? h.h11 - hu * (1 - u) - hv * (1 - v) : h.h00 + hu * u + hv * v;
    c = z - surface;
  }
  double root() const { return -c / b; }
};

}  // namespace scarp
