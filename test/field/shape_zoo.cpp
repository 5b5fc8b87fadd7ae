// SPDX-License-Identifier: MIT
#include "field/shape_zoo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <glm/vector_relational.hpp>

#include "scarp/accel/slope_bound.h"
#include "scarp/accel/solid_ground.h"

namespace scarp::test {

using namespace shape;

namespace {

Shape moved(const Shape& s, const dvec3& by) { return make_shape(Moved{s, by}); }

Shape field_ground(Surface surface) {
  std::vector<float> samples;
  FunctionRandom random(7);
  for (int i = 0; i < 9 * 7; ++i) samples.push_back(static_cast<float>(random.between(-1, 2)));
  const auto field = std::make_shared<HeightField>(
      HeightField::own(std::move(samples), 9, 7, {.cell_x = 2, .cell_y = 1.5, .surface = surface}));
  return make_shape(FieldGround{field, slope_bound(*field)});
}

// Holes at the border, in the middle, and two that touch at a corner.
Shape field_with_holes() {
  std::vector<float> samples;
  FunctionRandom random(7);
  for (int i = 0; i < 13 * 11; ++i) samples.push_back(static_cast<float>(random.between(-1, 2)));
  for (const int i : {0, 13 * 4 + 4, 13 * 4 + 5, 13 * 8 + 9, 13 * 6 + 12}) {
    samples[static_cast<std::size_t>(i)] = std::numeric_limits<float>::quiet_NaN();
  }
  return make_shape(solid_ground(
      std::make_shared<HeightField>(HeightField::own(std::move(samples), 13, 11, {.cell_x = 2, .cell_y = 1.5}))));
}

Shape function_ground() {
  const Fractal hills{.wavelength = 20, .height = 3, .octaves = {5, 5, 5}};
  return make_shape(FunctionGround{std::make_shared<HeightFunction>(make_function(hills))});
}

}  // namespace

std::vector<NamedShape> shape_zoo() {
  const Shape ball = make_shape(Sphere{2}), block = make_shape(Box{{3, 2, 1}});
  const Shape ring = make_shape(Torus{3, 0.7}), pillar = make_shape(Cylinder{1, 4});
  const Shape tilted = make_shape(Turned{block, {1, 2, 3}, 0.7});
  std::vector<Shape> many;
  FunctionRandom random(3);
  for (int i = 0; i < 40; ++i) {
    const dvec3 at(random.between(-15, 15), random.between(-15, 15), random.between(-15, 15));
    many.push_back(moved(make_shape(Painted{random_solid(random), i}), at));
  }
  const Shape village =
      make_shape(Union{{function_ground(), moved(ball, {0, 0, 2}), moved(tilted, {8, 3, 1}), moved(ring, {-6, 5, 3})}});
  return {
      {"sphere", ball},
      {"box", block},
      {"rounded box", make_shape(Box{{3, 2, 1}, 0.5})},
      {"half space", make_shape(HalfSpace{{1, 2, -2}, 1.5})},
      {"floor", make_shape(HalfSpace{{0, 0, 1}, -1})},
      {"capsule", make_shape(Capsule{{-2, 1, 0}, {3, 2, 4}, 0.8})},
      {"cylinder", pillar},
      {"cone", make_shape(Cone{2, 5})},
      {"frustum", make_shape(Cone{3, 2, 1.2})},
      {"torus", ring},
      {"spindle torus", make_shape(Torus{1, 2})},
      {"ellipsoid", make_shape(Ellipsoid{{4, 1, 2}})},
      {"turned box", tilted},
      {"scaled, moved torus", moved(make_shape(Scaled{ring, 1.7}), {3, -2, 1})},
      {"union", make_shape(Union{{ball, moved(block, {2, 1, 0.5}), moved(pillar, {-3, 0, 0})}})},
      {"intersection", make_shape(Intersection{{ball, tilted, make_shape(HalfSpace{{0, 1, 1}, 0.5})}})},
      {"subtraction", make_shape(Subtraction{block, moved(ball, {2, 1, 1})})},
      {"smooth union", make_shape(Union{{moved(ball, {0, 0, 1}), block, ring}, 0.8})},
      {"smooth intersection", make_shape(Intersection{{ball, tilted}, 0.5})},
      {"smooth subtraction", make_shape(Subtraction{tilted, ball, 0.6})},
      {"row",
       make_shape(Repeated{make_shape(Turned{make_shape(Cone{0.7, 2}), {1, 0, 0}, 0.4}), {2.5, 0, 0}, {4, 0, 0}})},
      {"lattice", make_shape(Repeated{make_shape(Union{{make_shape(Sphere{0.6}),
                                                        moved(make_shape(Box{{0.3, 0.2, 0.8}}), {0.4, 0.5, 0})}}),
                                      {3, 2.5, 4},
                                      {0, 3, 2}})},
      {"touching lattice of bounds", make_shape(Repeated{make_shape(Ellipsoid{{1, 0.5, 0.7}}), {2, 1, 0}})},
      {"forty solids", make_shape(Union{many})},
      {"field", field_ground(Surface::bilinear)},
      {"field of triangles", field_ground(Surface::triangles)},
      {"field with holes", field_with_holes()},
      {"quarry with holes", make_shape(Subtraction{make_shape(Turned{field_with_holes(), {1, 1, 4}, 0.5}),
                                                   moved(make_shape(Sphere{3}), {8, 4, 1})})},
      {"function", function_ground()},
      {"village", village},
      {"quarry", make_shape(Subtraction{field_ground(Surface::bilinear),
                                        moved(make_shape(Painted{make_shape(Sphere{3}), 5}), {8, 4, 1})})},
      {"cave", make_shape(Subtraction{village, moved(make_shape(Sphere{4}), {3, 1, 0}), 1})},
  };
}

Shape random_solid(FunctionRandom& random) {
  const auto size = [&] { return random.between(0.2, 2); };
  switch (static_cast<int>(random.between(0, 8))) {
    case 0:
      return make_shape(Sphere{size()});
    case 1: {
      const dvec3 half(size(), size(), size());
      return make_shape(
          Box{half, random.between(0, 1) < 0.5 ? 0 : random.between(0, std::min({half.x, half.y, half.z}))});
    }
    case 2:
      return make_shape(Capsule{{size(), -size(), size()}, {-size(), size(), size()}, size()});
    case 3:
      return make_shape(Cylinder{size(), size()});
    case 4: {
      const double radius = size();
      return make_shape(Cone{radius, size(), random.between(0, 1) < 0.5 ? 0 : random.between(0, radius)});
    }
    case 5:
      return make_shape(Torus{size(), 0.3 * size()});
    case 6:
      return make_shape(Ellipsoid{{size(), size(), size()}});
    default:
      return make_shape(
          Intersection{{make_shape(Sphere{size()}), make_shape(HalfSpace{{size(), -size(), size()}, 0.1})}});
  }
}

Shape random_shape(FunctionRandom& random, int depth, bool smooth) {
  if (depth <= 1) return random_solid(random);
  const auto one = [&] { return random_shape(random, depth - 1, smooth); };
  const auto part = [&] { return moved(one(), {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)}); };
  const double radius = smooth && random.between(0, 1) < 0.6 ? random.between(0.1, 1) : 0;
  switch (static_cast<int>(random.between(0, 8))) {
    case 0:
      return make_shape(Union{{part(), part(), part()}, radius});
    case 1:
      return make_shape(Intersection{{part(), part()}, radius});
    case 2:
    case 3:
      return make_shape(Subtraction{part(), part(), radius});
    case 4:
      return make_shape(Turned{part(), {random.between(-1, 1), random.between(-1, 1), 1}, random.between(-3, 3)});
    case 5:
      return make_shape(Scaled{part(), random.between(0.3, 3)});
    case 6: {
      const Shape s = one();
      if (s->box.empty()) return s;
      const dvec3 extent = s->box.high - s->box.low;
      dvec3 period(0.0);
      std::array<int, 3> count{};
      for (int axis = 0; axis < 3; ++axis) {
        if (random.between(0, 1) < 0.5) period[axis] = extent[axis] * random.between(1.0001, 1.5);
        count[static_cast<std::size_t>(axis)] = static_cast<int>(random.between(0, 3));
        // Unbounded repetitions cannot be repeated again, so all are bounded.
        if (count[static_cast<std::size_t>(axis)] == 0) count[static_cast<std::size_t>(axis)] = 1;
      }
      return make_shape(Repeated{s, period, count});
    }
    default:
      return make_shape(Painted{part(), static_cast<int>(random.between(0, 9))});
  }
}

