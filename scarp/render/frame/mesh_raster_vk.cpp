// SPDX-License-Identifier: MIT
#include "scarp/render/frame/mesh_raster_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <optional>

#include "scarp/base/error.h"
#include "scarp/render/frame/mesh_view.glsl.h"
#include "scarp/scene/terrain_scene_vk.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/raster.h"

namespace scarp {
namespace {

using glm::vec4;

constexpr std::uint32_t kTerrainVertex[] = {
#include "scarp/render/frame/terrain_raster.vert.inc"
};
constexpr std::uint32_t kTerrainFragment[] = {
#include "scarp/render/frame/terrain_raster.frag.inc"
};
constexpr std::uint32_t kMeshVertex[] = {
#include "scarp/render/frame/mesh_raster.vert.inc"
};
constexpr std::uint32_t kMeshFragment[] = {
#include "scarp/render/frame/mesh_raster.frag.inc"
};
constexpr std::uint32_t kSunMapVertex[] = {
#include "scarp/render/frame/sun_map.vert.inc"
};

constexpr std::uint32_t kMapSide = 2048;
constexpr std::uint32_t kColours = 2;

DeviceTerrain terrain_of(const TerrainScene& scene) {
  const DeviceTerrain* terrain = scene.device_terrain();
  if (!terrain) throw Error("mesh: is drawn by a Vulkan device, and the scene is not on one");
  return *terrain;
}

Box box_of(std::span<const MeshCorner> corners) {
  if (corners.empty() || corners.size() % 3 != 0) throw Error("mesh: has no triangles");
  Box box{corners.front().position, corners.front().position};
  for (const MeshCorner& corner : corners) {
    box.low = min(box.low, corner.position);
    box.high = max(box.high, corner.position);
  }
  return box;
}

// A row of a matrix, of positions counted from a base.
vec4 row_of(const glm::dmat4& m, int row, const dvec3& base, double factor = 1) {
  const dvec3 axis(m[0][row], m[1][row], m[2][row]);
  return vec4(vec3(factor * axis), factor * (dot(axis, base) + m[3][row]));
}

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double number) {
    low = std::min(low, number);
    high = std::max(high, number);
  }
};

}  // namespace

std::vector<MeshCorner> placed(const TriangleMesh& mesh, const MeshPlacement& placement) {
  const auto finite = [](const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  if (!(std::isfinite(placement.scale) && placement.scale > 0))
    throw Error(fmt::format("mesh: the scale is {}; it must be above 0", placement.scale));
  if (!std::isfinite(placement.turn_deg) || !finite(placement.at))
    throw Error("mesh: its place and its turn must be finite numbers");
  const Box box = box_of(mesh.corners);
  const dvec3 foot(box.middle().x, box.middle().y, box.low.z);
  const double turn = glm::radians(placement.turn_deg), c = std::cos(turn), s = std::sin(turn);
  const auto turned = [&](const dvec3& p) { return dvec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z); };
  std::vector<MeshCorner> corners = mesh.corners;
  for (MeshCorner& corner : corners) {
    corner.position = placement.at + placement.scale * turned(corner.position - foot);
    corner.normal = vec3(turned(dvec3(corner.normal)));
    if (!finite(corner.position)) throw Error("mesh: is too large at this scale");
  }
  return corners;
}

