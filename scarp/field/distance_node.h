// SPDX-License-Identifier: MIT
// Shapes: small immutable trees of solids that describe a distance field.
//
//   const Shape ball = make_shape(shape::Sphere{.radius = 3});
//   const Shape bowl = make_shape(shape::Subtraction{
//       .from = make_shape(shape::Box{.half = {5, 5, 2}}),
//       .what = make_shape(shape::Moved{ball, {0, 0, 2}}), .smooth = 0.5});
//
// Every solid is upright at its own origin, z up; Moved, Turned and Scaled place it elsewhere. Trees may share nodes.
// Lengths are metres, angles radians. make_shape() rejects settings out of range, so every Shape is valid.
// Formulas: J. C. Hart, "Sphere tracing", The Visual Computer 12, 1996.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "scarp/base/vec.h"
#include "scarp/field/height_field.h"
#include "scarp/field/height_function.h"

namespace scarp {

struct ShapeNode;
using Shape = std::shared_ptr<const ShapeNode>;

/// Range of lengths, in metres.
inline constexpr double kLeastLength = 0x1p-20;
inline constexpr double kMostLength = 0x1p30;
/// Maximum depth of a tree.
inline constexpr int kDeepestShape = 256;
/// Materials range from 0 to kMostMaterial.
inline constexpr int kMostMaterial = 65535;

/// A closed axis-aligned box. Infinite on unbounded sides; empty if low > high.
struct ShapeBox {
  dvec3 low{std::numeric_limits<double>::infinity()};
  dvec3 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  bool finite() const;
};

namespace shape {

/// A ball.
struct Sphere {
  double radius = 1;
};
/// A box with edge lengths 2 * half. `round` rounds edges and corners inwards.
struct Box {
  dvec3 half{0.5};
  double round = 0;  ///< radius, between 0 and the smallest half
};
/// All points on or behind a plane.
struct HalfSpace {
  dvec3 normal{0, 0, 1};  ///< outward; any non-zero length
  double height = 0;      ///< of the plane above the origin, along the normal
};
/// All points within `radius` of the segment between both ends.
struct Capsule {
  dvec3 from{0, 0, -1}, to{0, 0, 1};
  double radius = 0.5;
};
/// Upright, from -half_height to half_height.
struct Cylinder {
  double radius = 1, half_height = 1;
};
/// Upright, from a disc at z = 0 to a point or a smaller disc at z = height.
struct Cone {
  double radius = 1, height = 2;
  double top = 0;  ///< radius at the top, between 0 and `radius`
};
/// A ring around the z axis. If the tube is thicker than the ring, the inside is solid and the value there is a bound.
struct Torus {
  double radius = 2;  ///< of the tube's centre line, >= 0
  double tube = 0.5;  ///< radius of the tube
};
/// A bound, not the exact distance: too short by at most the factor largest / smallest radius, mostly beyond the long
/// ends.
struct Ellipsoid {
  dvec3 radii{1, 1, 0.5};
};
/// Function terrain, solid below. A bound: the height above the ground / sqrt(1 + c^2), where c is the certified slope
/// over the whole plane.
struct FunctionGround {
  std::shared_ptr<const HeightFunction> function;
};
/// Height-field terrain, solid below, with vertical walls at its borders and around its holes, which are bottomless
/// shafts. A bound like FunctionGround. Made by solid_ground() (accel/solid_ground.h). The field must not be edited
/// during queries; a steeper slope or other holes require a new shape.
struct FieldGround {
  std::shared_ptr<const HeightField> field;    ///< without holes, or with filled ones
  double slope = 0;                            ///< slope_bound(*field), accel/slope_bound.h
  std::shared_ptr<const HeightField> holes{};  ///< field that defines the holes, on the same grid; null: no holes
};

/// Translates a shape.
struct Moved {
  Shape shape;
  dvec3 by{0.0};
};
/// Rotates a shape about an axis through the origin.
struct Turned {
  Shape shape;
  dvec3 axis{0, 0, 1};  ///< any non-zero length
  double angle = 0;     ///< counter-clockwise, seen from the tip of the axis
};
/// Scales a shape about the origin.
struct Scaled {
  Shape shape;
  double factor = 1;  ///< > 0, uniform
};
/// Repeats the shape `period` apart along each axis with a period. The shape must not be larger than the period, so
/// that only two copies per axis can be the nearest.
struct Repeated {
  Shape shape;
  dvec3 period{0.0};                  ///< 0: not repeated along this axis
  std::array<int, 3> count{0, 0, 0};  ///< copies on each side of the first; 0: unlimited
};

/// Points in any of the parts.
struct Union {
  std::vector<Shape> parts;  ///< at least one
  double smooth = 0;         ///< radius of the smooth blend, applied part by part
};
/// Points in all of the parts.
struct Intersection {
  std::vector<Shape> parts;  ///< at least one
  double smooth = 0;
};
/// Points of `from` outside `what`. The cut surface has the material of `what`.
struct Subtraction {
  Shape from, what;
  double smooth = 0;
};
/// Assigns a material to all parts that have none of their own.
struct Painted {
  Shape shape;
  int material = 0;
};

using Form = std::variant<Sphere, Box, HalfSpace, Capsule, Cylinder, Cone, Torus, Ellipsoid, FunctionGround,
                          FieldGround, Moved, Turned, Scaled, Repeated, Union, Intersection, Subtraction, Painted>;

}  // namespace shape

/// An immutable node of a shape.
struct ShapeNode {
  shape::Form form;
  int depth;     ///< 1: a leaf
  ShapeBox box;  ///< bounding box, tight where that is cheap to compute
};

/// Throws Error for a setting out of range (by name), a missing operand, a field with holes, a repeated shape larger
/// than its period, or a tree deeper than kDeepestShape.
Shape make_shape(shape::Form form);

}  // namespace scarp
