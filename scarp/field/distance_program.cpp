// SPDX-License-Identifier: MIT
#include "scarp/field/distance_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/field/distance_turn.h"

namespace scarp {
namespace {

using namespace shape;

constexpr std::size_t kMostInstructions = 16384;

// Frame of a shape: a point p of the register is at turn (p - at) / scale in the shape's own coordinates.
struct ShapeFrame {
  Turn turn = kNoTurn;
  dvec3 at{0.0};
  double scale = 1;
  int position = 0;  // register
  double chain = 0;  // sum of the translations into the register, metres
  int turns = 0;     // rotations into the register
  int material = 0;

  bool upright() const { return turn == kNoTurn; }
  dvec3 out(const dvec3& local) const { return at + scale * turned(back(turn), local); }
};

ShapeBox box_in_register(const ShapeFrame& place, const ShapeBox& box) {
  if (box.empty()) return box;
  const Turn m = back(place.turn);
  ShapeBox out{place.at, place.at};
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      const double k = m[static_cast<std::size_t>(row)][col] * place.scale;
      if (k == 0) continue;
      out.low[row] += k * (k > 0 ? box.low : box.high)[col];
      out.high[row] += k * (k > 0 ? box.high : box.low)[col];
    }
    // More than the roundings above.
    out.low[row] -= 0x1p-49 * (std::abs(out.low[row]) + std::abs(place.at[row]));
    out.high[row] += 0x1p-49 * (std::abs(out.high[row]) + std::abs(place.at[row]));
  }
  return out;
}

bool bounds_anything(const ShapeBox& box) {
  if (box.empty()) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(box.low[axis]) || std::isfinite(box.high[axis])) return true;
  }
  return false;
}

// Whether values outside a shape are the exact distance.
bool is_exact_outside(const Shape& shape) {
  return std::visit(
      [](const auto& form) {
        using Of = std::decay_t<decltype(form)>;
        if constexpr (std::is_same_v<Of, Ellipsoid> || std::is_same_v<Of, FunctionGround> ||
                      std::is_same_v<Of, FieldGround> || std::is_same_v<Of, Intersection> ||
                      std::is_same_v<Of, Subtraction>) {
          return false;
        } else if constexpr (std::is_same_v<Of, Moved> || std::is_same_v<Of, Turned> || std::is_same_v<Of, Scaled> ||
                             std::is_same_v<Of, Painted> || std::is_same_v<Of, Repeated>) {
          return is_exact_outside(form.shape);
        } else if constexpr (std::is_same_v<Of, Union>) {
          return form.smooth == 0 && std::all_of(form.parts.begin(), form.parts.end(), is_exact_outside);
        } else {
          return true;
        }
      },
      shape->form);
}

// Cost of evaluating a shape.
enum class Cost { single, several, ground };
Cost cost_of(const Shape& shape) {
  return std::visit(
      [](const auto& form) {
        using Of = std::decay_t<decltype(form)>;
        if constexpr (std::is_same_v<Of, FunctionGround> || std::is_same_v<Of, FieldGround>) {
          return Cost::ground;
        } else if constexpr (std::is_same_v<Of, Moved> || std::is_same_v<Of, Turned> || std::is_same_v<Of, Scaled> ||
                             std::is_same_v<Of, Painted>) {
          return cost_of(form.shape);
        } else if constexpr (std::is_same_v<Of, Repeated>) {
          return std::max(Cost::several, cost_of(form.shape));
        } else if constexpr (std::is_same_v<Of, Union> || std::is_same_v<Of, Intersection>) {
          Cost most = Cost::several;
          for (const Shape& part : form.parts) most = std::max(most, cost_of(part));
          return most;
        } else if constexpr (std::is_same_v<Of, Subtraction>) {
          return std::max({Cost::several, cost_of(form.from), cost_of(form.what)});
        } else {
          return Cost::single;
        }
      },
      shape->form);
}

class Compiler {
 public:
  DistanceProgram program(const Shape& shape) {
    emit(shape, ShapeFrame{}, 0);
    constexpr double kUnit = 0x1p-53;
    // Number of roundings of a solid, of each rotation before it, and of each smooth operation in sequence. The maxima
    // counted are 20, 8 and 10.
    const double roundings = 32 + 16.0 * turns_ + 16.0 * smooth_ + (program_.fields.empty() ? 0 : 48);
    program_.rounding_per_metre = kUnit * roundings;
    program_.rounding = kUnit * roundings * (size_ + radii_);
    return std::move(program_);
  }