namespace {

double squared(double x) { return x * x; }

struct Holds {
  dvec3 p;

  bool operator()(const Sphere& s) const { return dot(p, p) <= squared(s.radius); }
  bool operator()(const Box& b) const {
    double beyond = 0;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(p[i]) > b.half[i]) return false;
      beyond += squared(std::max(0.0, std::abs(p[i]) - (b.half[i] - b.round)));
    }
    return beyond <= squared(b.round) || b.round == 0;
  }
  bool operator()(const HalfSpace& h) const { return dot(p, h.normal) <= h.height * length(h.normal); }
  bool operator()(const Capsule& c) const {
    const dvec3 along = c.to - c.from;
    const double share = std::clamp(dot(p - c.from, along) / dot(along, along), 0.0, 1.0);
    const dvec3 away = p - (c.from + share * along);
    return dot(away, away) <= squared(c.radius);
  }
  bool operator()(const Cylinder& c) const {
    return std::abs(p.z) <= c.half_height && squared(p.x) + squared(p.y) <= squared(c.radius);
  }
  bool operator()(const Cone& c) const {
    if (p.z < 0 || p.z > c.height) return false;
    return squared(p.x) + squared(p.y) <= squared(c.radius + (c.top - c.radius) * p.z / c.height);
  }
  bool operator()(const Torus& t) const {
    // A spindle torus is filled: inside it, the quartic changes sign a second time.
    const double r = std::sqrt(squared(p.x) + squared(p.y));
    return squared(r - t.radius) + squared(p.z) <= squared(t.tube);
  }
  bool operator()(const Ellipsoid& e) const {
    return squared(p.x / e.radii.x) + squared(p.y / e.radii.y) + squared(p.z / e.radii.z) <= 1;
  }
  bool operator()(const FunctionGround& g) const { return p.z <= g.function->value(p.x, p.y); }
  bool operator()(const FieldGround& g) const {
    const auto h = (g.holes ? g.holes : g.field)->height(p.x, p.y);
    return h && p.z <= *h;
  }
  bool operator()(const Moved& m) const { return solid_holds(m.shape, p - m.by); }
  bool operator()(const Turned& t) const {
    const dvec3 n = normalize(t.axis);
    const double c = std::cos(t.angle), s = -std::sin(t.angle);
    return solid_holds(t.shape, c * p + s * cross(n, p) + (1 - c) * dot(n, p) * n);
  }
  bool operator()(const Scaled& s) const { return solid_holds(s.shape, p / s.factor); }
  bool operator()(const Repeated& r) const {
    std::array<double, 3> from{}, to{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double period = r.period[static_cast<int>(i)];
      if (period == 0) continue;
      const double near = std::round(p[static_cast<int>(i)] / period), count = r.count[i];
      // Shapes may be at any position: more than enough copies.
      from[i] = near - 20, to[i] = near + 20;
      if (count > 0) from[i] = -count, to[i] = count;
    }
    for (double x = from[0]; x <= to[0]; ++x) {
      for (double y = from[1]; y <= to[1]; ++y) {
        for (double z = from[2]; z <= to[2]; ++z) {
          const dvec3 q = p - dvec3(x, y, z) * r.period;
          const ShapeBox& box = r.shape->box;
          if (glm::all(glm::greaterThanEqual(q, box.low)) && glm::all(glm::lessThanEqual(q, box.high)) &&
              solid_holds(r.shape, q)) {
            return true;
          }
        }
      }
    }
    return false;
  }
  bool operator()(const Union& u) const {
    return std::any_of(u.parts.begin(), u.parts.end(), [&](const Shape& s) { return solid_holds(s, p); });
  }
  bool operator()(const Intersection& i) const {
    return std::all_of(i.parts.begin(), i.parts.end(), [&](const Shape& s) { return solid_holds(s, p); });
  }
  bool operator()(const Subtraction& s) const { return solid_holds(s.from, p) && !solid_holds(s.what, p); }
  bool operator()(const Painted& painted) const { return solid_holds(painted.shape, p); }
};

}  // namespace

bool solid_holds(const Shape& shape, const dvec3& p) { return std::visit(Holds{p}, shape->form); }

}  // namespace scarp::test
