// SPDX-License-Identifier: MIT
#include "scarp/field/distance_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/field/distance_turn.h"

namespace scarp {
namespace {

using namespace shape;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Relative widening of boxes: more than the effect of 8 roundings.
constexpr double kWider = 0x1p-49;

[[noreturn]] void refuse(std::string_view what, double value, std::string_view range) {
  throw Error(fmt::format("shape: {} is {} (must be {})", what, value, range));
}
void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) refuse(what, value, range);
}
void require_length(std::string_view what, double value) {
  require(value >= kLeastLength && value <= kMostLength, what, value, "between 2^-20 and 2^30");
}
void require_place(std::string_view what, const dvec3& value) {
  for (int axis = 0; axis < 3; ++axis) {
    require(std::abs(value[axis]) <= kMostLength, fmt::format("{} {}", what, "xyz"[axis]), value[axis],
            "between -2^30 and 2^30");
  }
}
void require_direction(std::string_view what, const dvec3& value) {
  require_place(what, value);
  require(length(value) >= kLeastLength, fmt::format("length of the {}", what), length(value), "at least 2^-20");
}
void require_smooth(std::string_view what, double radius) {
  require(radius == 0 || (radius >= kLeastLength && radius <= kMostLength), fmt::format("{} smooth radius", what),
          radius, "0, or between 2^-20 and 2^30");
}
void require_shape(std::string_view what, const Shape& shape) {
  if (!shape) throw Error(fmt::format("shape: {} is missing (must be a shape)", what));
}

ShapeBox around_origin(const dvec3& half) { return {-half, half}; }

ShapeBox hull(const ShapeBox& a, const ShapeBox& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }
ShapeBox common(const ShapeBox& a, const ShapeBox& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

ShapeBox widened(ShapeBox box, double by = 0) {
  if (box.empty()) return {};
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] -= by + kWider * (by + std::abs(box.low[axis]));
    box.high[axis] += by + kWider * (by + std::abs(box.high[axis]));
  }
  return box;
}

// Properties of a valid node.
struct Known {
  int under = 0;  // depth below this node
  ShapeBox box;
};

