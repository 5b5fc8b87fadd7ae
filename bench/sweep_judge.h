// SPDX-License-Identifier: MIT
// A judge of sweeps that shares no code with them: the distance of a moving convex body to a triangle is a convex
// function of time, so its minimum over a part of the motion is found by golden sections. A sweep has tunnelled if the
// capsule penetrates a triangle more deeply than rounding explains, before the contact that the sweep returned or, if
// it returned none, at any time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scarp/base/vec.h"
#include "scarp/field/height_field.h"

namespace scarp::bench {

using JudgedTriangle = std::array<dvec3, 3>;

inline double to_segment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const double square = dot(b - a, b - a);
  const double along = square > 0 ? std::clamp(dot(p - a, b - a) / square, 0.0, 1.0) : 0.0;
  return length(a + along * (b - a) - p);
}

// The distance to the plane if the foot of the perpendicular is inside, otherwise to the nearest side.
inline double to_triangle(const dvec3& p, const JudgedTriangle& t) {
  const auto& [a, b, c] = t;
  const dvec3 n = cross(b - a, c - a);
  const bool inside =
      dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
  if (inside && dot(n, n) > 0) return std::abs(dot(p - a, n)) / length(n);
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

// The smallest distance of the ends and, if both feet are inside, of the two lines.
inline double between_segments(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  double best = std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const dvec3 u = b - a, v = d - c, n = cross(u, v), w = c - a;
  const double square = dot(n, n);
  if (square > 0) {
    const double s = dot(cross(w, v), n) / square, t = dot(cross(w, u), n) / square;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, std::abs(dot(w, n)) / std::sqrt(square));
  }
  return best;
}

inline double to_triangle(const dvec3& p, const dvec3& q, const JudgedTriangle& t) {
  const auto volume = [](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    return dot(cross(b - a, c - a), d - a);
  };
  const auto& [a, b, c] = t;
  if (volume(a, b, c, p) * volume(a, b, c, q) < 0) {
    const double ab = volume(p, q, a, b), bc = volume(p, q, b, c), ca = volume(p, q, c, a);
    if ((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0)) return 0;
  }
  return std::min({to_triangle(p, t), to_triangle(q, t), between_segments(p, q, a, b), between_segments(p, q, b, c),
                   between_segments(p, q, c, a)});
}

/// A capsule and its motion.
struct JudgedSweep {
  dvec3 a{0.0}, b{0.0};
  double radius = 0;
  dvec3 motion{0.0};

  double distance(const JudgedTriangle& t, double time) const {
    return to_triangle(a + time * motion, b + time * motion, t);
  }

  /// The least distance to a triangle from the start to `end`.
  double deepest(const JudgedTriangle& t, double end) const {
    const dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const double size = std::max({length(t[0] - middle), length(t[1] - middle), length(t[2] - middle)}) + length(b - a);
    if (out_of_reach(t, end) || to_segment(middle, a, a + end * motion) > size + radius + kMargin)
      return std::numeric_limits<double>::infinity();
    constexpr double kGolden = 0.6180339887498949;
    double low = 0, high = end;
    double x = high - kGolden * (high - low), y = low + kGolden * (high - low);
    double at_x = distance(t, x), at_y = distance(t, y), least = std::min(distance(t, 0), distance(t, end));
    for (int i = 0; i < 70; ++i) {
      least = std::min({least, at_x, at_y});
      if (at_x < at_y) {
        high = y, y = x, at_y = at_x;
        x = high - kGolden * (high - low), at_x = distance(t, x);
      } else {
        low = x, x = y, at_x = at_y;
        y = low + kGolden * (high - low), at_y = distance(t, y);
      }
    }
    return least;
  }

  /// Rounding of distances: proportional to each coordinate.
  double rounding() const { return 64 * 0x1p-53 * (length(a) + length(b) + length(motion) + radius); }

 private:
  // Triangles that are out of reach by more than this, in metres, are skipped: far more than rounding over the few
  // metres of judged fields.
  static constexpr double kMargin = 0x1p-20;

  bool out_of_reach(const JudgedTriangle& t, double end) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double to = end * motion[axis], wide = radius + kMargin;
      const double low = std::min(a[axis], b[axis]) + std::min(0.0, to) - wide;
      const double high = std::max(a[axis], b[axis]) + std::max(0.0, to) + wide;
      if (std::min({t[0][axis], t[1][axis], t[2][axis]}) > high) return true;
      if (std::max({t[0][axis], t[1][axis], t[2][axis]}) < low) return true;
    }
    return false;
  }
};

/// All triangles of a field, each cell cut into parts x parts pairs.
inline std::vector<JudgedTriangle> all_triangles(const HeightField& field, int parts) {
  std::vector<JudgedTriangle> all;
  for (int row = 0; row < field.cell_rows(); ++row) {
    for (int col = 0; col < field.cell_cols(); ++col) {
      const auto h = field.cell_heights({col, row});
      if (!h) continue;
      const auto at = [&](int i, int j) {
        const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
        return field.world_from_grid(col + u, row + v, height_in_cell(field.settings().surface, *h, u, v));
      };
      for (int i = 0; i < parts; ++i) {
        for (int j = 0; j < parts; ++j) {
          all.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
          all.push_back({at(i + 1, j + 1), at(i + 1, j), at(i, j + 1)});
        }
      }
    }
  }
  return all;
}

/// Error of an answer: the capsule's penetration before the contact, in metres, and the distance of the contact from a
/// touch. 0 for both within rounding. `off`: distance in metres of the triangles from the surface.
struct SweepError {
  double tunnelled = 0;
  double untouched = 0;
};
inline SweepError judge_sweep(const JudgedSweep& sweep, const std::vector<JudgedTriangle>& triangles, bool hit,
                              double t, double off) {
  const double end = hit ? t : 1, slack = sweep.rounding() + off;
  SweepError error;
  double nearest = std::numeric_limits<double>::infinity();
  for (const JudgedTriangle& triangle : triangles) {
    const double deepest = sweep.deepest(triangle, end);
    // A capsule that overlaps at its start touches immediately, at any depth.
    if (!(hit && t == 0)) error.tunnelled = std::max(error.tunnelled, sweep.radius - slack - deepest);
    if (hit && deepest <= sweep.radius + slack) nearest = std::min(nearest, sweep.distance(triangle, end));
  }
  if (hit) error.untouched = std::max(0.0, nearest - sweep.radius - slack);
  return error;
}

}  // namespace scarp::bench
