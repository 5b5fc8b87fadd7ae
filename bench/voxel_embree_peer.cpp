// SPDX-License-Identifier: MIT
#include "bench/voxel_embree_peer.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "bench/denormals_off.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
float below(double x) { return std::nextafter(static_cast<float>(x), -kInfinity); }
float above(double x) { return std::nextafter(static_cast<float>(x), kInfinity); }

// Up to 8 rays of a query, with their double-precision data for the callback.
struct Question {
  RTCIntersectContext embree;
  const Ray* rays = nullptr;
  std::array<VoxelDirection, 8> directions{VoxelDirection(dvec3(1)), VoxelDirection(dvec3(1)), VoxelDirection(dvec3(1)),
                                           VoxelDirection(dvec3(1)), VoxelDirection(dvec3(1)), VoxelDirection(dvec3(1)),
                                           VoxelDirection(dvec3(1)), VoxelDirection(dvec3(1))};
  std::array<Hit, 8> best;
};

// A visible face: its voxel and its side.
struct Quad {
  ivec3 voxel;
  VoxelFace face;
};

}  // namespace

struct VoxelEmbreePeer::Scene {
  // Declared first, destroyed last: Embree reports deallocations while its device is released.
  std::atomic<std::int64_t> bytes{0};
  std::string name;
  std::vector<VoxelPlace> places;
  std::shared_ptr<const VoxelModel> model;  // for user geometry
  VoxelTarget target;
  glm::dmat3 grid_from_world{1.0};
  std::vector<Quad> quads;  // faces drawn as triangles
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  RTCDevice device = nullptr;
  RTCScene object = nullptr, scene = nullptr;

  Scene() {
    device = rtcNewDevice(nullptr);
    const auto count = [](void* self, ssize_t change, bool) {
      static_cast<Scene*>(self)->bytes += change;
      return true;
    };
    rtcSetDeviceMemoryMonitorFunction(device, count, this);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  }
  ~Scene() {
    if (object) rtcReleaseScene(object);
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  void attach(RTCScene to, RTCGeometry geometry) const {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(to, geometry);
    rtcReleaseGeometry(geometry);
  }
  void check() const {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw Error(
          fmt::format("Embree, voxels: error {}; too little memory is the usual cause", static_cast<int>(error)));
  }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    const Scene& s = *static_cast<const Scene*>(args->geometryUserPtr);
    const VoxelPlace& place = s.places[args->primID];
    const dvec3 low = place.world_from_grid * dvec3(s.target.box.low) + place.origin,
                high = place.world_from_grid * dvec3(s.target.box.high) + place.origin;
    RTCBounds& to = *args->bounds_o;
    to.lower_x = below(low.x), to.lower_y = below(low.y), to.lower_z = below(low.z);
    to.upper_x = above(high.x), to.upper_y = above(high.y), to.upper_z = above(high.z);
  }

  static void intersect(const RTCIntersectFunctionNArguments* args) {
    const Scene& s = *static_cast<const Scene*>(args->geometryUserPtr);
    Question& question = *reinterpret_cast<Question*>(args->context);
    RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* const hits = RTCRayHitN_HitN(args->rayhit, args->N);
    for (unsigned i = 0; i < args->N; ++i) {
      if (!args->valid[i]) continue;
      const unsigned id = RTCRayN_id(rays, args->N, i);
      const Ray& ray = question.rays[id];
      Hit& best = question.best[id];
      const VoxelRay in_grid{s.grid_from_world * (ray.origin - s.places[args->primID].origin),
                             question.directions[id].given,
                             ray.t_min,
                             best ? best.t : ray.t_max,
                             {}};
      QuantisedRay quantised;
      if (!quantise(in_grid, question.directions[id], s.target.box, quantised)) continue;
      const VoxelHit hit = s.model->march().cpu(s.target, quantised, nullptr);
      if (!hit || (best && hit.t == best.t && args->primID > best.part)) continue;
      best.status = HitStatus::hit, best.face = hit.face, best.t = hit.t;
      best.voxel = hit.voxel, best.part = args->primID;
      RTCRayN_tfar(rays, args->N, i) = above(hit.t);
      RTCHitN_geomID(hits, args->N, i) = args->geomID;
      RTCHitN_primID(hits, args->N, i) = args->primID;
    }
  }

