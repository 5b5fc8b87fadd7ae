// SPDX-License-Identifier: MIT
#include "scarp/field/distance_local.h"

#include <algorithm>

#include "scarp/field/ground_holes.h"

namespace scarp::distance {
namespace {

using function::kSlack;
using function::Taylor;

dvec2 clamped_to(const HeightField& field, const dvec3& q) {
  if (field.wraps()) return {q.x, q.y};
  return {std::clamp(q.x, 0.0, field.width()), std::clamp(q.y, 0.0, field.depth())};
}

// Signed distance to the field's border, negative inside.
double beyond_border(const HeightField& field, const dvec3& q) {
  if (field.wraps()) return -std::numeric_limits<double>::infinity();
  return corner2(std::max(-q.x, q.x - field.width()), std::max(-q.y, q.y - field.depth()));
}

}  // namespace

double field_ground_value(const HeightField& field, const HeightField* holes, const dvec3& q, double shrink) {
  const dvec2 at = clamped_to(field, q);
  // The field has no holes, so the height exists.
  const double value = std::max((q.z - field.height(at.x, at.y).value_or(0)) * shrink, beyond_border(field, q));
  return holes ? std::max(value, over_hole(*holes, at, 0).value) : value;
}

dvec3 field_ground_gradient(const HeightField& field, const HeightField* holes, const dvec3& q, double shrink) {
  const dvec2 at = clamped_to(field, q);
  const double over = (q.z - field.height(at.x, at.y).value_or(0)) * shrink;
  if (holes) {
    const OverHole hole = over_hole(*holes, at, 0);
    if (hole.value > std::max(over, beyond_border(field, q))) return {hole.gradient, 0};
  }
  if (beyond_border(field, q) > over) {
    const double k[6] = {0, 0, -kCreased, field.width(), field.depth(), kCreased};
    return bent_outside(q, k, 0).gradient;
  }
  dvec2 slope = field.gradient(at.x, at.y).value_or(dvec2(0.0));
  if (at.x != q.x) slope.x = 0;
  if (at.y != q.y) slope.y = 0;
  return shrink * dvec3(-slope, 1.0);
}

FieldSlope field_slope(const HeightField& field, const dvec3& q, const dvec3& d, double slope) {
  const double steepest = slope * length2(d.x, d.y);
  const FieldSlope anything{-steepest, steepest};
  const HeightFieldSettings& settings = field.settings();
  const double x = field.wraps() ? q.x - std::floor(q.x / field.width()) * field.width() : q.x;
  const double y = field.wraps() ? q.y - std::floor(q.y / field.depth()) * field.depth() : q.y;
  // Slightly wider than the segment, for the rounding of positions.
  constexpr double kRoom = 0x1p-30;
  const double col_low = (x - std::abs(d.x)) / settings.cell_x - kRoom,
               col_high = (x + std::abs(d.x)) / settings.cell_x + kRoom;
  const double row_low = (field.rows() - 1) - (y + std::abs(d.y)) / settings.cell_y - kRoom;
  const double row_high = (field.rows() - 1) - (y - std::abs(d.y)) / settings.cell_y + kRoom;
  if (!(col_low >= 0 && row_low >= 0 && col_high < field.cell_cols() && row_high < field.cell_rows())) return anything;
  const int col0 = static_cast<int>(col_low), col1 = static_cast<int>(col_high);
  const int row0 = static_cast<int>(row_low), row1 = static_cast<int>(row_high);
  constexpr int kMostCells = 16;
  if (std::int64_t{col1 - col0 + 1} * (row1 - row0 + 1) > kMostCells) return anything;
  const double metres = settings.scale * settings.exaggeration;
  double x_low = kCreased, x_high = -kCreased, y_low = kCreased, y_high = -kCreased;
  for (int row = row0; row <= row1; ++row) {
    for (int col = col0; col <= col1; ++col) {
      const auto h = field.cell_heights({col, row});
      if (!h) return anything;
      const double per_x = metres / settings.cell_x, per_y = metres / settings.cell_y;
      const double north = (h->h10 - h->h00) * per_x, south = (h->h11 - h->h01) * per_x;
      // Rows run southwards.
      const double west = (h->h00 - h->h01) * per_y, east = (h->h10 - h->h11) * per_y;
      const double u0 = std::clamp(col_low - col, 0.0, 1.0), u1 = std::clamp(col_high - col, 0.0, 1.0);
      const double v0 = std::clamp(row_low - row, 0.0, 1.0), v1 = std::clamp(row_high - row, 0.0, 1.0);
      const auto seen = [&](double x_slope, double y_slope) {
        x_low = std::min(x_low, x_slope), x_high = std::max(x_high, x_slope);
        y_low = std::min(y_low, y_slope), y_high = std::max(y_high, y_slope);
      };
      if (settings.surface == Surface::bilinear) {
        seen(north + v0 * (south - north), west + u0 * (east - west));
        seen(north + v1 * (south - north), west + u1 * (east - west));
      } else {
        if (u0 + v0 <= 1) seen(north, west);
        if (u1 + v1 >= 1) seen(south, east);
      }
    }
  }
  const double slack = 8 * kSlack *
                       (std::abs(d.x) * std::max(std::abs(x_low), std::abs(x_high)) +
                        std::abs(d.y) * std::max(std::abs(y_low), std::abs(y_high)));
  return {std::min(x_low * d.x, x_high * d.x) + std::min(y_low * d.y, y_high * d.y) - slack,
          std::max(x_low * d.x, x_high * d.x) + std::max(y_low * d.y, y_high * d.y) + slack};
}

GradientMode::Value GradientMode::rest_bound(const Value& a, const Position& p, const double* k, int mask) const {
  const double bound = distance::rest_bound(p.p, k);
  if (mask || !(bound < a.value)) return a;
  int along = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (k[3 + axis] != 0 && rest_bound_along(p.p, k, axis) <= bound * bound * (1 + 0x1p-40)) along = axis;
  }
  dvec3 out(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double off = nearest_copy(p.p[axis], k, axis).off;
    const double away = positive(std::abs(off) + (axis == along ? k[3 + axis] : 0) - k[9 + axis]);
    out[axis] = off < 0 ? -away : away;
  }
  return {bound, to_world(p, out / bound)};
}

