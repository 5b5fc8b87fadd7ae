// SPDX-License-Identifier: MIT
// `scarp-bench gpu --raster`: visibility per pixel by rays (max-mip) and by drawing the whole grid as two triangles per
// cell, alternately, from the same samples in the device's memory. The drawing writes only depths, the minimum for
// visibility.
//
// Both surfaces are the triangles, so depths are equal except for rounding. In a pixel the reciprocal of the view
// depth, 1/z, changes by g_x, g_y per pixel, from the triangle that the ray has hit; with v = 2^-24 the two may differ
// by
//
//   s_x |g_x| + s_y |g_y|         corners are drawn up to s pixels off their positions: 2^-(bits + 1) by the device's
//                                 sub-pixel grid, and 8 v of the terms of x and w (6 roundings: the matrix, the sample
//                                 minus the eye's, a product, three sums); the same for y
//   (8 v S_w / z + 4 v) / z       w itself, the division, the depth as a float; the rays' directions as floats
//   4 v (1/z + W |g_x| + H |g_y|) the plane through a triangle's depths, W x H pixels
//   d N_z / (z |N P|)             the march: up to d = 2 rho lower or higher (doc/dev/numerics.md)
//
// Larger differences are counted: pixels next to an edge, where the other side of s is another slope or another ridge.
// There, rays through the corners of the square of s find what drawing may show; anything else is unexplained.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "bench/device_seconds.h"
#include "bench/fields.h"
#include "bench/gpu_options.h"
#include "bench/grid_mesh.glsl.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "scarp/accel/device_ground.h"
#include "scarp/base/error.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/vk/raster.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;
using glm::vec4;

constexpr std::uint32_t kVertexWords[] = {
#include "bench/grid_mesh.vert.inc"
};

constexpr double kUnit = 0x1p-24;
constexpr float kNear = 1;  // the camera is farther than this from all ground
constexpr RayCounts kCpuDeviceRays{480, 264, 1, 1, 8};

HeightField as_triangles(const BenchField& ground) {
  HeightFieldSettings settings = ground.field.settings();
  settings.surface = Surface::triangles;
  return ground.field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
}

// Two triangles for each cell of a patch, split like those of Surface::triangles.
std::vector<std::uint32_t> patch_indices() {
  std::vector<std::uint32_t> indices;
  constexpr std::uint32_t kSide = glsl::kGridPatch + 1;
  for (std::uint32_t row = 0; row < glsl::kGridPatch; ++row) {
    for (std::uint32_t col = 0; col < glsl::kGridPatch; ++col) {
      const std::uint32_t at = row * kSide + col;
      for (const std::uint32_t corner : {at, at + 1, at + kSide, at + kSide, at + 1, at + kSide + 1})
        indices.push_back(corner);
    }
  }
  return indices;
}

// The grid as a mesh to draw.
class GridMesh {
 public:
  GridMesh(const Device& device, const HeightField& field, const DeviceGround& ground, const PinholeCamera& camera)
      : camera_(camera),
        target_(device, static_cast<std::uint32_t>(camera.width), static_cast<std::uint32_t>(camera.height), 0),
        pipeline_(device, kVertexWords, {}, "grid-mesh", {.push_bytes = sizeof(glsl::GridMeshPush), .colours = 0}),
        indices_(device, 4 * patch_indices().size(), "indices"),
        depths_(device, 4 * pixels(), "depths"),
        commands_(device) {
    const std::vector<std::uint32_t> indices = patch_indices();
    upload(indices_, 0, indices.data(), indices_.bytes());
    count_ = static_cast<std::uint32_t>(indices.size());
    const auto patches = [](int cells) {
      return (static_cast<std::uint32_t>(cells) + glsl::kGridPatch - 1) / glsl::kGridPatch;
    };
    instances_ = patches(field.cell_cols()) * patches(field.cell_rows());
    // World coordinates are linear in the grid's.
    const HeightFieldSettings& settings = field.settings();
    const double per_sample = settings.scale * settings.exaggeration;
    const dvec3 origin = field.world_from_grid(0, 0, 0);
    push_.ground = ground.address();
    push_.patches = patches(field.cell_cols());
    push_.near = kNear;
    const double eye_col = (camera.eye.x - origin.x) / settings.cell_x,
                 eye_row = (origin.y - camera.eye.y) / settings.cell_y;
    push_.eye_cell = {static_cast<int>(std::floor(eye_col)), static_cast<int>(std::floor(eye_row))};
    push_.eye_sample = static_cast<float>((camera.eye.z - origin.z) / per_sample);
    const dvec3 node_zero = origin + dvec3(push_.eye_cell.x * settings.cell_x, -push_.eye_cell.y * settings.cell_y,
                                           static_cast<double>(push_.eye_sample) * per_sample);
    const auto row = [&](const dvec3& axis) {
      return vec4(axis.x * settings.cell_x, -axis.y * settings.cell_y, axis.z * per_sample,
                  dot(axis, node_zero - camera.eye));
    };
    push_.x = row(camera.right / camera.half_width);
    push_.y = row(-camera.up / camera.half_height);
    push_.w = row(camera.forward);
  }

