// SPDX-License-Identifier: MIT
// Distance fields: the sign matches set membership, values change by at most one metre per metre, bounds are never
// exceeded, gradients match finite differences, settings are checked.
#include "scarp/field/distance_field.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "base/refusal.h"
#include "cases.h"
#include "field/shape_zoo.h"
#include "scarp/base/error.h"
#include "scarp/field/distance_run.h"

namespace scarp::test {
namespace {

using namespace shape;

const int kPlaces = cases(10'000, 2000, 400);
constexpr double kReach = 60;  // of the positions below, from the origin

dvec3 anywhere(FunctionRandom& random, double reach = 20) {
  return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

// A position near the surface, reached from a random position along the gradient.
dvec3 near_surface(const DistanceField& field, FunctionRandom& random, double spread = 1e-3) {
  dvec3 p = anywhere(random, 12);
  // Bounds are short by up to a factor of 4 in the zoo.
  for (int i = 0; i < 40; ++i) {
    const dvec3 g = field.gradient(p), next = p - field.value(p) * g;
    if (std::max({std::abs(next.x), std::abs(next.y), std::abs(next.z)}) > 30) break;
    p = next;
  }
  return p + anywhere(random, spread);
}

dvec3 some_position(const DistanceField& field, FunctionRandom& random) {
  return random.between(0, 1) < 0.5 ? anywhere(random) : near_surface(field, random);
}

bool is_smooth(const std::string& name) { return name.starts_with("smooth") || name == "cave"; }

void expect_sign_of_sets(const DistanceField& field, const Shape& shape, const dvec3& p, const std::string& name) {
  const double f = field.value(p), e = field.rounding(kReach);
  // The inequalities round as well.
  const double slack = e + 1e-12 * kReach;
  if (f > slack) {
    ASSERT_FALSE(solid_holds(shape, p)) << name << ": outside, by " << f << " m";
  }
  if (f < -slack) {
    ASSERT_TRUE(solid_holds(shape, p)) << name << ": inside, by " << f << " m";
  }
}

void expect_lipschitz(const DistanceField& field, const dvec3& p, const dvec3& q, const std::string& name) {
  const double change = std::abs(field.value(p) - field.value(q)), apart = length(p - q);
  ASSERT_LE(change, apart + 2 * field.rounding(kReach)) << name << ": over " << apart << " m";
}

void expect_box(const DistanceField& field, const dvec3& p, const std::string& name) {
  const ShapeBox& box = field.box();
  if (box.empty()) return;
  const double k[6] = {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z};
  const double away = distance::outside(p, k);
  if (away > 0) {
    ASSERT_GE(field.value(p), away - field.rounding(kReach)) << name << ": out of its box";
  }
}

TEST(DistanceField, SignMatchesSetMembership) {
  for (const NamedShape& named : shape_zoo()) {
    if (is_smooth(named.name)) continue;
    const DistanceField field(named.shape);
    FunctionRandom random(1);
    int inside = 0;
    for (int i = 0; i < kPlaces; ++i) {
      const dvec3 p = some_position(field, random);
      inside += field.value(p) < 0;
      expect_sign_of_sets(field, named.shape, p, named.name);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(inside, kPlaces / 20) << named.name;
    EXPECT_LT(inside, kPlaces - kPlaces / 20) << named.name;
  }
}

TEST(DistanceField, IsOneLipschitz) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    FunctionRandom random(2);
    for (int i = 0; i < kPlaces; ++i) {
      const dvec3 p = some_position(field, random);
      expect_lipschitz(field, p, anywhere(random), named.name);
      expect_lipschitz(field, p, p + anywhere(random, std::exp2(random.between(-30, 2))), named.name);
      expect_box(field, p, named.name);
      if (HasFatalFailure()) return;
    }
  }
}

// The same for random trees.
RC_GTEST_PROP(DistanceField, SignMatchesSetMembershipOnRandomTrees, (unsigned seed)) {
  FunctionRandom random(seed);
  const Shape shape = random_shape(random, 1 + static_cast<int>(seed % 4), false);
  const DistanceField field(shape);
  for (int i = 0; i < 40; ++i) {
    const dvec3 p = some_position(field, random);
    expect_sign_of_sets(field, shape, p, fmt::format("seed {}", seed));
    RC_ASSERT(!::testing::Test::HasFatalFailure());
  }
}

RC_GTEST_PROP(DistanceField, IsOneLipschitzOnRandomTrees, (unsigned seed)) {
  FunctionRandom random(seed);
  const DistanceField field(random_shape(random, 1 + static_cast<int>(seed % 4), true));
  for (int i = 0; i < 40; ++i) {
    const dvec3 p = some_position(field, random);
    expect_lipschitz(field, p, anywhere(random), fmt::format("seed {}", seed));
    expect_lipschitz(field, p, p + anywhere(random, 1e-3), fmt::format("seed {}", seed));
    expect_box(field, p, fmt::format("seed {}", seed));
    RC_ASSERT(!::testing::Test::HasFatalFailure());
  }
}

// Solids return the exact distance: the surface is this far along the gradient, and no nearer.
TEST(DistanceField, IsExactOutsideSingleSolids) {
  for (const NamedShape& named : shape_zoo()) {
    const bool exact = named.name.find("sphere") != std::string::npos || named.name == "box" ||
                       named.name == "rounded box" || named.name == "half space" || named.name == "capsule" ||
                       named.name == "cylinder" || named.name == "cone" || named.name == "frustum" ||
                       named.name.find("torus") != std::string::npos || named.name == "union" || named.name == "row";
    if (!exact) continue;
    const DistanceField field(named.shape);
    FunctionRandom random(3);
    for (int i = 0; i < kPlaces / 4; ++i) {
      const dvec3 p = anywhere(random);
      const double f = field.value(p);
      if (f <= 0) continue;
      const dvec3 foot = p - f * field.normal(p);
      // Normals are unit vectors within some roundings.
      ASSERT_NEAR(field.value(foot), 0, 4 * field.rounding(kReach)) << named.name;
    }
  }
}

TEST(DistanceField, RoundingStaysWithinItsBound) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    if (!field.program().functions.empty() || !field.program().fields.empty()) continue;  // heights are doubles
    FunctionRandom random(4);
    for (int i = 0; i < kPlaces; ++i) {
      const double reach = std::exp2(random.between(-2, 25));
      const dvec3 p = random.between(0, 1) < 0.5 ? anywhere(random, reach) : near_surface(field, random);
      const long double exact =
          distance::run(field.program(), distance::PointMode<long double>{}, distance::Vec<long double>(p)).value;
      const double error = static_cast<double>(std::abs(field.value(p) - exact));
      ASSERT_LE(error, field.rounding(length(p))) << named.name << ", " << length(p) << " m away";
    }
  }
}

TEST(DistanceField, GradientsMatchFiniteDifferences) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    FunctionRandom random(5);
    int creases = 0;
    const int samples = kPlaces / 4;
    for (int i = 0; i < samples; ++i) {
      const dvec3 p = i % 2 ? anywhere(random) : near_surface(field, random, 0.1);
      const auto differences = [&](double h) {
        dvec3 g;
        for (int axis = 0; axis < 3; ++axis) {
          dvec3 step(0.0);
          step[axis] = h;
          g[axis] = (field.value(p + step) - field.value(p - step)) / (2 * h);
        }
        return g;
      };
      const double h = 1e-4;
      const dvec3 coarse = differences(2 * h), fine = differences(h);
      // The error of central differences is a third of their change when the step is doubled.
      const double off = length(coarse - fine) + 4 * field.rounding(kReach) / h;
      creases += length(field.gradient(p) - fine) > off + 1e-7;
      ASSERT_NEAR(length(field.normal(p)), 1, 1e-12) << named.name;
    }
    // Positions closer than 0.1 mm to a crease are one in a hundred of those within 0.1 m of a surface's edge.
    EXPECT_LE(creases, samples / 100) << named.name;
  }
}