BentMode::Value BentMode::from_range(double low, double high) const {
  return {function::from_range<1>(low, high, 0), -radius, radius};
}

BentMode::Value BentMode::from_bent(const Bent& bent, const dvec3& d) const {
  if (bent.bend == kCreased) return from_range(bent.value - radius, bent.value + radius);
  const double slope = dot(bent.gradient, d), most = bent.bend * radius * radius * (1 + 0x1p-20);
  Value out{{}, slope - most, slope + most};
  Taylor<1>& t = out.f;
  t.mid = bent.value;
  t.slope[0] = slope;
  t.rest = 0.5 * most + 8 * kSlack * (std::abs(slope) + std::abs(bent.value));
  t.low = bent.value - radius, t.high = bent.value + radius;
  function::settle(t);
  return out;
}

BentMode::Value BentMode::minimum(const Value& a, const Value& b) const {
  if (a.f.high <= b.f.low) return a;
  if (b.f.high <= a.f.low) return b;
  return {function::minimum(a.f, b.f), std::min(a.rate_low, b.rate_low), std::max(a.rate_high, b.rate_high)};
}

BentMode::Value BentMode::smooth_minimum(const Value& a, const Value& b, double k) const {
  if (a.f.high <= b.f.low - k) return a;
  if (b.f.high <= a.f.low - k) return b;
  return {function::smooth_minimum(a.f, b.f, k), std::min(a.rate_low, b.rate_low), std::max(a.rate_high, b.rate_high)};
}

BentMode::Value BentMode::clamp(const Value& a, const Position& p, const double* k) const {
  const double away = outside(p.p, k);
  if (away + radius <= a.f.low) return a;
  if (away > radius) {
    const Bent bent = bent_outside(p.p, k, radius);
    return negative(minimum(negative(a), negative(from_bent(bent, p.d))));
  }
  double nearest_side = -kCreased;
  for (int i = 0; i < 3; ++i) nearest_side = std::max({nearest_side, k[i] - p.p[i], p.p[i] - k[3 + i]});
  if (nearest_side + radius <= 0) return a;
  return from_range(a.f.low, std::max(a.f.high, away + radius));
}

BentMode::Value BentMode::rest_bound(const Value& a, const Position& p, const double* k, int mask) const {
  double least = kCreased;
  for (int axis = 0; axis < 3; ++axis) {
    if (k[3 + axis] == 0) continue;
    // If the segment stays on one side of the copy's centre, its neighbours have been evaluated.
    const double off = std::abs(nearest_copy(p.p[axis], k, axis).off);
    if (mask && off >= radius && off + radius <= k[3 + axis]) continue;
    least = std::min(least, std::sqrt(rest_bound_along(p.p, k, axis)) - radius);
  }
  if (least >= a.f.high) return a;
  // If the shape is exact, everything relevant at the middle has been evaluated.
  const double lowest = std::min(a.f.low, least);
  return from_range(mask ? std::max(lowest, a.f.mid - a.f.rest - radius) : lowest, a.f.high);
}

