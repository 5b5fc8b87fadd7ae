// SPDX-License-Identifier: MIT
// Embree's units: the mesh's middle is the origin, and its largest half side is between 1 and 2, so that float32
// neither overflows nor loses small meshes. A ray enters them in double, near the box, with a unit direction:
//
//   ray ──▶ t at the box ──▶ origin there ──float──▶ Embree ──triangle──▶ t, u, v by its plane, in double
//                                                       └── candidates outside the ray's range are skipped
#include "scarp/scene/mesh/scene_mesh.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/scene/mesh/mesh_box.h"
#include "scarp/scene/mesh/mesh_inside.h"

namespace scarp {
namespace {

constexpr std::uint32_t kNone = RTC_INVALID_GEOMETRY_ID;
constexpr std::size_t kMostCorners = std::size_t{1} << 31;  // number of triangles, times three

struct Released {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Released>;

void require_no_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error("mesh: not enough memory to build the hierarchy over its triangles");
  if (error != RTC_ERROR_NONE) throw Error(fmt::format("mesh: Embree reports error {}", static_cast<int>(error)));
}

/// A ray in Embree's units: start + s * direction.
struct MeshRay {
  dvec3 start{0.0};      ///< near the mesh
  dvec3 direction{0.0};  ///< unit
  double start_s = 0;    ///< t of `start`, relative to the world ray's origin
  double length = 1;     ///< length of the world ray's direction: s = t * length
  double first_t = 0, last_t = 0;
  double reach = 0;              ///< s at which the mesh or the range ends
  std::uint32_t passed = kNone;  ///< the triangle that the ray starts on
};

struct TriangleHit {
  double t, u, v;
};

class MeshField final : public SceneField {
 public:
  explicit MeshField(const TriangleMesh& mesh) : box_(box_of(mesh)), middle_(middle(box_)) {
    if (mesh.corners.size() > kMostCorners) throw Error("mesh: has more than 2^31 corners");
    const dvec3 half = 0.5 * (box_.high - box_.low);
    const double largest = std::max({half.x, half.y, half.z});
    if (!(largest > 0 && std::isfinite(largest))) throw Error("mesh: its extent must be finite and above 0");
    // A power of two is exact. The smallest normal number has a finite reciprocal.
    unit_ = std::ldexp(1.0, std::max(std::ilogb(largest), std::numeric_limits<double>::min_exponent));
    half_ = half / unit_ + kMeshRounding;
    for (const MeshCorner& corner : mesh.corners) {
      positions_.emplace_back((corner.position - middle_) / unit_);
      looks_.push_back({corner.normal, corner.colour});
    }
    triangles_ = looks_.size() / 3;
    positions_.emplace_back(0.0f);  // Embree reads 16 bytes of each
    build();
  }

  std::string_view kind() const override { return "mesh"; }
  std::string_view march() const override { return "embree"; }
  std::int64_t elements() const override { return static_cast<std::int64_t>(triangles_); }
  MeshEdges edges() const { return count_edges(std::span(positions_).first(3 * triangles_)); }
  std::optional<WorldBox> box() const override { return box_; }

  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    return accepted_hit(ray, from, {}, stats);
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    if (stats) *stats = {};
    MeshRay local;
    if (!enters(ray, from, local)) return {};
    const MeshFilter filter{ray, rules.accept};
    Query query(*this, local, rules.accept ? &filter : nullptr);
    RTCRayHit found{};
    found.ray = embree_ray(local);
    found.hit.geomID = found.hit.primID = kNone;
    rtcIntersect1(scene_.get(), &query, &found);
    if (query.failure) std::rethrow_exception(query.failure);
    if (stats) stats->steps = stats->cell_tests = query.triangles;
    if (found.hit.geomID == kNone) return {};
    return hit_on(ray, found.hit.primID, meets(local, found.hit.primID, static_cast<double>(found.ray.tfar)));
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    MeshRay local;
    if (!enters(ray, from, local)) return false;
    Query query(*this, local);
    RTCRay found = embree_ray(local);
    rtcOccluded1(scene_.get(), &query, &found);
    return found.tfar < 0;  // minus infinity if something blocks the ray
  }

  FieldSurface surface(const Ray& ray, const Hit& hit) const override {
    return surface_at(static_cast<std::uint32_t>(hit.cell.col), hit.u, hit.v, -ray.direction);
  }
  std::optional<FieldSurface> within(const dvec3& p) const override {
    std::call_once(inside_made_, [&] { inside_.emplace(std::span(positions_).first(3 * triangles_)); });
    MeshRay up;
    up.start = (p - middle_) / unit_;
    up.direction = {0, 0, 1};
    const std::optional<std::uint32_t> triangle = inside_->above(up.start);
    if (!triangle) return {};
    const TriangleHit above = meets(up, *triangle, 0);
    return surface_at(*triangle, above.u, above.v, up.direction);
  }

