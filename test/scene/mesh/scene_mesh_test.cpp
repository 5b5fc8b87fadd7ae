// SPDX-License-Identifier: MIT
// Meshes in scenes against planes and boxes computed in double, and against the properties of convex solids.
#include "scarp/scene/mesh/scene_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "base/refusal.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/scene_query.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  dvec3 in(const dvec3& low, const dvec3& high) { return {in(low.x, high.x), in(low.y, high.y), in(low.z, high.z)}; }
  dvec3 direction() {
    while (true) {
      const dvec3 d = in(dvec3(-1), dvec3(1));
      if (dot(d, d) > 0.01 && dot(d, d) < 1) return normalize(d);
    }
  }

 private:
  std::mt19937_64 engine_;
};

void add(TriangleMesh& mesh, const dvec3& a, const dvec3& b, const dvec3& c) {
  const vec3 normal(normalize(cross(b - a, c - a)));
  for (const dvec3& p : {a, b, c}) mesh.corners.push_back({p, normal});
}

TriangleMesh triangle() {
  TriangleMesh mesh;
  add(mesh, {0, 0, 1}, {4, 0, 1}, {0, 4, 1});
  return mesh;
}

// Between two corners, two triangles per face.
TriangleMesh cube(const dvec3& low, const dvec3& high) {
  TriangleMesh mesh;
  const auto corner = [&](int i) {
    return dvec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  };
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    add(mesh, corner(f[0]), corner(f[1]), corner(f[2]));
    add(mesh, corner(f[0]), corner(f[2]), corner(f[3]));
  }
  return mesh;
}

// A convex solid of triangles, its corners on a sphere.
TriangleMesh ball(const dvec3& middle, double radius) {
  constexpr int kSlices = 24, kStacks = 12;
  TriangleMesh mesh;
  const auto point = [&](int slice, int stack) {
    const double a = 2 * std::numbers::pi * (slice % kSlices) / kSlices, b = std::numbers::pi * stack / kStacks;
    const double around = stack == 0 || stack == kStacks ? 0 : std::sin(b);
    return middle + radius * dvec3(around * std::cos(a), around * std::sin(a), -std::cos(b));
  };
  for (int slice = 0; slice < kSlices; ++slice) {
    for (int stack = 0; stack < kStacks; ++stack) {
      const dvec3 a = point(slice, stack), b = point(slice + 1, stack), c = point(slice + 1, stack + 1),
                  d = point(slice, stack + 1);
      if (stack > 0) add(mesh, a, b, c);
      if (stack < kStacks - 1) add(mesh, a, c, d);
    }
  }
  return mesh;
}

Ray ray_at(const dvec3& origin, const dvec3& direction) {
  Ray ray;
  ray.origin = origin, ray.direction = direction;
  return ray;
}

TEST(SceneMesh, HitsATriangleFromBothSides) {
  TriangleMesh mesh = triangle();
  mesh.corners[0].colour = vec3(1, 0, 0), mesh.corners[1].colour = vec3(0, 1, 0), mesh.corners[2].colour = vec3(0);
  const SceneFieldPtr field = scene_mesh(mesh);
  EXPECT_EQ(field->kind(), "mesh");
  EXPECT_EQ(field->march(), "embree");
  EXPECT_EQ(field->box()->low, dvec3(0, 0, 1));
  EXPECT_EQ(field->box()->high, dvec3(4, 4, 1));
  for (const double side : {1.0, -1.0}) {
    // t is in units of the direction's length.
    const Ray ray = ray_at({1, 2, 1 + 8 * side}, {0, 0, -4 * side});
    MarchStats stats;
    const Hit hit = field->closest_hit(ray, nullptr, &stats);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit.t, 2);
    EXPECT_EQ(hit.cell, (Cell{0, 0}));
    EXPECT_EQ(hit.u, 0.25);
    EXPECT_EQ(hit.v, 0.5);
    EXPECT_EQ(hit.height, 1);
    EXPECT_EQ(stats.cell_tests, 1u);
    const FieldSurface surface = field->surface(ray, hit);
    EXPECT_EQ(surface.normal, dvec3(0, 0, side));
    EXPECT_EQ(surface.shading_normal, dvec3(0, 0, side));
    // A quarter of linear light is 137 of 255 in sRGB.
    EXPECT_EQ(*surface.colour, (VoxelColour{137, 137, 0}));
    EXPECT_TRUE(field->occluded(ray, nullptr));
  }
  EXPECT_FALSE(field->closest_hit(ray_at({3, 3, 5}, {0, 0, -1}), nullptr, nullptr));
  EXPECT_FALSE(field->occluded(ray_at({3, 3, 5}, {0, 0, -1}), nullptr));
  EXPECT_FALSE(field->within({1, 1, 1}));
  EXPECT_FALSE(field->height(1, 1));
}