struct MeshRaster::Impl {
  Impl(const TerrainScene& scene_, std::span<const MeshCorner> corners)
      : scene(scene_),
        terrain(terrain_of(scene)),
        box(box_of(corners)),
        base(box.middle()),
        count(static_cast<std::uint32_t>(corners.size())),
        vertices(terrain.device, sizeof(glsl::MeshVertex) * corners.size(), "the mesh"),
        view_buffer(terrain.device, sizeof(glsl::MeshView), "the view of the mesh"),
        ground_pass(terrain.device, kTerrainVertex, kTerrainFragment, "terrain",
                    {.push_bytes = sizeof(glsl::MeshPush), .colours = kColours, .depth_test = false}),
        mesh_pass(terrain.device, kMeshVertex, kMeshFragment, "mesh",
                  {.push_bytes = sizeof(glsl::MeshPush), .colours = kColours}),
        map_pass(terrain.device, kSunMapVertex, {}, "sun map", {.push_bytes = sizeof(glsl::MeshPush), .colours = 0}),
        commands(terrain.device) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::size_t first = i / 3 * 3;
      const dvec3 a = corners[first].position;
      const dvec3 plane = cross(corners[first + 1].position - a, corners[first + 2].position - a);
      positions.push_back({vec3(corners[i].position - base), corners[i].normal,
                           length(plane) > 0 ? vec3(normalize(plane)) : corners[i].normal, corners[i].colour});
    }
    upload(vertices, 0, positions.data(), vertices.bytes());
    view.corners = vertices.address();
    view.ground = terrain.ground.address();
    set_field();
  }

  void set_field() {
    const HeightField& field = scene.field();
    const HeightFieldSettings& settings = field.settings();
    Ray at_base;
    at_base.origin = base;
    at_base.direction = {0, 0, 1};
    const dvec3 grid = field.grid_from_world(at_base).origin;
    const auto cell_of = [&](double position, int cells) {
      const double cell = std::floor(position);
      return field.wraps() ? cell - std::floor(cell / cells) * cells : std::clamp(cell, -1e9, 1e9);
    };
    view.base_cell = {static_cast<int>(cell_of(grid.x, field.cell_cols())),
                      static_cast<int>(cell_of(grid.y, field.cell_rows()))};
    view.base_place = {static_cast<float>(grid.x - std::floor(grid.x)),
                       static_cast<float>(grid.y - std::floor(grid.y))};
    view.base_z = static_cast<float>(grid.z);
    view.base_z_low = static_cast<float>(grid.z - static_cast<double>(view.base_z));
    view.grid_per_metre =
        vec3(dvec3(1 / settings.cell_x, -1 / settings.cell_y, 1 / (settings.scale * settings.exaggeration)));
  }

  // What of the view axis without perspective is drawn: some more than what is there. A mesh may be above the eye.
  Extent drawn_range(const Camera& camera, const DrawnPoints& points) const {
    Extent range;
    for (int i = 0; i < 8; ++i) range.add(dot(box.corner(i) - camera.eye(), camera.forward()));
    for (const float z : points.depth) {
      if (!std::isinf(z)) range.add(static_cast<double>(z));
    }
    const double more = 0x1p-4 * (range.high - range.low) + 1;
    return {range.low - more, range.high + more};
  }

  TerrainScene scene;  // keeps the ground
  DeviceTerrain terrain;
  Box box;
  dvec3 base;
  std::uint32_t count;
  std::vector<glsl::MeshVertex> positions;
  DeviceBuffer vertices, view_buffer;
  RasterPipeline ground_pass, mesh_pass, map_pass;
  Commands commands;
  glsl::MeshView view{};
  std::optional<DeviceBuffer> map;
};

MeshRaster::MeshRaster(const TerrainScene& scene, std::span<const MeshCorner> corners)
    : impl_(std::make_unique<Impl>(scene, corners)) {}
MeshRaster::MeshRaster(MeshRaster&&) noexcept = default;
MeshRaster& MeshRaster::operator=(MeshRaster&&) noexcept = default;
MeshRaster::~MeshRaster() = default;