  void begin(Question& question, const Ray* rays, std::size_t count) const {
    question.rays = rays;
    if (!model) return;
    for (std::size_t i = 0; i < count; ++i) {
      question.directions[i] = VoxelDirection(grid_from_world * rays[i].direction);
      question.best[i] = {};
    }
  }
  void take_triangle(unsigned geom, unsigned prim, unsigned instance, float t, Hit& to) const {
    to = {};
    if (geom == RTC_INVALID_GEOMETRY_ID) return;
    const Quad& quad = quads[prim / 2];
    to.status = HitStatus::hit, to.t = t, to.voxel = quad.voxel, to.face = quad.face;
    to.part = instance;
  }

  void trace_single(std::span<const Ray> rays, std::span<Hit> answers) const {
    const DenormalsOff denormals_off;
    Question question;
    rtcInitIntersectContext(&question.embree);
    RTCRayHit query;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      begin(question, &ray, 1);
      query.ray = {static_cast<float>(ray.origin.x),
                   static_cast<float>(ray.origin.y),
                   static_cast<float>(ray.origin.z),
                   0,
                   static_cast<float>(ray.direction.x),
                   static_cast<float>(ray.direction.y),
                   static_cast<float>(ray.direction.z),
                   0,
                   kInfinity,
                   ~0u,
                   0,
                   0};
      query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &question.embree, &query);
      if (model) {
        answers[i] = question.best[0];
      } else {
        take_triangle(query.hit.geomID, query.hit.primID, query.hit.instID[0], query.ray.tfar, answers[i]);
      }
    }
  }

  void trace_eight(std::span<const Ray> rays, std::span<Hit> answers) const {
    const DenormalsOff denormals_off;
    Question question;
    rtcInitIntersectContext(&question.embree);
    question.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit8 query;
    for (std::size_t first = 0; first < rays.size(); first += 8) {
      const std::size_t count = std::min<std::size_t>(8, rays.size() - first);
      begin(question, &rays[first], count);
      alignas(32) int valid[8] = {};
      for (std::size_t i = 0; i < count; ++i) {
        const Ray& ray = rays[first + i];
        valid[i] = -1;
        query.ray.org_x[i] = static_cast<float>(ray.origin.x), query.ray.org_y[i] = static_cast<float>(ray.origin.y);
        query.ray.org_z[i] = static_cast<float>(ray.origin.z);
        query.ray.dir_x[i] = static_cast<float>(ray.direction.x);
        query.ray.dir_y[i] = static_cast<float>(ray.direction.y);
        query.ray.dir_z[i] = static_cast<float>(ray.direction.z);
        query.ray.tnear[i] = 0, query.ray.tfar[i] = kInfinity, query.ray.time[i] = 0;
        query.ray.mask[i] = ~0u, query.ray.id[i] = static_cast<unsigned>(i), query.ray.flags[i] = 0;
        query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, scene, &question.embree, &query);
      for (std::size_t i = 0; i < count; ++i) {
        if (model) {
          answers[first + i] = question.best[i];
        } else {
          take_triangle(query.hit.geomID[i], query.hit.primID[i], query.hit.instID[0][i], query.ray.tfar[i],
                        answers[first + i]);
        }
      }
    }
  }

  // The faces between solid and empty voxels, two triangles each.
  void make_quads(const VoxelGrid& grid) {
    for_each_voxel(grid.bounds(), [&](const ivec3& voxel) {
      if (!grid.solid(voxel)) return;
      for (int f = 0; f < 6; ++f) {
        const auto face = static_cast<VoxelFace>(f);
        const ivec3 normal = normal_of(face), beside = voxel + normal;
        if (grid.box().contains(beside) && grid.solid(beside)) continue;
        quads.push_back({voxel, face});
        const int axis = f / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto first = static_cast<std::uint32_t>(vertices.size() / 3);
        for (int corner = 0; corner < 4; ++corner) {
          ivec3 at = voxel;
          at[axis] += f % 2;
          at[u] += corner & 1;
          at[v] += corner >> 1;
          for (int i = 0; i < 3; ++i) vertices.push_back(static_cast<float>(at[i]));
        }
        for (const std::uint32_t corner : {0u, 1u, 2u, 1u, 3u, 2u}) indices.push_back(first + corner);
      }
    });
    // Embree reads the last vertex with four lanes.
    vertices.push_back(0);
  }
};