  Ray started(const Ray& ray, const Hit* from) const override {
    Ray r = SceneField::started(ray, from);
    if (from) r.start_cell = from->cell;
    return r;
  }

 private:
  struct CornerLook {
    vec3 normal;
    vec3 colour;
  };

  // The caller's filter, and the ray passed to it.
  struct MeshFilter {
    const Ray& ray;
    const HitFilter* accept;
  };

  // Embree passes its context to the filter.
  struct Query : RTCIntersectContext {
    Query(const MeshField& mesh_, const MeshRay& ray_, const MeshFilter* filter_ = nullptr)
        : RTCIntersectContext{}, mesh(mesh_), ray(ray_), filter(filter_) {
      rtcInitIntersectContext(this);
    }

    const MeshField& mesh;
    const MeshRay& ray;
    const MeshFilter* filter;
    std::exception_ptr failure{};  // thrown by the filter: exceptions must not pass through Embree
    std::uint32_t triangles = 0;
  };

  void build() {
    device_.reset(rtcNewDevice(nullptr));
    require_no_error(device_.get());
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    const Owned<RTCGeometry> triangles(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(triangles.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                               sizeof(vec3), 3 * triangles_);
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        triangles.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles_));
    require_no_error(device_.get());
    for (std::uint32_t i = 0; i < 3 * triangles_; ++i) indices[i] = i;
    rtcSetGeometryIntersectFilterFunction(triangles.get(), judge_candidate);
    rtcSetGeometryOccludedFilterFunction(triangles.get(), judge_candidate);
    rtcCommitGeometry(triangles.get());
    rtcAttachGeometry(scene_.get(), triangles.get());
    rtcCommitScene(scene_.get());
    require_no_error(device_.get());
  }

  dvec3 position(std::uint32_t triangle, int corner) const {
    return dvec3(positions_[3 * std::size_t{triangle} + static_cast<std::size_t>(corner)]);
  }
  // The normal of the triangle's plane; its length is twice the triangle's area.
  dvec3 normal(std::uint32_t triangle) const {
    const dvec3 a = position(triangle, 0);
    return cross(position(triangle, 1) - a, position(triangle, 2) - a);
  }

  std::uint32_t start_triangle(const Ray& ray, const Hit* from) const {
    const int triangle = from ? from->cell.col : ray.start == RayStart::on_surface ? ray.start_cell.col : -1;
    return triangle >= 0 && static_cast<std::size_t>(triangle) < triangles_ ? static_cast<std::uint32_t>(triangle)
                                                                            : kNone;
  }

  // With normals flipped towards a direction.
  FieldSurface surface_at(std::uint32_t triangle, double u, double v, const dvec3& towards) const {
    const CornerLook* look = &looks_[3 * std::size_t{triangle}];
    const dvec3 plane = normalize(normal(triangle));
    const double w = 1 - u - v;
    dvec3 smooth = w * dvec3(look[0].normal) + u * dvec3(look[1].normal) + v * dvec3(look[2].normal);
    FieldSurface surface;
    surface.normal = dot(plane, towards) < 0 ? -plane : plane;
    // Opposite normals cancel one another.
    smooth = length(smooth) > 0 ? normalize(smooth) : surface.normal;
    surface.shading_normal = dot(smooth, surface.normal) < 0 ? -smooth : smooth;
    surface.colour = srgb(w * dvec3(look[0].colour) + u * dvec3(look[1].colour) + v * dvec3(look[2].colour));
    return surface;
  }

  // Returns false if the ray misses the box.
  bool enters(const Ray& ray, const Hit* from, MeshRay& local) const {
    // Divided by its largest component first, so that squares neither overflow nor underflow.
    const double part = std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    const dvec3 along = ray.direction / part;
    const double along_length = length(along);
    local.direction = along / along_length;
    local.length = std::min(part / unit_ * along_length, std::numeric_limits<double>::max());
    local.first_t = ray.t_min, local.last_t = ray.t_max;
    dvec3 origin = (ray.origin - middle_) / unit_;
    double low = ray.t_min * local.length, high = ray.t_max * local.length;
    if (local.passed = start_triangle(ray, from); local.passed != kNone) {
      // Moves the start into the triangle's plane: rounding of world coordinates may have moved it out.
      const dvec3 n = normal(local.passed);
      if (const double square = dot(n, n); square > 0)
        origin += n * (dot(n, position(local.passed, 0) - (origin + low * local.direction)) / square);
      local.first_t += kMeshRounding / local.length;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double o = origin[axis], d = local.direction[axis], h = half_[axis];
      if (d == 0) {
        if (std::abs(o) > h) return false;
        continue;
      }
      low = std::max(low, (std::copysign(h, -d) - o) / d);
      high = std::min(high, (std::copysign(h, d) - o) / d);
    }
    if (!(low <= high)) return false;
    // Slightly earlier, so that float32 loses no touch at the start.
    local.start_s = low - kMeshRounding;
    local.start = origin + local.start_s * local.direction;
    local.reach = high - low + 2 * kMeshRounding;
    return true;
  }