  /// Returns the times of its passes.
  const std::vector<PassTime>& draw() {
    commands_.draw(target_, {draw_call(pipeline_, push_, count_, instances_, &indices_)});
    commands_.copy(target_, 0, depths_);
    commands_.run();
    return commands_.passes();
  }
  /// kNear / view depth, row by row; 0 where there is nothing.
  std::vector<float> depths() const {
    std::vector<float> depths(pixels());
    download(depths_, 0, depths.data(), depths_.bytes());
    return depths;
  }

  /// Maximum displacement, in pixels, of drawn corners that are `to` from the eye.
  dvec2 beside(const dvec3& to, std::uint32_t subpixel_bits) const {
    const double z = dot(to, camera_.forward), sw = terms(to, camera_.forward, 1),
                 snap = std::ldexp(0.5, -static_cast<int>(subpixel_bits));
    const auto along = [&](const dvec3& axis, double half, double pixels_across) {
      return snap + pixels_across / 2 * 8 * kUnit * (terms(to, axis, half) + sw) / z + 4 * kUnit * pixels_across;
    };
    return {along(camera_.right, camera_.half_width, camera_.width),
            along(camera_.up, camera_.half_height, camera_.height)};
  }

  /// Bound of the difference of 1/z for a hit of the ray through a pixel.
  double bound(const HeightField& field, const Hit& hit, const Ray& ray, std::uint32_t subpixel_bits) const {
    const double width = camera_.width, height = camera_.height;
    const dvec3 to = ray.at(hit.t) - ray.origin, normal = field.normal(hit.cell, hit.u, hit.v);
    const double z = dot(to, camera_.forward), plane = std::abs(dot(normal, to));
    const double gx = std::abs(dot(normal, camera_.right)) * 2 * camera_.half_width / width / plane,
                 gy = std::abs(dot(normal, camera_.up)) * 2 * camera_.half_height / height / plane;
    const double sw = terms(to, camera_.forward, 1);
    const dvec2 s = beside(to, subpixel_bits);
    const CellHeights h = field.cell_heights(hit.cell).value();
    const double per_sample = field.settings().scale * field.settings().exaggeration;
    const double relief =
        (std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11})) * per_sample;
    // rho at the far side of a tile of 1,024 cells, using the heights of the whole field instead of those of the tile.
    const double rho = 16 * kUnit * (3 * (field.max_height() - field.min_height()) + 2049 * relief);
    return s.x * gx + s.y * gy + (8 * kUnit * sw / z + 4 * kUnit) / z + 4 * kUnit * (1 / z + width * gx + height * gy) +
           2 * rho * std::abs(normal.z) / (z * plane);
  }

 private:
  // The terms of a clip coordinate, each at its largest.
  static double terms(const dvec3& to, const dvec3& axis, double scale) {
    return (std::abs(axis.x * to.x) + std::abs(axis.y * to.y) + std::abs(axis.z * to.z) + length(axis)) / scale;
  }
  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(camera_.width) * static_cast<std::uint64_t>(camera_.height);
  }

  const PinholeCamera& camera_;
  RasterTarget target_;
  RasterPipeline pipeline_;
  DeviceBuffer indices_, depths_;
  Commands commands_;
  glsl::GridMeshPush push_{};
  std::uint32_t count_ = 0, instances_ = 0;
};