std::shared_ptr<const SunShadow> MeshRaster::cast_shadow(const dvec3& to_sun) {
  Impl& all = *impl_;
  const RasterLimits limits = raster_limits(all.terrain.device);
  SunMapFrame frame;
  frame.to_sun = to_sun;
  frame.across = normalize(cross(std::abs(to_sun.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(0, 1, 0), to_sun));
  frame.up = cross(to_sun, frame.across);
  Extent a, b, h;
  for (const glsl::MeshVertex& corner : all.positions) {
    const dvec3 p(corner.position);
    a.add(dot(p, frame.across));
    b.add(dot(p, frame.up));
    h.add(dot(p, to_sun));
  }
  const double size = length(all.box.high - all.box.low);
  frame.side = static_cast<int>(std::min(kMapSide, limits.most_pixels));
  // One texel is free on each side, so that all of the mesh is drawn; and heights are above 0 and below 1.
  frame.texel = std::max(a.high - a.low, b.high - b.low) / (frame.side - 2);
  frame.range = (h.high - h.low) + 0x1p-6 * size;
  const dvec3 low =
      (a.low - frame.texel) * frame.across + (b.low - frame.texel) * frame.up + (h.low - 0x1p-7 * size) * to_sun;
  frame.low = all.base + low;
  frame.reach = 0.5 + std::ldexp(0.5, -static_cast<int>(limits.subpixel_bits));
  frame.rounding = 16 * 0x1p-24 * 2 * size / frame.range;

  all.view.sun_map = {vec3(low),
                      vec3(frame.across),
                      vec3(frame.up),
                      vec3(to_sun),
                      static_cast<float>(frame.texel),
                      frame.side,
                      static_cast<float>(frame.range),
                      static_cast<float>(frame.reach),
                      static_cast<float>(frame.rounding)};
  const auto side = static_cast<std::uint32_t>(frame.side);
  const RasterTarget target(all.terrain.device, side, side, 0);
  std::vector<float> heights(std::size_t{side} * side);
  if (!all.map) all.map.emplace(all.terrain.device, 4 * heights.size(), "the map of the mesh's shadow");
  upload(all.view_buffer, 0, &all.view, sizeof all.view);
  const glsl::MeshPush push{all.view_buffer.address()};
  all.commands.draw(target, {draw_call(all.map_pass, push, all.count)});
  all.commands.copy(target, 0, *all.map);
  all.commands.run();
  download(*all.map, 0, heights.data(), all.map->bytes());
  return std::make_shared<SunShadow>(frame, std::move(heights));
}

void MeshRaster::require_drawable(int width, int height) const {
  const Device& device = impl_->terrain.device;
  const auto most = static_cast<int>(raster_limits(device).most_pixels);
  if (width <= most && height <= most) return;
  throw Error(
      fmt::format("mesh: device '{}' draws {} points a side at most, and the picture has {} x {}; render it smaller or "
                  "with a smaller aa",
                  device.description().name, most, width, height));
}

DrawnPoints MeshRaster::draw(const Camera& camera, const DrawnPoints& terrain, const Light& light, bool shadows) {
  Impl& all = *impl_;
  const Device& device = all.terrain.device;
  const std::size_t points = terrain.depth.size();
  const RasterTarget target(device, static_cast<std::uint32_t>(terrain.width),
                            static_cast<std::uint32_t>(terrain.height), kColours);
  const DeviceBuffer colours(device, sizeof(vec3) * points, "the terrain's colours"),
      depths(device, sizeof(float) * points, "the terrain's depths"),
      drawn(device, sizeof(vec4) * points, "the picture"), normals(device, sizeof(vec4) * points, "normals");

  glsl::MeshView& view = all.view;
  const glm::dmat4 ndc = camera.ndc_from_world();
  const bool perspective = row_of(ndc, 3, dvec3(0)) != vec4(0, 0, 0, 1);
  const Extent range = all.drawn_range(camera, terrain);
  const double span = range.high - range.low;
  view.clip_x = row_of(ndc, 0, all.base);
  view.clip_y = row_of(ndc, 1, all.base, -1);
  view.clip_w = perspective ? row_of(ndc, 3, all.base) : vec4(0, 0, 0, 1);
  view.clip_z =
      perspective ? vec4(0, 0, 0, kMeshNear) : row_of(ndc, 2, all.base, -1 / span) + vec4(0, 0, 0, range.high / span);
  view.eye = perspective ? vec4(vec3(camera.eye() - all.base), 1) : vec4(vec3(-camera.forward()), 0);
  view.to_sun = vec3(light.to_sun());
  view.sun = light.sun();
  view.sky_side = vec3(light.sky_side());
  view.width = static_cast<std::uint32_t>(terrain.width);
  view.shadows = shadows;
  view.colours = colours.address();
  view.depths = depths.address();
  view.map = all.map ? all.map->address() : 0;
  if (!all.map) view.sun_map.side = 0;
  upload(all.view_buffer, 0, &view, sizeof view);

  std::vector<float> device_depths(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double z = static_cast<double>(terrain.depth[i]);
    device_depths[i] = std::isinf(z) ? 0.0f : static_cast<float>(perspective ? kMeshNear / z : (range.high - z) / span);
  }
  upload(depths, 0, device_depths.data(), depths.bytes());
  upload(colours, 0, terrain.colour.data(), colours.bytes());
  const glsl::MeshPush push{all.view_buffer.address()};
  all.commands.draw(target, {draw_call(all.ground_pass, push, 3), draw_call(all.mesh_pass, push, all.count)});
  all.commands.copy(target, 0, drawn);
  all.commands.copy(target, 1, normals);
  all.commands.copy(target, 2, depths);
  all.commands.run();

  DrawnPoints result{terrain.width, terrain.height, {}, terrain.depth, {}, {}};
  std::vector<vec4> four(points);
  download(drawn, 0, four.data(), drawn.bytes());
  for (const vec4& colour : four) {
    result.colour.emplace_back(colour);
    result.mesh.push_back(colour.w != 0);
  }
  download(normals, 0, four.data(), normals.bytes());
  for (const vec4& normal : four) result.normal.emplace_back(normal);
  download(depths, 0, device_depths.data(), depths.bytes());
  for (std::size_t i = 0; i < points; ++i) {
    if (!result.mesh[i]) continue;
    const double depth = static_cast<double>(device_depths[i]);
    result.depth[i] = static_cast<float>(perspective ? kMeshNear / depth : range.high - depth * span);
  }
  return result;
}

}  // namespace scarp