  static RTCRay embree_ray(const MeshRay& local) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(local.start.x);
    ray.org_y = static_cast<float>(local.start.y);
    ray.org_z = static_cast<float>(local.start.z);
    ray.dir_x = static_cast<float>(local.direction.x);
    ray.dir_y = static_cast<float>(local.direction.y);
    ray.dir_z = static_cast<float>(local.direction.z);
    ray.tnear = 0;
    ray.tfar = static_cast<float>(local.reach);
    ray.mask = ~0u;
    return ray;
  }

  // Where the ray hits the plane of a triangle that Embree found at found_s. t is NaN if the triangle has no area in
  // float32; it then blocks nothing.
  TriangleHit meets(const MeshRay& ray, std::uint32_t triangle, double found_s) const {
    const dvec3 a = position(triangle, 0) - ray.start, b = position(triangle, 1) - ray.start,
                c = position(triangle, 2) - ray.start;
    const dvec3 n = normal(triangle);
    const double square = dot(n, n);
    if (square == 0) return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    const double facing = dot(n, ray.direction);
    double s = facing != 0 ? dot(n, a) / facing : found_s;
    // Intersecting a plane that is seen edge-on is ill-conditioned, but the triangle's corners still bound s.
    const double along_a = dot(a, ray.direction), along_b = dot(b, ray.direction), along_c = dot(c, ray.direction);
    s = std::clamp(s, std::min({along_a, along_b, along_c}), std::max({along_a, along_b, along_c}));
    const dvec3 p = s * ray.direction;
    double u = glm::clamp(dot(n, cross(c - p, a - p)) / square, 0.0, 1.0);
    double v = glm::clamp(dot(n, cross(a - p, b - p)) / square, 0.0, 1.0);
    if (const double sum = u + v; sum > 1) u /= sum, v /= sum;
    return {(ray.start_s + s) / ray.length, u, v};
  }

  // Embree's range is wider than the ray's; t in double decides.
  static void judge_candidate(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] != -1) return;
    Query& query = static_cast<Query&>(*arguments->context);
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
    ++query.triangles;
    const double found_s = static_cast<double>(RTCRayN_tfar(arguments->ray, arguments->N, 0));
    const TriangleHit at = query.mesh.meets(query.ray, triangle, found_s);
    if (triangle == query.ray.passed || !(at.t >= query.ray.first_t && at.t <= query.ray.last_t)) {
      arguments->valid[0] = 0;
    } else if (query.filter && !query.failure) {
      try {
        if (!(*query.filter->accept)(hit_on(query.filter->ray, triangle, at))) arguments->valid[0] = 0;
      } catch (...) {
        query.failure = std::current_exception();
      }
    }
  }

  static Hit hit_on(const Ray& ray, std::uint32_t triangle, const TriangleHit& at) {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = at.t;
    hit.cell = {static_cast<int>(triangle), 0};
    hit.u = at.u, hit.v = at.v;
    hit.height = ray.at(at.t).z;
    return hit;
  }

  static VoxelColour srgb(const dvec3& linear) {
    VoxelColour colour{};
    for (int i = 0; i < 3; ++i) {
      const double x = glm::clamp(linear[i], 0.0, 1.0);
      const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
      colour[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * encoded));
    }
    return colour;
  }

  WorldBox box_;
  dvec3 middle_;
  double unit_ = 1;  // units of the file per unit of Embree
  dvec3 half_{0.0};  // of the box in Embree's units, widened by the rounding error
  std::size_t triangles_ = 0;
  std::vector<vec3> positions_;  // in Embree's units, three per triangle and one more; Embree reads them here
  std::vector<CornerLook> looks_;
  mutable std::once_flag inside_made_;
  mutable std::optional<MeshInside> inside_;  // made by the first within()
  Owned<RTCDevice> device_;
  Owned<RTCScene> scene_;
};

}  // namespace

SceneFieldPtr scene_mesh(const TriangleMesh& mesh) { return std::make_shared<MeshField>(mesh); }

std::optional<MeshEdges> mesh_edges(const SceneField& field) {
  const auto* mesh = dynamic_cast<const MeshField*>(&field);
  return mesh ? std::optional(mesh->edges()) : std::nullopt;
}

}  // namespace scarp