// A pixel whose drawn depth differs from that of its ray.
struct Otherwise {
  double drawn;  // 1/z, 0: nothing
  Ray ray;
  std::array<Ray, 4> corners;  // of the square of s
};

Otherwise otherwise(const PinholeCamera& camera, const GridMesh& mesh, const Ray& ray, double x, double y, double z,
                    double drawn, std::uint32_t bits) {
  const dvec3 to = ray.direction * (z / dot(ray.direction, camera.forward));
  const dvec2 s = mesh.beside(to, bits);
  Otherwise pixel{drawn, ray, {}};
  for (int i = 0; i < 4; ++i) {
    const double at_x = x + (i % 2 ? s.x : -s.x), at_y = y + (i / 2 ? s.y : -s.y);
    Ray& corner = pixel.corners[static_cast<std::size_t>(i)];
    corner = ray;
    corner.direction = camera.forward + (at_x / camera.width * 2 - 1) * camera.half_width * camera.right +
                       (1 - at_y / camera.height * 2) * camera.half_height * camera.up;
  }
  return pixel;
}

// Number of pixels whose depth is outside the range of their own ray and the rays through the corners.
std::int64_t unexplained(const std::vector<Otherwise>& pixels, DeviceQueries& queries, const DeviceTarget& target,
                         const PinholeCamera& camera, const GridMesh& mesh, std::uint32_t bits) {
  std::int64_t count = 0;
  for (const Otherwise& pixel : pixels) {
    std::vector<Ray> rays(pixel.corners.begin(), pixel.corners.end());
    rays.push_back(pixel.ray);
    std::vector<Hit> hits(rays.size());
    queries.closest_hits(target, rays, hits);
    bool nothing = false;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      nothing = nothing || !hits[i];
      if (!hits[i]) continue;
      const double cast = 1 / dot(rays[i].at(hits[i].t) - rays[i].origin, camera.forward),
                   bound = mesh.bound(*target.field, hits[i], rays[i], bits);
      low = std::min(low, cast - bound);
      high = std::max(high, cast + bound);
    }
    count += pixel.drawn == 0 ? !nothing : !(low <= pixel.drawn && pixel.drawn <= high);
  }
  return count;
}

double spread_of(const std::vector<double>& times) {
  const auto [fastest, slowest] = std::minmax_element(times.begin(), times.end());
  return (*slowest - *fastest) / median(times);
}

double march(const Device& device, DeviceQueries& queries, const DeviceTarget& target, const std::vector<Ray>& rays,
             std::vector<Hit>& hits) {
  queries.closest_hits(target, rays, hits);
  return device_seconds(device, queries.passes());
}