BentMode::Value BentMode::function_ground(const HeightFunction& function, const double* k, const Position& p) const {
  const double scale = k[3], factor = k[4] * scale;
  const dvec3 q = (p.p - dvec3(k[0], k[1], k[2])) / scale, d = p.d / scale;
  const double reach = kFunctionReach - radius / scale;
  if (!(std::abs(q.x) < reach && std::abs(q.y) < reach)) {
    const dvec3 in = within_reach(q);
    const double value = (q.z - function.value(in.x, in.y)) * factor;
    return from_range(value - radius, value + radius);
  }
  const SegmentBound b = function.along({q.x, q.y}, {d.x, d.y}, -1, 1);
  Value out{{}, -radius, radius};
  Taylor<1>& t = out.f;
  const double size = std::abs(q.z) + std::abs(d.z) + std::abs(b.mid) + std::abs(b.slope);
  t.mid = (q.z - b.mid) * factor;
  t.slope[0] = (d.z - b.slope) * factor;
  t.rest = (b.rest + 8 * kSlack * size) * factor;
  t.low = (q.z - std::abs(d.z) - b.high - 8 * kSlack * size) * factor;
  t.high = (q.z + std::abs(d.z) - b.low + 8 * kSlack * size) * factor;
  function::settle(t);
  if (rates) {
    const dvec2 slope = function.slope_along({q.x, q.y}, {d.x, d.y}, -1, 1);
    out.rate_low = std::max(-radius, (d.z - slope.y) * factor);
    out.rate_high = std::min(radius, (d.z - slope.x) * factor);
  }
  return out;
}

BentMode::Value BentMode::field_ground(const HeightField& field, const HeightField* holes, const double* k,
                                       const Position& p) const {
  const Value ground = field_without_holes(field, k, p);
  if (!holes) return ground;
  const double scale = k[3];
  const dvec3 q = (p.p - dvec3(k[0], k[1], k[2])) / scale;
  const dvec2 at = clamped_to(field, q);
  const OverHole hole = over_hole(*holes, at, radius / scale);
  const double value = hole.value * scale;
  if (value + radius <= ground.f.low) return ground;
  // Where the segment may be outside the field, `hole` is that of the clamped position.
  const bool flat = hole.flat && at.x == q.x && at.y == q.y && beyond_border(field, q) * scale + radius < 0;
  const Value rim = from_bent({value, dvec3(hole.gradient, 0), flat ? 0 : kCreased}, p.d);
  return negative(minimum(negative(ground), negative(rim)));
}

BentMode::Value BentMode::field_without_holes(const HeightField& field, const double* k, const Position& p) const {
  const double scale = k[3], shrink = k[4], factor = shrink * scale;
  const dvec3 q = (p.p - dvec3(k[0], k[1], k[2])) / scale, d = p.d / scale;
  const double value = field_ground_value(field, nullptr, q, shrink) * scale;
  // Near the walls alone, or over the ground alone; where they meet, only the Lipschitz bound holds.
  if (!field.wraps()) {
    const double border = beyond_border(field, q) * scale;
    const dvec2 at = clamped_to(field, q);
    const double over = (q.z - field.height(at.x, at.y).value_or(0)) * factor;
    if (border - radius >= over + radius) {
      const double walls[6] = {0, 0, -kCreased, field.width() * scale, field.depth() * scale, kCreased};
      return from_bent(bent_outside(q * scale, walls, radius), p.d);
    }
    if (border + radius > over - radius) return from_range(value - radius, value + radius);
  }
  const FieldSlope slope = field_slope(field, q, d, k[5]);
  Value out{{}, (d.z - slope.high) * factor, (d.z - slope.low) * factor};
  Taylor<1>& t = out.f;
  t.mid = value;
  t.slope[0] = 0.5 * (out.rate_low + out.rate_high);
  t.rest =
      0.5 * (out.rate_high - out.rate_low) * (1 + 8 * kSlack) + 8 * kSlack * (std::abs(value) + std::abs(t.slope[0]));
  t.low = value - radius, t.high = value + radius;
  function::settle(t);
  return out;
}

}  // namespace scarp::distance