struct Check {
  Known operator()(const Sphere& s) const {
    require_length("sphere radius", s.radius);
    return {0, around_origin(dvec3(s.radius))};
  }
  Known operator()(const Box& b) const {
    for (int axis = 0; axis < 3; ++axis) {
      require_length(fmt::format("box half {}", "xyz"[axis]), b.half[axis]);
    }
    require(b.round >= 0 && b.round <= std::min({b.half.x, b.half.y, b.half.z}), "box round", b.round,
            "between 0 and the smallest half");
    return {0, around_origin(b.half)};
  }
  Known operator()(const HalfSpace& p) const {
    require_direction("plane normal", p.normal);
    require(std::abs(p.height) <= kMostLength, "plane height", p.height, "between -2^30 and 2^30");
    ShapeBox box{dvec3(-kInfinity), dvec3(kInfinity)};
    const dvec3 n = normalize(p.normal);
    for (int axis = 0; axis < 3; ++axis) {
      if (n[axis] == 1) box.high[axis] = p.height;
      if (n[axis] == -1) box.low[axis] = -p.height;
    }
    return {0, box};
  }
  Known operator()(const Capsule& c) const {
    require_place("capsule from", c.from);
    require_place("capsule to", c.to);
    require_length("capsule radius", c.radius);
    return {0, {glm::min(c.from, c.to) - c.radius, glm::max(c.from, c.to) + c.radius}};
  }
  Known operator()(const Cylinder& c) const {
    require_length("cylinder radius", c.radius);
    require_length("cylinder half height", c.half_height);
    return {0, around_origin({c.radius, c.radius, c.half_height})};
  }
  Known operator()(const Cone& c) const {
    require_length("cone radius", c.radius);
    require_length("cone height", c.height);
    require(c.top >= 0 && c.top <= c.radius, "cone top", c.top, "between 0 and the radius");
    return {0, {{-c.radius, -c.radius, 0}, {c.radius, c.radius, c.height}}};
  }
  Known operator()(const Torus& t) const {
    require(t.radius >= 0 && t.radius <= kMostLength, "torus radius", t.radius, "between 0 and 2^30");
    require_length("torus tube", t.tube);
    return {0, around_origin({t.radius + t.tube, t.radius + t.tube, t.tube})};
  }
  Known operator()(const Ellipsoid& e) const {
    for (int axis = 0; axis < 3; ++axis) {
      require_length(fmt::format("ellipsoid radii {}", "xyz"[axis]), e.radii[axis]);
    }
    return {0, around_origin(e.radii)};
  }
  Known operator()(const FunctionGround& g) const {
    if (!g.function) throw Error("shape: function of a ground is missing (must be a height function)");
    const FunctionBound& all = g.function->bound_everywhere();
    return {0, {dvec3(-kInfinity), {kInfinity, kInfinity, all.high + all.rounding}}};
  }
  Known operator()(const FieldGround& g) const {
    if (!g.field) throw Error("shape: field of a ground is missing (must be a height field)");
    if (!g.field->has_cells())
      throw Error("shape: field of a ground has no cells (needs at least 2 columns and 2 rows)");
    if (g.field->nodata_count() > 0) {
      throw Error(fmt::format("shape: field of a ground has {} nodata samples (make the ground with solid_ground())",
                              g.field->nodata_count()));
    }
    if (g.holes && (g.holes->cols() != g.field->cols() || g.holes->rows() != g.field->rows() ||
                    g.holes->settings().wrap != g.field->settings().wrap ||
                    g.holes->settings().cell_x != g.field->settings().cell_x ||
                    g.holes->settings().cell_y != g.field->settings().cell_y)) {
      throw Error("shape: field and holes of a ground are on different grids (must be the same grid)");
    }
    require(g.slope >= 0 && g.slope <= kMostLength, "slope of a ground", g.slope,
            "between 0 and 2^30, from slope_bound()");
    ShapeBox box{dvec3(-kInfinity), {kInfinity, kInfinity, g.field->max_height()}};
    if (!g.field->wraps()) box = {{0, 0, -kInfinity}, {g.field->width(), g.field->depth(), g.field->max_height()}};
    return {0, box};
  }
  Known operator()(const Moved& m) const {
    require_shape("operand of move", m.shape);
    require_place("move by", m.by);
    return {m.shape->depth, {m.shape->box.low + m.by, m.shape->box.high + m.by}};
  }
  Known operator()(const Turned& t) const {
    require_shape("operand of turn", t.shape);
    require_direction("turn axis", t.axis);
    require(std::abs(t.angle) <= kMostLength, "turn angle", t.angle, "between -2^30 and 2^30");
    const ShapeBox& box = t.shape->box;
    if (box.empty()) return {t.shape->depth, {}};
    const Turn turn = turn_about(t.axis, t.angle);
    ShapeBox turned{dvec3(0.0), dvec3(0.0)};
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        const double m = turn[row][col];
        if (m == 0) continue;
        turned.low[row] += m * (m > 0 ? box.low : box.high)[col];
        turned.high[row] += m * (m > 0 ? box.high : box.low)[col];
      }
    }
    return {t.shape->depth, turned};
  }
  Known operator()(const Scaled& s) const {
    require_shape("operand of scale", s.shape);
    require_length("scale factor", s.factor);
    return {s.shape->depth, {s.shape->box.low * s.factor, s.shape->box.high * s.factor}};
  }
  Known operator()(const Repeated& r) const {
    require_shape("operand of repeat", r.shape);
    ShapeBox box = r.shape->box;
    for (int axis = 0; axis < 3; ++axis) {
      const double period = r.period[axis];
      if (period == 0) continue;
      const char name = "xyz"[axis];
      require_length(fmt::format("repeat period {}", name), period);
      require(r.count[static_cast<std::size_t>(axis)] >= 0 && r.count[static_cast<std::size_t>(axis)] <= 1 << 30,
              fmt::format("repeat count {}", name), r.count[static_cast<std::size_t>(axis)], "between 0 and 2^30");
      if (box.empty()) continue;
      const double extent = box.high[axis] - box.low[axis];
      // Boxes include rounding, so copies that touch pass the check.
      require(extent <= period * (1 + 0x1p-40), fmt::format("repeat period {}", name), period,
              fmt::format("at least {:.6g}, the length of the repeated shape", extent));
      const int count = r.count[static_cast<std::size_t>(axis)];
      const double more = count == 0 ? kInfinity : count * period;
      box.low[axis] -= more, box.high[axis] += more;
    }
    return {r.shape->depth, box};
  }
  Known operator()(const Union& u) const {
    require_smooth("union", u.smooth);
    Known known = first_of("union", u.parts);
    for (const Shape& part : u.parts) {
      known.under = std::max(known.under, part->depth);
      known.box = hull(known.box, part->box);
    }
    // Each smooth minimum is lower than its operands by at most a quarter of the radius.
    known.box = widened(known.box, 0.25 * u.smooth * static_cast<double>(u.parts.size() - 1));
    return known;
  }
  Known operator()(const Intersection& i) const {
    require_smooth("intersection", i.smooth);
    Known known = first_of("intersection", i.parts);
    for (const Shape& part : i.parts) {
      known.under = std::max(known.under, part->depth);
      known.box = common(known.box, part->box);
    }
    return known;
  }
  Known operator()(const Subtraction& s) const {
    require_smooth("subtraction", s.smooth);
    require_shape("first operand of subtraction", s.from);
    require_shape("second operand of subtraction", s.what);
    return {std::max(s.from->depth, s.what->depth), s.from->box};
  }
  Known operator()(const Painted& p) const {
    require_shape("operand of material", p.shape);
    require(p.material >= 0 && p.material <= kMostMaterial, "material", p.material, "between 0 and 65535");
    return {p.shape->depth, p.shape->box};
  }

  static Known first_of(std::string_view what, const std::vector<Shape>& parts) {
    if (parts.empty()) throw Error(fmt::format("shape: {} without parts (at least one required)", what));
    for (std::size_t i = 0; i < parts.size(); ++i) require_shape(fmt::format("{} part {}", what, i), parts[i]);
    return {parts.front()->depth, parts.front()->box};
  }
};

}  // namespace

bool ShapeBox::finite() const {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(low[axis]) || !std::isfinite(high[axis])) return false;
  }
  return true;
}

Shape make_shape(shape::Form form) {
  const Known known = std::visit(Check{}, form);
  const int depth = 1 + known.under;
  if (depth > kDeepestShape) {
    throw Error(fmt::format("shape: nested {} deep (limited to {})", depth, kDeepestShape));
  }
  return std::make_shared<const ShapeNode>(ShapeNode{std::move(form), depth, widened(known.box)});
}

}  // namespace scarp