// `device` and `drawing` are the same device, opened twice: after a draw, lavapipe (Mesa 22.3) writes both timestamps
// around a dispatch when the dispatch has finished.
void compare(const Device& device, const Device& drawing, const GpuOptions& options, const BenchField& ground,
             const RayCounts& counts, Json& rows) {
  const HeightField triangles = as_triangles(ground);
  const DeviceGround bilinear_memory(device, ground.field), memory(device, triangles), drawn_memory(drawing, triangles);
  const RaySet set = std::move(make_rays(ground, {RayClass::primary}, counts, options.ray_seed).front());
  const PinholeCamera camera = primary_camera(ground.field, counts.width, counts.height);
  const auto all = static_cast<std::uint32_t>(set.rays.size());
  DeviceQueries queries(device, find_height_march("max-mip"), {}, {false, all});
  GridMesh mesh(drawing, triangles, drawn_memory, camera);
  std::vector<Hit> hits(set.rays.size());
  std::vector<double> ray_times, bilinear_times, mesh_times;
  for (int pass = 0; pass <= options.repeats; ++pass) {
    const double bilinear_s = march(device, queries, {&ground.field, &bilinear_memory}, set.library_rays, hits);
    const double ray_s = march(device, queries, {&triangles, &memory}, set.library_rays, hits);
    const double mesh_s = device_seconds(device, mesh.draw());
    if (pass == 0) continue;
    bilinear_times.push_back(bilinear_s);
    ray_times.push_back(ray_s);
    mesh_times.push_back(mesh_s);
  }
  const std::vector<float> depths = mesh.depths();
  const std::uint32_t bits = raster_limits(device).subpixel_bits;
  std::int64_t seen = 0, differing = 0, one_alone = 0;
  std::vector<Otherwise> others;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto [x, y] = primary_pixel(i, counts.width);
    const Ray& ray = set.library_rays[i];
    const double drawn = static_cast<double>(depths[static_cast<std::size_t>(y * counts.width + x)]) / kNear;
    seen += static_cast<bool>(hits[i]);
    if (!hits[i] && drawn == 0) continue;
    const double z = hits[i] ? dot(ray.at(hits[i].t) - ray.origin, camera.forward) : 1 / drawn;
    const bool alone = !hits[i] || drawn == 0;
    if (!alone && std::abs(drawn - 1 / z) <= mesh.bound(triangles, hits[i], ray, bits)) continue;
    ++(alone ? one_alone : differing);
    others.push_back(otherwise(camera, mesh, ray, x + 0.5, y + 0.5, z, drawn, bits));
  }
  const double unexplained_rate =
      static_cast<double>(unexplained(others, queries, {&triangles, &memory}, camera, mesh, bits)) /
      static_cast<double>(hits.size());
  const auto add = [&](const char* mode, const std::vector<double>& times) {
    const double pixels = static_cast<double>(hits.size());
    const bool drawn = &times == &mesh_times;
    Json row;
    row["size"] = ground.field.cols();
    row["mode"] = mode;
    row["ms"] = median(times) * 1e3;
    row["spread"] = spread_of(times);
    row["mesh_ratio"] = median(times) / median(mesh_times);
    row["pixels"] = hits.size();
    row["triangles_per_pixel"] = 2.0 * triangles.cell_cols() * triangles.cell_rows() / pixels;
    row["hit_share"] = static_cast<double>(seen) / pixels;
    row["differing_rate"] = drawn ? Json(static_cast<double>(differing) / pixels) : Json();
    row["one_alone_rate"] = drawn ? Json(static_cast<double>(one_alone) / pixels) : Json();
    row["unexplained_rate"] = drawn ? Json(unexplained_rate) : Json();
    row["device"] = device.description().name;
    row["driver"] = device.description().driver;
    row["field"] = ground.name;
    rows.push_back(row);
  };
  add("max-mip", bilinear_times);
  add("max-mip, triangles", ray_times);
  add("grid-mesh", mesh_times);
}

}  // namespace

void run_gpu_raster(const GpuOptions& options, const ReportOptions& report) {
  const Device device({.choice = options.device}), drawing({.choice = options.device});
  const DeviceDescription& description = device.description();
  fmt::print("{}, {}\n", description.name, description.driver);
  if (!description.abilities.timestamps)
    throw Error(fmt::format("device '{}': has no timestamps, by which gpu measures", description.name));
  const bool cpu = description.kind == DeviceKind::cpu;
  std::vector<int> sizes = options.sizes;
  if (sizes.empty())
    sizes = cpu ? std::vector<int>{257, 513, 1025, 2049, 4097} : std::vector<int>{1025, 2049, 4097, 16385};
  const RayCounts counts = options.rays.value_or(cpu ? kCpuDeviceRays : RayCounts{});
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"samples", "mode", "ms", "x mesh", "triangles/pixel", "hits %", "differ %", "one alone %", "unexplained %"}};
  const auto percent = [](const Json& share) {
    return share.is_null() ? "-" : short_number(100 * share.get<double>());
  };
  for (const int size : sizes) {
    FieldOptions field = options.field;
    field.size = size;
    const std::size_t first = rows.size();
    compare(device, drawing, options, load_field(field), counts, rows);
    for (std::size_t i = first; i < rows.size(); ++i) {
      const Json& row = rows[i];
      lines.push_back({short_number(row["size"]), row["mode"], short_number(row["ms"]), short_number(row["mesh_ratio"]),
                       short_number(row["triangles_per_pixel"]), percent(row["hit_share"]),
                       percent(row["differing_rate"]), percent(row["one_alone_rate"]),
                       percent(row["unexplained_rate"])});
    }
  }
  print_table(lines, 2);
  write_json(report, rows);
}

}  // namespace scarp::bench
