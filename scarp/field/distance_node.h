// SPDX-License-Identifier: MIT
// What a distance field is made of: a small tree of solids, read by whoever evaluates it.
//
//   const Shape ball = make_shape(shape::Sphere{.radius = 3});
//   const Shape bowl = make_shape(shape::Subtraction{
//       .from = make_shape(shape::Box{.half = {5, 5, 2}}),
//       .what = make_shape(shape::Moved{ball, {0, 0, 2}}), .smooth = 0.5});
//
// Every solid stands upright about its own origin, z up; Moved, Turned and Scaled put it elsewhere. A node never
// changes; trees may share nodes. Lengths are metres, angles radians. What is out of range is refused by make_shape(),
// so that a Shape that exists is good. Formulas: J. C. Hart, "Sphere tracing", The Visual Computer 12, 1996.
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

/// Lengths are between these, metres.
inline constexpr double kLeastLength = 0x1p-20;
inline constexpr double kMostLength = 0x1p30;
/// Nodes under one another.
inline constexpr int kDeepestShape = 256;
/// Materials are 0 to kMostMaterial.
inline constexpr int kMostMaterial = 65535;

/// A box along the axes, closed; infinite on sides where nothing bounds it, low above high when it is empty.
struct ShapeBox {
  dvec3 low{std::numeric_limits<double>::infinity()};
  dvec3 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  bool finite() const;
};

namespace shape {

struct Sphere {
  double radius = 1;
};
/// Of edges 2 * half; `round` is taken off the edges and corners, not added.
struct Box {
  dvec3 half{0.5};
  double round = 0;  ///< radius, 0 to the smallest half
};
/// All that is on or behind a plane.
struct HalfSpace {
  dvec3 normal{0, 0, 1};  ///< out of the solid; any length but 0
  double height = 0;      ///< of the plane over the origin, along the normal
};
/// All that is within radius of the line from one end to the other.
struct Capsule {
  dvec3 from{0, 0, -1}, to{0, 0, 1};
  double radius = 0.5;
};
/// Upright, from -half_height to half_height.
struct Cylinder {
  double radius = 1, half_height = 1;
};
/// Upright, from a disc at z = 0 to a point, or a smaller disc, at z = height.
struct Cone {
  double radius = 1, height = 2;
  double top = 0;  ///< radius up there, 0 to radius
};
/// A ring about the z axis. Solid where the tube is thicker than the ring, and then a bound inside.
struct Torus {
  double radius = 2;  ///< of the middle of the tube, >= 0
  double tube = 0.5;  ///< radius
};
/// A bound, not the distance: short by up to the largest radius over the smallest, off the long ends most.
struct Ellipsoid {
  dvec3 radii{1, 1, 0.5};
};
/// The ground of a function, solid below it. A bound: the height over the ground / sqrt(1 + c^2), c the certified slope
/// of the whole plane.
struct FunctionGround {
  std::shared_ptr<const HeightFunction> function;
};
/// The ground of a field, solid below it, with upright walls at its borders and round its holes, which are shafts
/// without a bottom. A bound likewise. Made by solid_ground() of accel/solid_ground.h. While the field is edited, no
/// query may run, and a steeper slope or other holes need a new shape.
struct FieldGround {
  std::shared_ptr<const HeightField> field;    ///< without holes, or with heights in their place
  double slope = 0;                            ///< slope_bound(*field) of accel/slope_bound.h
  std::shared_ptr<const HeightField> holes{};  ///< the field whose holes it has, on the same grid; null: it has none
};

struct Moved {
  Shape shape;
  dvec3 by{0.0};
};
struct Turned {
  Shape shape;
  dvec3 axis{0, 0, 1};  ///< any length but 0
  double angle = 0;     ///< counter-clockwise as seen from the axis' end
};
struct Scaled {
  Shape shape;
  double factor = 1;  ///< > 0, the same in all directions
};
/// The shape again and again, `period` apart along each axis that has one. It must be no longer than the period there:
/// then one of two copies per axis is the nearest.
struct Repeated {
  Shape shape;
  dvec3 period{0.0};                  ///< 0: not along this axis
  std::array<int, 3> count{0, 0, 0};  ///< copies on each side of the first; 0: without end
};

/// What is in any of the parts.
struct Union {
  std::vector<Shape> parts;  ///< at least one
  double smooth = 0;         ///< radius within which surfaces flow into one another; one part after the other
};
/// What is in all of the parts.
struct Intersection {
  std::vector<Shape> parts;  ///< at least one
  double smooth = 0;
};
/// `from` without `what`, whose material shows in the cut.
struct Subtraction {
  Shape from, what;
  double smooth = 0;
};
/// The material of all parts that have none of their own.
struct Painted {
  Shape shape;
  int material = 0;
};

using Form = std::variant<Sphere, Box, HalfSpace, Capsule, Cylinder, Cone, Torus, Ellipsoid, FunctionGround,
                          FieldGround, Moved, Turned, Scaled, Repeated, Union, Intersection, Subtraction, Painted>;

}  // namespace shape

struct ShapeNode {
  shape::Form form;
  int depth;     ///< 1: no node under it
  ShapeBox box;  ///< around the solid, as tight as it is cheap
};

/// Throws Error naming the setting that is out of range, a missing operand, a field with holes, a repeated shape that
/// is longer than its period, or more nodes under one another than kDeepestShape.
Shape make_shape(shape::Form form);

}  // namespace scarp