 private:
  void emit(const Shape& shape, const ShapeFrame& place, int out) {
    // Position registers of a shape become free after it.
    const int positions = positions_;
    std::visit([&](const auto& form) { put(form, *shape, place, out); }, shape->form);
    positions_ = positions;
  }

  // Solids.
  void put(const Sphere& s, const ShapeNode&, const ShapeFrame& place, int out) {
    solid(DistanceOp::sphere, place, out, {s.radius});
  }
  void put(const Box& b, const ShapeNode&, ShapeFrame place, int out) {
    place = straightened(place);
    const dvec3 core = b.half - b.round;
    solid(DistanceOp::box, place, out, {core.x, core.y, core.z, b.round});
  }
  void put(const HalfSpace& p, const ShapeNode&, const ShapeFrame& place, int out) {
    const dvec3 n = turned(back(place.turn), normalize(p.normal));
    const double height = p.height * place.scale + dot(n, place.at);
    add({.op = DistanceOp::plane, .out = value(out), .a = position(place), .number = numbers({n.x, n.y, n.z, height})},
        place);
    note(place, std::abs(p.height) * place.scale);
  }
  void put(const Capsule& c, const ShapeNode&, const ShapeFrame& place, int out) {
    const dvec3 along = c.to - c.from;
    const double half = 0.5 * length(along);
    ShapeFrame local = place;
    local.at = place.out(0.5 * (c.from + c.to));
    if (half > 0) {
      // The shortest rotation of the axis onto z.
      const dvec3 n = along / (2 * half), axis(n.y, -n.x, 0);
      if (length(axis) > 0) {
        local.turn = after(turn_about(axis, std::atan2(length(axis), n.z)), place.turn);
      }
    }
    local = straightened(local);
    solid(DistanceOp::capsule, local, out, {half, c.radius});
  }
  void put(const Cylinder& c, const ShapeNode&, ShapeFrame place, int out) {
    place = straightened(place);
    solid(DistanceOp::cylinder, place, out, {c.radius, c.half_height});
  }
  void put(const Cone& c, const ShapeNode&, ShapeFrame place, int out) {
    place.at = place.out({0, 0, 0.5 * c.height});
    place = straightened(place);
    solid(DistanceOp::cone, place, out, {c.radius, c.top, 0.5 * c.height});
  }
  void put(const Torus& t, const ShapeNode&, ShapeFrame place, int out) {
    place = straightened(place);
    solid(DistanceOp::torus, place, out, {t.radius, t.tube});
  }
  void put(const Ellipsoid& e, const ShapeNode& node, ShapeFrame place, int out) {
    place = straightened(place);
    solid(DistanceOp::ellipsoid, place, out,
          {e.radii.x, e.radii.y, e.radii.z, std::min({e.radii.x, e.radii.y, e.radii.z})});
    clamp(place, node.box, out);
  }
  void put(const FunctionGround& g, const ShapeNode& node, ShapeFrame place, int out) {
    place = straightened(place);
    const FunctionBound& all = g.function->bound_everywhere();
    const double shrink = shrink_of(all.slope), scale = place.scale;
    ground(DistanceOp::function_ground, place, out, {scale, shrink}, program_.functions.size());
    program_.functions.push_back(g.function);
    program_.function_away.push_back(place.chain + length(place.at));
    note(place, scale * std::max(std::abs(all.low), std::abs(all.high)));
    for (std::size_t i = 0; i < program_.ground_rounding.size(); ++i) {
      const double reach =
          std::min(kFunctionReach, (std::ldexp(1.0, static_cast<int>(i)) + place.chain + length(place.at)) / scale);
      const double rounding = g.function->bound({-reach, reach, -reach, reach}).rounding;
      program_.ground_rounding[i] = std::max(program_.ground_rounding[i], rounding * shrink * scale);
    }
    clamp(place, node.box, out);
  }
  void put(const FieldGround& g, const ShapeNode& node, ShapeFrame place, int out) {
    place = straightened(place);
    const HeightField& field = *g.field;
    const double scale = place.scale;
    ground(DistanceOp::field_ground, place, out, {scale, shrink_of(g.slope), g.slope}, program_.fields.size());
    program_.fields.push_back(g.field);
    program_.holes.push_back(g.holes);
    note(place, scale * (std::max(std::abs(field.min_height()), std::abs(field.max_height())) + field.width() +
                         field.depth()));
    clamp(place, node.box, out);
  }