TEST(SceneMesh, RayRangeIsClosed) {
  const SceneFieldPtr field = scene_mesh(triangle());
  const double before = std::nextafter(2.0, 0.0), after = std::nextafter(2.0, 3.0);
  const struct {
    double t_min, t_max;
    bool hits;
  } cases[] = {{0, 2, true}, {2, 2, true}, {2, 9, true}, {0, before, false}, {after, 9, false}, {-5, kInfinity, true}};
  for (const auto& c : cases) {
    Ray ray = ray_at({1, 1, 3}, {0, 0, -1});
    ray.t_min = c.t_min, ray.t_max = c.t_max;
    EXPECT_EQ(static_cast<bool>(field->closest_hit(ray, nullptr, nullptr)), c.hits) << c.t_min << " " << c.t_max;
    EXPECT_EQ(field->occluded(ray, nullptr), c.hits) << c.t_min << " " << c.t_max;
  }
}

TEST(SceneMesh, AcceptsDirectionsOfAnyLength) {
  const SceneFieldPtr field = scene_mesh(triangle());
  for (const double length : {1e-300, 1e-12, 1.0, 1e12, 1e300}) {
    const Hit hit = field->closest_hit(ray_at({1, 1, 3}, {0, 0, -length}), nullptr, nullptr);
    ASSERT_TRUE(hit) << length;
    EXPECT_DOUBLE_EQ(hit.t * length, 2) << length;
  }
}

TEST(SceneMesh, InterpolatesSmoothNormals) {
  TriangleMesh mesh = triangle();
  mesh.corners[1].normal = vec3(1, 0, 0);
  const SceneFieldPtr field = scene_mesh(mesh);
  const Ray ray = ray_at({2, 0.5, 9}, {0, 0, -1});
  const FieldSurface surface = field->surface(ray, field->closest_hit(ray, nullptr, nullptr));
  EXPECT_EQ(surface.normal, dvec3(0, 0, 1));
  EXPECT_NEAR(length(surface.shading_normal - normalize(dvec3(1, 0, 1))), 0, 1e-15);
}

// Against the slabs of the box, in double.
TEST(SceneMesh, CubeMatchesTheSlabTest) {
  const dvec3 low(-3, 1, 2), high(4, 5, 9);
  const SceneFieldPtr field = scene_mesh(cube(low, high));
  constexpr double kNear = 4 * kMeshRounding;  // the half side in metres, 3.5, and its unit, 2
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray = ray_at(random.in(dvec3(-9), dvec3(9)), random.direction() * random.in(0.1, 3));
    ray.t_max = random.in(0, 20);
    double enter = -kInfinity, leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - ray.origin[axis]) / ray.direction[axis];
      const double b = (high[axis] - ray.origin[axis]) / ray.direction[axis];
      enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    const double slack = kNear / length(ray.direction);
    if (std::abs(enter - leave) < 20 * slack) continue;  // past an edge
    double t = enter > leave ? kInfinity : enter >= 0 ? enter : leave;
    if (std::abs(t - ray.t_max) < slack || std::abs(t) < slack) continue;
    if (t < 0 || t > ray.t_max) t = kInfinity;
    const Hit hit = field->closest_hit(ray, nullptr, nullptr);
    ASSERT_EQ(static_cast<bool>(hit), t < kInfinity) << i;
    EXPECT_EQ(field->occluded(ray, nullptr), t < kInfinity) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit.t, t, slack) << i;
    EXPECT_LT(dot(field->surface(ray, hit).normal, ray.direction), 0);
  }
  EXPECT_GT(hits, 1000);
}

TEST(SceneMesh, SharedEdgesAndCornersLeaveNoGap) {
  const TriangleMesh mesh = ball({7, -3, 20}, 5);
  const SceneFieldPtr field = scene_mesh(mesh);
  Random random(2);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const dvec3 a = mesh.corners[i].position, b = mesh.corners[i % 3 == 2 ? i - 2 : i + 1].position;
    for (const double share : {0.0, 0.5, random.in(0, 1)}) {
      const dvec3 p = a + share * (b - a);
      const dvec3 eye = dvec3(7, -3, 20) + 3.0 * (p - dvec3(7, -3, 20)) + random.direction();
      EXPECT_TRUE(field->closest_hit(ray_at(eye, p - eye), nullptr, nullptr)) << i << " " << share;
      EXPECT_TRUE(field->occluded(ray_at(eye, p - eye), nullptr)) << i << " " << share;
    }
  }
}

