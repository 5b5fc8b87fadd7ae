// SPDX-License-Identifier: MIT
// Compares Scarp with Embree on the same triangles: both engines trace the same rays, bit-identical in float32.
//
// Embree computes in float32: in the coordinates of a vertex, in the edge functions and in t. If L is the largest input
// coordinate, each clearance of its planes is off by some 2^-24 L, of which 32 are allowed (vertices minus origin, two
// products and a sum per component of a cross product and a dot product, twice). If both hit, the ray must therefore be
// within 32 * 2^-24 L of Scarp's surface between the two times. Otherwise, a hit of Embree that Scarp misses must be a
// back face, from below; a hit of Scarp that Embree misses counts as lost by Embree. Scarp must lose none.
#include <embree3/rtcore.h>
#include <gtest/gtest.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::test {
namespace {

constexpr int kSide = 129;
#ifdef NDEBUG
constexpr int kRays = 100'000;
#else
constexpr int kRays = 10'000;
#endif
constexpr double kFloatRounding = 32 * 0x1p-24;

float in_float(double x) { return static_cast<float>(x); }

class EmbreeScene {
 public:
  explicit EmbreeScene(const HeightField& field) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const int cols = field.cols(), rows = field.rows();
    auto* vertex =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                    3 * sizeof(float), static_cast<std::size_t>(cols * rows)));
    field.visit([&](const auto& grid) {
      for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
          const dvec3 at = field.world_from_grid(col, row, static_cast<double>(grid.at(col, row)));
          for (int axis = 0; axis < 3; ++axis) *vertex++ = in_float(at[axis]);
        }
      }
    });
    auto* index = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                static_cast<std::size_t>(2 * (cols - 1) * (rows - 1))));
    for (int row = 0; row + 1 < rows; ++row) {
      for (int col = 0; col + 1 < cols; ++col) {
        const auto node = [&](int c, int r) { return static_cast<unsigned>((row + r) * cols + col + c); };
        for (const unsigned i : {node(0, 0), node(0, 1), node(1, 0), node(1, 0), node(0, 1), node(1, 1)}) *index++ = i;
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  struct Answer {
    bool hit;
    double t;
    bool from_below;  // a back face
  };
  Answer closest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = in_float(ray.origin.x), query.ray.org_y = in_float(ray.origin.y);
    query.ray.org_z = in_float(ray.origin.z);
    query.ray.dir_x = in_float(ray.direction.x), query.ray.dir_y = in_float(ray.direction.y);
    query.ray.dir_z = in_float(ray.direction.z);
    query.ray.tfar = in_float(ray.t_max);
    query.ray.mask = ~0u;
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    const unsigned before = _mm_getcsr();
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    rtcIntersect1(scene_, &context, &query);
    _mm_setcsr(before);
    // The normal of a triangle whose corners are anticlockwise, seen from above, points up.
    const double facing =
        query.hit.Ng_x * ray.direction.x + query.hit.Ng_y * ray.direction.y + query.hit.Ng_z * ray.direction.z;
    return {query.hit.geomID != RTC_INVALID_GEOMETRY_ID, query.ray.tfar, facing > 0};
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

Ray float_ray(dvec3 from, dvec3 direction, double t_max) {
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = in_float(from[axis]);
    ray.direction[axis] = in_float(direction[axis]);
  }
  ray.t_max = in_float(t_max);
  return ray;
}

struct RayClass {
  std::string_view name;
  bool must_hit;
  std::function<Ray(const HeightField&, Random&)> make;
};

// Just above the surface at a random position, like rays from hits.
dvec3 off_the_ground(const HeightField& field, Random& random) {
  const double x = uniform(random, 1, field.width() - 1), y = uniform(random, 1, field.depth() - 1);
  return {x, y, field.height(x, y).value() + 0.02};
}

const std::vector<RayClass>& classes() {
  static const std::vector<RayClass> all = {
      {"primary", false,
       [](const HeightField& f, Random& r) {
         const dvec3 eye(0.5 * f.width(), -10, f.max_height() + 20);
         const dvec3 to(uniform(r, -20, f.width() + 20), uniform(r, 0, f.depth() + 60), f.min_height());
         return float_ray(eye, to - eye, 4);
       }},
      {"shadow", false,
       [](const HeightField& f, Random& r) {
         return float_ray(off_the_ground(f, r), {-0.664, 0.664, 0.342}, 400);
       }},
      {"grazing", false,
       [](const HeightField& f, Random& r) {
         const double azimuth = uniform(r, 0, 6.2832);
         return float_ray(off_the_ground(f, r), {std::cos(azimuth), std::sin(azimuth), 0.0524}, 400);
       }},
      {"ao", false,
       [](const HeightField& f, Random& r) {
         const double azimuth = uniform(r, 0, 6.2832), high = std::sqrt(uniform(r, 0, 1));
         const double out = std::sqrt(1 - high * high);
         return float_ray(off_the_ground(f, r), {out * std::cos(azimuth), out * std::sin(azimuth), high}, 400);
       }},
      {"nodes", true,
       [](const HeightField& f, Random& r) {
         const dvec3 node = f.world_from_grid(whole(r, 20, kSide - 21), whole(r, 20, kSide - 21), 0);
         const dvec3 to(node.x, node.y, f.height(node.x, node.y).value());
         const dvec3 from = to + dvec3(whole(r, -640, 640) / 64.0, whole(r, -640, 640) / 64.0, 64);
         return float_ray(from, to - from, 2);
       }},
  };
  return all;
}

TEST(Embree, AgreesOnTheSameTriangles) {
  Random random(11);
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      samples.push_back(in_float(9 * std::sin(0.09 * col) * std::cos(0.06 * row) + uniform(random, 0, 2)));
    }
  }
  const HeightField field = HeightField::own(samples, kSide, kSide, {.surface = Surface::triangles});
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const EmbreeScene embree(field);
  for (const RayClass& rays : classes()) {
    int same = 0, embree_lost = 0, back_faces = 0, differing = 0, scarp_lost = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = rays.make(field, random);
      const Hit hit = march_max_mip(target, ray);
      const EmbreeScene::Answer other = embree.closest(ray);
      // Within Embree's rounding of the surface from one time to another.
      const auto skims = [&](double from, double to) {
        const dvec3 far = ray.at(std::max(from, to));
        const double largest = std::max({std::abs(far.x), std::abs(far.y), std::abs(far.z), std::abs(ray.origin.x),
                                         std::abs(ray.origin.y), std::abs(ray.origin.z), field.width()});
        for (int k = 0; k <= 8; ++k) {
          const dvec3 p = ray.at(from + (to - from) * k / 8);
          const auto ground = field.height(p.x, p.y);
          // Sideways errors change the clearance in proportion to the slope, at most 11 here.
          if (ground && std::abs(p.z - *ground) > 11 * kFloatRounding * largest) return false;
        }
        return true;
      };
      if (hit && other.hit && skims(hit.t, other.t)) {
        ++same;
      } else if (other.hit && other.from_below && (!hit || other.t < hit.t)) {
        ++back_faces;
      } else if (hit && (!other.hit || other.t > hit.t)) {
        ++embree_lost;
      } else if (other.hit) {
        // A touch within Embree's rounding need not be a hit.
        const double past = other.t + 0x1p-6 / length(ray.direction);
        const dvec3 p = ray.at(past);
        const auto ground = field.height(p.x, p.y);
        ++(ground && p.z < *ground && !skims(other.t, past) ? scarp_lost : differing);
      } else {
        ++same;
      }
      if (rays.must_hit && !hit) ++scarp_lost;
    }
    std::printf("%-8s same %d, Embree lost %d, Embree's back face first %d, touches %d, Scarp lost %d\n",
                std::string(rays.name).c_str(), same, embree_lost, back_faces, differing, scarp_lost);
    EXPECT_EQ(scarp_lost, 0) << rays.name;
    // Embree can only be a judge if it is right most of the time.
    EXPECT_LE(embree_lost, kRays / (rays.must_hit ? 10 : 1000)) << rays.name;
    EXPECT_LE(back_faces, kRays / 1000) << rays.name;
    EXPECT_LE(differing, kRays / 1000) << rays.name;
  }
}

}  // namespace
}  // namespace scarp::test