TEST(DistanceField, SegmentBoundsHold) {
  for (const NamedShape& named : shape_zoo()) {
    const DistanceField field(named.shape);
    std::string tightness = named.name + ": rest over length";
    for (const double size : {0.001, 0.03, 1.0, 20.0}) {
      FunctionRandom random(6);
      double rest = 0;
      const int segments = kPlaces / 40;
      for (int i = 0; i < segments; ++i) {
        const dvec3 from = some_position(field, random),
                    direction = normalize(anywhere(random)) * random.between(0.5, 2);
        const double t0 = random.between(-1, 1), t1 = t0 + size / length(direction);
        const dvec3 origin = from - t0 * direction;
        const DistanceSegment s = field.along(origin, direction, t0, t1);
        rest += s.rest / size;
        double last = 0;
        for (int k = 0; k <= 40; ++k) {
          const double q = k / 20.0 - 1, t = 0.5 * (t0 + t1) + 0.5 * (t1 - t0) * q;
          const double f = field.value(origin + t * direction);
          const double slack = 1e-13 * (kReach + std::abs(s.slope));
          ASSERT_LE(std::abs(f - (s.mid + s.slope * q)), s.rest + slack) << named.name << ", " << size << " m";
          ASSERT_GE(f, s.low - slack) << named.name << ", " << size << " m";
          ASSERT_LE(f, s.high + slack) << named.name << ", " << size << " m";
          if (k > 0) {
            const double rate = (f - last) * 20, off = 40 * field.rounding(kReach);
            ASSERT_GE(rate, s.rate_low - off) << named.name << ", " << size << " m";
            ASSERT_LE(rate, s.rate_high + off) << named.name << ", " << size << " m";
          }
          last = f;
        }
      }
      tightness += fmt::format("  {} m {:.2g}", size, rest / segments);
    }
    fmt::print("{}\n", tightness);
  }
}