// From the surface of a convex solid, a ray outwards hits nothing, and a ray inwards hits the other side.
TEST(SceneMesh, RayFromATriangleHitsOnlyOthers) {
  for (const dvec3& middle : {dvec3(0), dvec3(5e5, 4e6, 1e3)}) {
    const SceneFieldPtr field = scene_mesh(ball(middle, 5));
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
      const dvec3 eye = middle + 20.0 * random.direction();
      const Ray ray = ray_at(eye, middle + 4.0 * random.direction() - eye);
      const Hit hit = field->closest_hit(ray, nullptr, nullptr);
      ASSERT_TRUE(hit);
      const dvec3 normal = field->surface(ray, hit).normal, way = random.direction();
      const double rising = dot(normal, way);
      const Ray next = ray_at(ray.at(hit.t), way);
      const Hit other = field->closest_hit(next, &hit, nullptr);
      EXPECT_EQ(field->occluded(next, &hit), static_cast<bool>(other));
      if (rising > 0) {
        EXPECT_FALSE(other) << i << ": " << rising << ", at " << other.t;
      } else if (rising < -0.01) {
        ASSERT_TRUE(other) << i;
        EXPECT_NE(other.cell, hit.cell);
        EXPECT_GT(other.t, 5 * kMeshRounding);
        // The same if the ray itself names the triangle on which it starts.
        EXPECT_EQ(field->closest_hit(field->started(next, &hit), nullptr, nullptr), other);
      }
    }
  }
}

TEST(SceneMesh, ClosedMeshesHaveAnInside) {
  const TriangleMesh shell = ball({7, -3, 20}, 5);
  const SceneFieldPtr solid = scene_mesh(shell), box = scene_mesh(cube({-1, -1, -1}, {1, 1, 1}));
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    const dvec3 out = random.direction();
    const double r = random.in(0, 10);
    // The middles of the facets are 2 % further in than the corners.
    if (r < 4.8 || r > 5) {
      EXPECT_EQ(solid->within(dvec3(7, -3, 20) + r * out).has_value(), r < 5) << i;
    }
  }
  // Above and below corners, edges and diagonals.
  for (const MeshCorner& corner : shell.corners) {
    const dvec3 p = corner.position - dvec3(7, -3, 20);
    if (std::hypot(p.x, p.y) < 4.9) {
      EXPECT_TRUE(solid->within(dvec3(7, -3, 20) + dvec3(p.x, p.y, 0)));
    }
    EXPECT_FALSE(solid->within(dvec3(7, -3, 30) + dvec3(p.x, p.y, 0)));
    EXPECT_FALSE(solid->within(dvec3(7, -3, 10) + dvec3(p.x, p.y, 0)));
  }
  for (const double x : {-0.5, 0.0, 0.5}) {
    const std::optional<FieldSurface> surface = box->within({x, x, 0.9});
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->normal, dvec3(0, 0, 1));
    EXPECT_FALSE(box->within({x, x, 1.1}));
    EXPECT_FALSE(box->within({x, x, -1.1}));
  }
  TriangleMesh open = shell;
  open.corners.resize(open.corners.size() - 3);
  EXPECT_FALSE(scene_mesh(open)->within({7, -3, 20}));
}

TEST(SceneMesh, IsAccurateAtAnyDistance) {
  const dvec3 far(5e5, 4e6, 2e3);
  const SceneFieldPtr near_field = scene_mesh(ball(dvec3(0), 5)), far_field = scene_mesh(ball(far, 5));
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const dvec3 back = random.direction(), target = 4.0 * random.direction();
    const Hit near_hit = near_field->closest_hit(ray_at(target + 20.0 * back, -back), nullptr, nullptr);
    // From a thousand kilometres away, where doubles are 2^-31 m apart.
    const Ray ray = ray_at(far + target + 1e6 * back, -back);
    const Hit hit = far_field->closest_hit(ray, nullptr, nullptr);
    ASSERT_TRUE(near_hit && hit);
    // The corners themselves are rounded to float32, by at most 2^-25 of 8 m.
    if (near_hit.cell == hit.cell) {
      EXPECT_NEAR(hit.t - 1e6, near_hit.t - 20, 1e-5);
    }
  }
}

