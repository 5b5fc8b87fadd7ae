// SPDX-License-Identifier: MIT
#include "bench/embree_peer.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <atomic>
#include <cstdint>

#include "bench/embree_modes.h"
#include "bench/instruction_set.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

// Memory that Embree allocates, as reported by its memory monitor.
struct Memory {
  std::atomic<std::int64_t> current{0}, peak{0};

  static bool count(void* self, ssize_t bytes, bool) {
    Memory& memory = *static_cast<Memory*>(self);
    const std::int64_t now = memory.current += bytes;
    std::int64_t peak = memory.peak;
    while (now > peak && !memory.peak.compare_exchange_weak(peak, now)) {
    }
    return true;
  }
};

constexpr std::int64_t kRowsPerPiece = 64;

// x, y, z of each sample in world space, and one extra float: Embree reads the last vertex with four lanes.
std::vector<float> vertices_of(const HeightField& field) {
  const std::size_t cols = static_cast<std::size_t>(field.cols());
  std::vector<float> vertices(cols * static_cast<std::size_t>(field.rows()) * 3 + 1);
  field.visit([&](const auto& grid) {
    parallel_for(field.rows(), kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
      for (int row = static_cast<int>(begin); row < end; ++row) {
        float* out = vertices.data() + static_cast<std::size_t>(row) * cols * 3;
        for (int col = 0; col < field.cols(); ++col) {
          const dvec3 at = field.world_from_grid(col, row, static_cast<double>(grid.at(col, row)));
          for (int axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(at[axis]);
        }
      }
    });
  });
  return vertices;
}

// Two triangles per cell, split from (col+1, row) to (col, row+1), counterclockwise as seen from above.
std::vector<std::uint32_t> triangles_of(const HeightField& field) {
  const std::size_t cell_cols = static_cast<std::size_t>(field.cell_cols());
  std::vector<std::uint32_t> indices(cell_cols * static_cast<std::size_t>(field.cell_rows()) * 6);
  parallel_for(field.cell_rows(), kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t row = begin; row < end; ++row) {
      std::uint32_t* out = indices.data() + static_cast<std::size_t>(row) * cell_cols * 6;
      for (int col = 0; col < field.cell_cols(); ++col) {
        const auto nw = static_cast<std::uint32_t>(row * field.cols() + col), ne = nw + 1;
        const auto sw = nw + static_cast<std::uint32_t>(field.cols()), se = sw + 1;
        for (const std::uint32_t corner : {nw, sw, ne, ne, sw, se}) *out++ = corner;
      }
    }
  });
  return indices;
}

}  // namespace

struct EmbreePeer::Scene {
  // Declared first, destroyed last: Embree reports deallocations while its device is released.
  Memory memory;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  EmbreeSurface surface;
  bool robust;
  double build_s = 0;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Scene() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void check(std::string_view what) const {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
      throw Error(
          fmt::format("Embree, {}: error {}; too little memory is the usual cause", what, static_cast<int>(error)));
    }
  }

  double input_bytes() const {
    return static_cast<double>(vertices.size() * sizeof(float) + indices.size() * sizeof(std::uint32_t));
  }
};

EmbreeQuality find_embree_quality(std::string_view name) {
  if (name == "medium") return EmbreeQuality::medium;
  if (name == "high") return EmbreeQuality::high;
  throw Error(fmt::format("Embree quality '{}': unknown (available: medium, high)", name));
}

EmbreePeer::EmbreePeer(const HeightField& field, EmbreeSurface surface, EmbreeQuality quality, bool robust)
    : scene_(std::make_unique<Scene>()) {
  Scene& s = *scene_;
  s.surface = surface;
  s.robust = robust;
  s.device = rtcNewDevice(embree_configuration());
  s.check("device");
  rtcSetDeviceMemoryMonitorFunction(s.device, &Memory::count, &s.memory);

  const Stopwatch watch;
  s.scene = rtcNewScene(s.device);
  rtcSetSceneFlags(s.scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(s.scene, quality == EmbreeQuality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
  s.vertices = vertices_of(field);
  const std::size_t vertex_count = static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows());
  const bool grid = surface == EmbreeSurface::grid;
  RTCGeometry geometry = rtcNewGeometry(s.device, grid ? RTC_GEOMETRY_TYPE_GRID : RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s.vertices.data(), 0,
                             3 * sizeof(float), vertex_count);
  if (grid) {
    auto* one = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    s.check("grid buffer");
    *one = {0, static_cast<unsigned>(field.cols()), static_cast<unsigned short>(field.cols()),
            static_cast<unsigned short>(field.rows())};
  } else {
    s.indices = triangles_of(field);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.indices.data(), 0,
                               3 * sizeof(std::uint32_t), s.indices.size() / 3);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(s.scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(s.scene);
  s.build_s = watch.wall_s();
  s.check("scene");
}

EmbreePeer::~EmbreePeer() = default;

RTCSceneTy* EmbreePeer::scene() const { return scene_->scene; }

std::vector<Engine> EmbreePeer::engines() const {
  const Scene& s = *scene_;
  Engine common;
  common.name = s.surface == EmbreeSurface::grid ? "embree-grid" : "embree-tri";
  if (!s.robust) common.name += "-default";
  common.bytes = static_cast<double>(s.memory.current) + s.input_bytes();
  common.peak_bytes = static_cast<double>(s.memory.peak) + s.input_bytes();
  common.build_s = s.build_s;
  std::vector<Engine> engines;
  for (const EmbreeMode& mode : embree_modes()) {
    Engine engine = common;
    engine.mode = mode.name;
    // The reference is always measured in full.
    engine.on_trial = s.surface == EmbreeSurface::grid || !s.robust || engines.size() > 0;
    engine.trace = [&mode, scene = s.scene](const RaySet& set, std::int64_t begin, std::int64_t end, float* answers) {
      mode.trace(scene, mode, set, begin, end, answers);
    };
    engines.push_back(std::move(engine));
  }
  return engines;
}

std::string EmbreePeer::version() { return RTC_VERSION_STRING; }

}  // namespace scarp::bench