VoxelEmbreePeer::VoxelEmbreePeer(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
VoxelEmbreePeer::VoxelEmbreePeer(VoxelEmbreePeer&&) noexcept = default;
VoxelEmbreePeer::~VoxelEmbreePeer() = default;

VoxelEmbreePeer VoxelEmbreePeer::user_geometry(const std::shared_ptr<const VoxelModel>& model,
                                               std::vector<VoxelPlace> places) {
  auto scene = std::make_unique<Scene>();
  Scene& s = *scene;
  s.name = "embree-user";
  s.model = model;
  s.target = model->target();
  s.places = std::move(places);
  s.grid_from_world = glm::inverse(s.places[0].world_from_grid);
  if (!s.target.box.empty()) {
    RTCGeometry geometry = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(s.places.size()));
    rtcSetGeometryUserData(geometry, &s);
    rtcSetGeometryBoundsFunction(geometry, &Scene::bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, &Scene::intersect);
    s.attach(s.scene, geometry);
  }
  rtcCommitScene(s.scene);
  s.check();
  return VoxelEmbreePeer(std::move(scene));
}

VoxelEmbreePeer VoxelEmbreePeer::triangles(const VoxelGrid& grid, std::vector<VoxelPlace> places) {
  auto scene = std::make_unique<Scene>();
  Scene& s = *scene;
  s.name = "embree-tri";
  s.places = std::move(places);
  s.make_quads(grid);
  if (!s.quads.empty()) {
    s.object = rtcNewScene(s.device);
    rtcSetSceneFlags(s.object, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s.object, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s.vertices.data(), 0,
                               3 * sizeof(float), s.vertices.size() / 3);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.indices.data(), 0,
                               3 * sizeof(std::uint32_t), s.indices.size() / 3);
    s.attach(s.object, geometry);
    rtcCommitScene(s.object);
    for (const VoxelPlace& place : s.places) {
      RTCGeometry instance = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, s.object);
      std::array<float, 12> columns{};
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) columns[3 * i + j] = static_cast<float>(place.world_from_grid[i][j]);
        columns[9 + i] = static_cast<float>(place.origin[i]);
      }
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
      s.attach(s.scene, instance);
    }
  }
  rtcCommitScene(s.scene);
  s.check();
  return VoxelEmbreePeer(std::move(scene));
}

std::vector<VoxelEngine> VoxelEmbreePeer::engines() const {
  const Scene& s = *scene_;
  const double own =
      static_cast<double>(s.model ? s.model->bytes() + s.places.size() * sizeof(VoxelPlace)
                                  : s.vertices.size() * sizeof(float) + s.indices.size() * sizeof(std::uint32_t) +
                                        s.quads.size() * sizeof(Quad));
  VoxelEngine engine;
  engine.name = s.name, engine.mode = "x1", engine.box = "bounds";
  engine.mib = (static_cast<double>(s.bytes) + own) / (1 << 20);
  std::vector<VoxelEngine> engines(2, engine);
  engines[0].trace = [&s](std::span<const Ray> rays, std::span<Hit> hits) { s.trace_single(rays, hits); };
  engines[1].mode = "x8";
  engines[1].trace = [&s](std::span<const Ray> rays, std::span<Hit> hits) { s.trace_eight(rays, hits); };
  return engines;
}

}  // namespace scarp::bench