  // Places.
  void put(const Moved& m, const ShapeNode&, ShapeFrame place, int out) {
    place.at = place.out(m.by);
    emit(m.shape, place, out);
  }
  void put(const Turned& t, const ShapeNode&, ShapeFrame place, int out) {
    place.turn = after(back(turn_about(t.axis, t.angle)), place.turn);
    emit(t.shape, place, out);
  }
  void put(const Scaled& s, const ShapeNode&, ShapeFrame place, int out) {
    place.scale *= s.factor;
    if (!(place.scale >= kLeastLength && place.scale <= kMostLength)) {
      throw Error(fmt::format("shape: scale factors multiply to {} (must stay between 2^-20 and 2^30)", place.scale));
    }
    emit(s.shape, place, out);
  }
  void put(const Repeated& r, const ShapeNode& node, ShapeFrame place, int out) {
    const ShapeBox& box = r.shape->box;
    if (box.empty() || r.period == dvec3(0.0)) return emit(r.shape, place, out);
    place = straightened(place);
    std::array<double, 12> k{};
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const bool ends = std::isfinite(box.low[axis]) && std::isfinite(box.high[axis]);
      k[i] = ends ? place.at[axis] + place.scale * 0.5 * (box.low[axis] + box.high[axis]) : 0;
      k[9 + i] = ends ? place.scale * 0.5 * (box.high[axis] - box.low[axis]) : std::numeric_limits<double>::infinity();
      if (r.period[axis] == 0) continue;
      axes |= 1 << axis;
      k[3 + i] = place.scale * r.period[axis];
      k[6 + i] = r.count[i];
    }
    const std::uint32_t copies = numbers(k);
    ShapeFrame copy = place;
    copy.position = next_position();
    copy.turns += 1;  // a fold rounds no more than a rotation
    add({.op = DistanceOp::fold, .out = value(copy.position), .a = position(place), .number = copies}, place);
    emit(r.shape, copy, out);
    for (int mask = 1; mask < 8; ++mask) {
      if ((mask & axes) != mask) continue;
      const std::size_t skip = program_.code.size();
      add({.op = DistanceOp::skip_copy,
           .a = value(out),
           .b = position(place),
           .mask = static_cast<std::uint8_t>(mask),
           .number = copies},
          place);
      add({.op = DistanceOp::neighbour,
           .out = value(copy.position),
           .a = position(place),
           .mask = static_cast<std::uint8_t>(mask),
           .number = copies},
          place);
      emit(r.shape, copy, out + 1);
      add({.op = DistanceOp::unite, .out = value(out), .a = value(out), .b = value(out + 1)}, place);
      end_skip(skip);
    }
    const bool exact = is_exact_outside(r.shape);
    add({.op = DistanceOp::rest_bound,
         .out = value(out),
         .a = value(out),
         .b = position(place),
         .mask = exact,
         .number = copies},
        place);
    if (!exact) clamp(place, node.box, out);
  }

  // Operations.
  void put(const Union& u, const ShapeNode&, ShapeFrame place, int out) {
    // Drops empty parts: their values carry no information.
    std::vector<Shape> parts;
    for (const Shape& part : u.parts) {
      if (!part->box.empty()) parts.push_back(part);
    }
    if (parts.size() <= 1) return emit(parts.empty() ? u.parts.front() : parts.front(), place, out);
    place = straightened(place);
    if (u.smooth > 0) {
      emit(parts.front(), place, out);
      for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t skip = skip_far(parts[i], place, out, 0, u.smooth);
        emit(parts[i], place, out + 1);
        smooth(DistanceOp::smooth_unite, place, out, u.smooth);
        end_skip(skip);
      }
    } else {
      // Grounds last: they can be skipped where something else is near.
      std::vector<Shape> bounded, rest;
      for (const Shape& part : parts) (part->box.finite() ? bounded : rest).push_back(part);
      std::stable_sort(rest.begin(), rest.end(),
                       [](const Shape& a, const Shape& b) { return cost_of(a) < cost_of(b); });
      bool first = true;
      if (!bounded.empty()) unite_group(bounded, place, out, first);
      for (const Shape& part : rest) unite_one(part, place, out, first);
    }
  }
  void put(const Intersection& x, const ShapeNode& node, ShapeFrame place, int out) {
    if (x.parts.size() == 1) return emit(x.parts.front(), place, out);
    place = straightened(place);
    emit(x.parts.front(), place, out);
    for (std::size_t i = 1; i < x.parts.size(); ++i) {
      emit(x.parts[i], place, out + 1);
      if (x.smooth > 0) {
        smooth(DistanceOp::smooth_intersect, place, out, x.smooth);
      } else {
        add({.op = DistanceOp::intersect, .out = value(out), .a = value(out), .b = value(out + 1)}, place);
      }
    }
    clamp(place, node.box, out);
  }
  void put(const Subtraction& s, const ShapeNode&, ShapeFrame place, int out) {
    if (s.what->box.empty()) return emit(s.from, place, out);
    place = straightened(place);
    emit(s.from, place, out);
    const std::size_t skip = skip_far(s.what, place, out, 1, s.smooth);
    emit(s.what, place, out + 1);
    if (s.smooth > 0) {
      smooth(DistanceOp::smooth_subtract, place, out, s.smooth);
    } else {
      add({.op = DistanceOp::subtract, .out = value(out), .a = value(out), .b = value(out + 1)}, place);
    }
    end_skip(skip);
  }
  void put(const Painted& p, const ShapeNode&, ShapeFrame place, int out) {
    place.material = p.material;
    emit(p.shape, place, out);
  }

  void unite_one(const Shape& part, const ShapeFrame& place, int out, bool& first) {
    if (std::exchange(first, false)) return emit(part, place, out);
    const std::size_t skip = skip_far(part, place, out, 0, 0);
    emit(part, place, out + 1);
    add({.op = DistanceOp::unite, .out = value(out), .a = value(out), .b = value(out + 1)}, place);
    end_skip(skip);
  }
  // Splits the parts along the axis of their largest extent; each half is skipped if its box is far.
  void unite_group(std::span<Shape> parts, const ShapeFrame& place, int out, bool& first) {
    constexpr std::size_t kFew = 2;
    if (parts.size() <= kFew) {
      for (const Shape& part : parts) unite_one(part, place, out, first);
      return;
    }
    const auto middle = [](const Shape& part, int axis) { return part->box.low[axis] + part->box.high[axis]; };
    int axis = 0;
    double widest = -1;
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax_element(
          parts.begin(), parts.end(), [&](const Shape& a, const Shape& b) { return middle(a, i) < middle(b, i); });
      const double width = middle(*high, i) - middle(*low, i);
      if (width > widest) widest = width, axis = i;
    }
    const std::size_t half = parts.size() / 2;
    std::nth_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(half), parts.end(),
                     [&](const Shape& a, const Shape& b) { return middle(a, axis) < middle(b, axis); });
    for (const auto group : {parts.first(half), parts.subspan(half)}) {
      ShapeBox box;
      for (const Shape& part : group) {
        box.low = glm::min(box.low, part->box.low);
        box.high = glm::max(box.high, part->box.high);
      }
      const std::size_t skip = first ? kNoSkip : skip_box(box, place, out, 0, 0);
      unite_group(group, place, out, first);
      end_skip(skip);
    }
  }

  // Instructions.
  static constexpr std::size_t kNoSkip = ~std::size_t{0};

  void add(DistanceInstruction in, const ShapeFrame& place) {
    if (program_.code.size() == kMostInstructions) {
      throw Error(
          fmt::format("shape: more than {} instructions (use fewer solids, or several objects)", kMostInstructions));
    }
    in.material = static_cast<std::uint16_t>(place.material);
    program_.code.push_back(in);
  }
  std::uint32_t numbers(std::span<const double> k) {
    const auto begin = static_cast<std::uint32_t>(program_.numbers.size());
    program_.numbers.insert(program_.numbers.end(), k.begin(), k.end());
    return begin;
  }
  std::uint32_t numbers(std::initializer_list<double> k) { return numbers(std::span(k.begin(), k.size())); }
  std::uint32_t numbers(const ShapeBox& box, double radius) {
    return numbers({box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z, radius});
  }
  static std::uint8_t value(int out) {
    if (out >= kDistanceValues) too_many_registers();
    return static_cast<std::uint8_t>(out);
  }
  static std::uint8_t position(const ShapeFrame& place) { return static_cast<std::uint8_t>(place.position); }
  int next_position() {
    if (positions_ == kDistancePositions) too_many_registers();
    return positions_++;
  }
  [[noreturn]] static void too_many_registers() {
    throw Error(
        fmt::format("shape: needs more than {} positions or values at a time (nest less deeply)", kDistanceValues));
  }

  // Records, for the rounding bound, the size of a solid's numbers other than the position, in metres.
  void note(const ShapeFrame& place, double size) {
    size_ = std::max(size_, place.chain + length(place.at) + size);
    turns_ = std::max(turns_, place.turns);
  }
  void solid(DistanceOp op, const ShapeFrame& place, int out, std::initializer_list<double> lengths) {
    double size = 0;
    const std::uint32_t begin = numbers({place.at.x, place.at.y, place.at.z});
    for (const double k : lengths) {
      program_.numbers.push_back(k * place.scale);
      size += k * place.scale;
    }
    add({.op = op, .out = value(out), .a = position(place), .number = begin}, place);
    note(place, size);
  }
  void ground(DistanceOp op, const ShapeFrame& place, int out, std::initializer_list<double> k, std::size_t index) {
    const std::uint32_t begin = numbers({place.at.x, place.at.y, place.at.z});
    program_.numbers.insert(program_.numbers.end(), k);
    add({.op = op,
         .out = value(out),
         .a = position(place),
         .number = begin,
         .index = static_cast<std::uint32_t>(index)},
        place);
  }
  // 1 / sqrt(1 + c^2), rounded towards 0 by more than its three roundings.
  static double shrink_of(double slope) { return (1 - 0x1p-50) / std::hypot(1.0, slope); }

  void smooth(DistanceOp op, const ShapeFrame& place, int out, double radius) {
    add({.op = op, .out = value(out), .a = value(out), .b = value(out + 1), .number = numbers({radius * place.scale})},
        place);
    ++smooth_;
    radii_ += radius * place.scale;
  }
  void clamp(const ShapeFrame& place, const ShapeBox& local, int out) {
    const ShapeBox box = box_in_register(place, local);
    if (!bounds_anything(box)) return;
    add({.op = DistanceOp::clamp, .out = value(out), .a = value(out), .b = position(place), .number = numbers(box, 0)},
        place);
  }
  std::size_t skip_box(const ShapeBox& local, const ShapeFrame& place, int out, int mask, double radius) {
    const ShapeBox box = box_in_register(place, local);
    if (!bounds_anything(box)) return kNoSkip;
    add({.op = DistanceOp::skip_far,
         .a = value(out),
         .b = position(place),
         .mask = static_cast<std::uint8_t>(mask),
         .number = numbers(box, radius * place.scale)},
        place);
    return program_.code.size() - 1;
  }
  // Testing whether a single solid is far costs as much as evaluating it.
  std::size_t skip_far(const Shape& part, const ShapeFrame& place, int out, int mask, double radius) {
    return cost_of(part) == Cost::single ? kNoSkip : skip_box(part->box, place, out, mask, radius);
  }
  void end_skip(std::size_t skip) {
    if (skip == kNoSkip) return;
    program_.code[skip].index = static_cast<std::uint32_t>(program_.code.size() - skip - 1);
  }

  // Loads the frame into a register of its own, in which the shape is upright.
  ShapeFrame straightened(const ShapeFrame& place) {
    if (place.upright()) return place;
    ShapeFrame out;
    out.scale = place.scale;
    out.position = next_position();
    out.chain = place.chain + length(place.at);
    out.turns = place.turns + 1;
    out.material = place.material;
    std::array<double, 12> k{place.at.x, place.at.y, place.at.z};
    for (std::size_t row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) k[3 + 3 * row + static_cast<std::size_t>(col)] = place.turn[row][col];
    }
    add({.op = DistanceOp::turn, .out = value(out.position), .a = position(place), .number = numbers(k)}, place);
    return out;
  }

  DistanceProgram program_;
  int positions_ = 1;
  int turns_ = 0, smooth_ = 0;
  double size_ = 0, radii_ = 0;
};

}  // namespace

DistanceProgram compile(const Shape& shape) {
  if (!shape) throw Error("shape is missing (make one with make_shape())");
  return Compiler().program(shape);
}

}  // namespace scarp