TEST(SceneMesh, AnyHitAgreesWithClosestHit) {
  TriangleMesh mesh;
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const dvec3 p = random.in(dvec3(-10), dvec3(10));
    add(mesh, p, p + 3.0 * random.direction(), p + 3.0 * random.direction());
  }
  const SceneFieldPtr field = scene_mesh(mesh);
  std::vector<Ray> rays;
  std::vector<Hit> starts;
  for (int i = 0; i < 20000; ++i) {
    Ray ray = ray_at(random.in(dvec3(-15), dvec3(15)), random.direction());
    ray.t_max = random.in(0, 8);
    const Hit hit = field->closest_hit(ray, nullptr, nullptr);
    EXPECT_EQ(field->occluded(ray, nullptr), static_cast<bool>(hit)) << i;
    rays.push_back(ray);
    starts.push_back(hit);
    if (!hit) continue;
    ray.t_max = hit.t;
    EXPECT_EQ(field->closest_hit(ray, nullptr, nullptr), hit) << i;
    EXPECT_TRUE(field->occluded(ray, nullptr)) << i;
    rays.back() = ray_at(rays.back().at(hit.t), random.direction());
  }
  std::vector<const Hit*> from;
  for (const Hit& hit : starts) from.push_back(hit ? &hit : nullptr);
  const Scene scene(field);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  scene.closest_hits(rays, hits, {}, from);
  scene.occluded(rays, blocked, from);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(hits[i], field->closest_hit(rays[i], from[i], nullptr)) << i;
    EXPECT_EQ(blocked[i] != 0, static_cast<bool>(hits[i])) << i;
  }
}

TEST(SceneMesh, AppliesItsPlacement) {
  const TriangleMesh mesh = cube({1, 2, 3}, {3, 6, 4});
  const Placement place = mesh_placement(mesh, {.at = {100, 200, 50}, .scale = 2, .turn_deg = 90});
  // 2 x 4 x 1, turned and doubled: 8 east, 4 north, 2 up.
  const Scene scene({scene_mesh(mesh)}, {{0, 0, place}});
  EXPECT_NEAR(length(scene.box().low - dvec3(96, 198, 50)), 0, 1e-12);
  EXPECT_NEAR(length(scene.box().high - dvec3(104, 202, 52)), 0, 1e-12);
  const Ray down = ray_at({103.5, 198.5, 152}, {0, 0, -10});
  const Hit hit = scene.closest_hit(down);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, 10, 1e-5);
  EXPECT_NEAR(length(scene.surface(down, hit).normal - dvec3(0, 0, 1)), 0, 1e-15);
  EXPECT_TRUE(scene.occluded(down));
  // Clockwise: a vector to the east then points south.
  EXPECT_NEAR(length(place.turn * dvec3(1, 0, 0) - dvec3(0, -1, 0)), 0, 1e-15);

  const auto refuse = [&](const MeshPlacement& wrong, const char* what) {
    EXPECT_EQ(test::refusal([&] { mesh_placement(mesh, wrong); }), what);
  };
  refuse({.scale = 0}, "mesh: the scale is 0 (must be above 0)");
  refuse({.scale = kInfinity}, "mesh: the scale is inf (must be above 0)");
  refuse({.turn_deg = kInfinity}, "mesh: its place and its turn must be finite numbers");
  refuse({.at = {0, kInfinity, 0}}, "mesh: its place and its turn must be finite numbers");
  refuse({.scale = 1e308}, "mesh: is too large at this scale");
}

TEST(SceneMesh, RejectsInvalidMeshes) {
  TriangleMesh mesh;
  EXPECT_EQ(test::refusal([&] { scene_mesh(mesh); }), "mesh: has no whole triangles");
  mesh = triangle();
  mesh.corners[1].position.y = kInfinity;
  EXPECT_EQ(test::refusal([&] { scene_mesh(mesh); }), "mesh: its coordinates must be finite numbers");
  mesh.corners[0].position = mesh.corners[1].position = mesh.corners[2].position = dvec3(1);
  EXPECT_EQ(test::refusal([&] { scene_mesh(mesh); }), "mesh: its extent must be finite and above 0");
}

TEST(SceneMesh, PassesRejectedTriangles) {
  const Scene scene(scene_mesh(cube({0, 0, 0}, {4, 4, 4})));
  const Ray down{{1, 2, 9}, {0, 0, -1}};
  const Hit top = scene.closest_hit(down);
  EXPECT_EQ(top.t, 5);
  const auto not_top = [&](const Ray& ray, const Hit& hit) {
    EXPECT_EQ(ray.origin, down.origin);
    return hit.cell != top.cell;
  };
  const SceneQuery query = scene.query({.accept = not_top});
  EXPECT_EQ(query.closest_hit(down).t, 9);
  EXPECT_TRUE(query.occluded(down));
  EXPECT_FALSE(scene.query({.accept = [](const Ray&, const Hit&) { return false; }}).closest_hit(down));
  const SceneQuery fails = scene.query({.accept = [](const Ray&, const Hit&) -> bool { throw Error("no"); }});
  EXPECT_EQ(test::refusal([&] { fails.closest_hit(down); }), "no");
}

}  // namespace
}  // namespace scarp