// Guards may skip only nodes that cannot change the value.
TEST(DistanceField, UnionIsTheMinimumOfItsParts) {
  std::vector<Shape> parts;
  std::vector<DistanceField> fields;
  FunctionRandom random(8);
  for (int i = 0; i < 60; ++i) {
    const Shape part = make_shape(Moved{make_shape(Painted{random_shape(random, 2, true), i}), anywhere(random)});
    if (part->box.empty()) continue;
    parts.push_back(part);
    fields.emplace_back(part);
  }
  const DistanceField all(make_shape(Union{parts}));
  for (int i = 0; i < kPlaces / 10; ++i) {
    const dvec3 p = anywhere(random);
    double least = 1e300, next = 1e300;
    int material = -1;
    for (const DistanceField& field : fields) {
      const double f = field.value(p);
      if (f < least) {
        next = least, least = f, material = field.material(p);
      } else {
        next = std::min(next, f);
      }
    }
    ASSERT_NEAR(all.value(p), least, 2 * all.rounding(kReach));
    if (next - least > 4 * all.rounding(kReach)) {
      ASSERT_EQ(all.material(p), material);
    }
  }
}

TEST(DistanceField, KeepsMaterials) {
  const auto painted = [](const Shape& shape, int material) { return make_shape(Painted{shape, material}); };
  const Shape ball = painted(make_shape(Sphere{1}), 3), block = make_shape(Box{{2, 2, 0.5}});
  const DistanceField cut(painted(make_shape(Subtraction{block, ball}), 7));
  EXPECT_EQ(cut.material({1.9, 0, 0.5}), 7);  // the inner material takes precedence, the outer is the default
  EXPECT_EQ(cut.material({0.99, 0, 0}), 3);   // the cut has the material of the subtracted solid
  const DistanceField bare(make_shape(Union{{block, make_shape(Moved{ball, {5, 0, 0}})}}));
  EXPECT_EQ(bare.material({0, 0, 0.5}), 0);
  EXPECT_EQ(bare.material({5, 0, 1}), 3);
}

TEST(DistanceField, SmoothOperationsStayWithinAQuarterOfTheRadius) {
  FunctionRandom random(9);
  const Shape a = make_shape(Sphere{2}), b = make_shape(Moved{make_shape(Box{{2, 1, 1}}), {1.5, 0.5, 0}});
  const DistanceField fa(a), fb(b), both(make_shape(Union{{a, b}, 0.8})), common(make_shape(Intersection{{a, b}, 0.8})),
      cut(make_shape(Subtraction{a, b, 0.8}));
  double most = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const dvec3 p = anywhere(random, 4);
    const double x = fa.value(p), y = fb.value(p), slack = 1e-12;
    const double rounded = std::min(x, y) - both.value(p);
    most = std::max(most, rounded);
    ASSERT_TRUE(rounded >= -slack && rounded <= 0.2 + slack);
    if (std::abs(x - y) >= 0.8) {
      ASSERT_LE(rounded, slack);
    }
    // An intersection may be larger: it is the distance to its box.
    ASSERT_GE(common.value(p), std::max(x, y) - slack);
    ASSERT_TRUE(cut.value(p) >= std::max(x, -y) - slack && cut.value(p) <= std::max(x, -y) + 0.2 + slack);
  }
  EXPECT_GT(most, 0.15);
}

TEST(DistanceField, HasANormalWhereTheGradientVanishes) {
  const DistanceField ball(make_shape(Sphere{1}));
  EXPECT_NEAR(length(ball.normal({0, 0, 0})), 1, 1e-12);
  EXPECT_EQ(ball.normal({0, -3, 0}), dvec3(0, -1, 0));
}

std::string refusal(Form form) {
  return test::refusal([&] { make_shape(std::move(form)); });
}

TEST(DistanceField, RejectsValuesOutOfRange) {
  const double nan = std::nan("");
  const Shape ball = make_shape(Sphere{});
  EXPECT_EQ(refusal(Sphere{-1}), "shape: sphere radius is -1 (must be between 2^-20 and 2^30)");
  EXPECT_EQ(refusal(Sphere{nan}), "shape: sphere radius is nan (must be between 2^-20 and 2^30)");
  EXPECT_EQ(refusal(Box{{1, 0, 1}}), "shape: box half y is 0 (must be between 2^-20 and 2^30)");
  EXPECT_EQ(refusal(Box{{1, 2, 3}, 1.5}), "shape: box round is 1.5 (must be between 0 and the smallest half)");
  EXPECT_EQ(refusal(HalfSpace{{0, 0, 0}}), "shape: length of the plane normal is 0 (must be at least 2^-20)");
  EXPECT_EQ(refusal(Moved{ball, {0, nan, 0}}), "shape: move by y is nan (must be between -2^30 and 2^30)");
  EXPECT_EQ(refusal(Union{{ball, nullptr}}), "shape: union part 1 is missing (must be a shape)");
  EXPECT_EQ(refusal(Union{}), "shape: union without parts (at least one required)");
  EXPECT_EQ(refusal(Repeated{ball, {0, 1.5, 0}}),
            "shape: repeat period y is 1.5 (must be at least 2, the length of the repeated shape)");
  EXPECT_NE(refusal(Repeated{make_shape(HalfSpace{}), {1, 0, 0}}), "");
  EXPECT_NE(refusal(Repeated{ball, {3, 0, 0}, {-1, 0, 0}}), "");
  EXPECT_NE(refusal(Capsule{{0, 0, 0}, {nan, 0, 0}}), "");
  EXPECT_NE(refusal(Cylinder{1, -1}), "");
  EXPECT_NE(refusal(Cone{1, 1, 2}), "");
  EXPECT_NE(refusal(Torus{-1, 1}), "");
  EXPECT_NE(refusal(Ellipsoid{{1, 1, nan}}), "");
  EXPECT_NE(refusal(Scaled{ball, 0}), "");
  EXPECT_NE(refusal(Turned{ball, {0, 0, 1}, nan}), "");
  EXPECT_NE(refusal(Subtraction{ball, ball, -1}), "");
  EXPECT_NE(refusal(Painted{ball, 70000}), "");
  EXPECT_NE(refusal(FunctionGround{}), "");
  EXPECT_NE(refusal(FieldGround{}), "");
  const auto holed = std::make_shared<HeightField>(HeightField::own(std::vector<float>{1, 2, 3, std::nanf("")}, 2, 2));
  EXPECT_EQ(refusal(FieldGround{holed, 1}),
            "shape: field of a ground has 1 nodata samples (make the ground with solid_ground())");
  EXPECT_THROW(DistanceField(nullptr), Error);
}

TEST(DistanceField, RejectsTreesThatAreTooDeepOrLarge) {
  Shape deep = make_shape(Sphere{});
  for (int i = 1; i < kDeepestShape; ++i) deep = make_shape(Moved{deep, {1, 0, 0}});
  EXPECT_NEAR(DistanceField(deep).value({0, 0, 0}), kDeepestShape - 2, 1e-9);
  EXPECT_EQ(refusal(Moved{deep}),
            fmt::format("shape: nested {} deep (limited to {})", kDeepestShape + 1, kDeepestShape));
  Shape doubled = make_shape(Sphere{});
  for (int i = 0; i < 20; ++i) doubled = make_shape(Union{{doubled, make_shape(Moved{doubled, {0, 3, 0}})}});
  EXPECT_THROW(DistanceField{doubled}, Error);
  Shape nested = make_shape(Sphere{});
  for (int i = 0; i < 40; ++i) nested = make_shape(Subtraction{make_shape(Sphere{}), nested});
  EXPECT_THROW(DistanceField{nested}, Error);
}

}  // namespace
}  // namespace scarp::test
