// SPDX-License-Identifier: MIT
#include "bench/voxel_triangles.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "bench/voxel_triangles.glsl.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/raster.h"

namespace scarp::bench {
namespace {

constexpr std::uint32_t kVertexWords[] = {
#include "bench/voxel_triangles.vert.inc"
};
constexpr std::uint32_t kFragmentWords[] = {
#include "bench/voxel_triangles.frag.inc"
};

// Nearer than everything visible, and farther.
constexpr double kNear = 0x1p-10, kFar = 1024;

std::vector<std::uint32_t> face_words(const VoxelGrid& grid) {
  std::vector<std::uint32_t> words;
  for (const VoxelFaceAt& at : faces_of(grid)) {
    const auto part = [&](int axis) { return static_cast<std::uint32_t>(at.voxel[axis]) << (8 * axis); };
    words.push_back(part(0) | part(1) | part(2) | static_cast<std::uint32_t>(at.face) << 24);
  }
  // A buffer must not be empty.
  if (words.empty()) words.push_back(0);
  return words;
}

glsl::vec4 row_of(const dvec3& axis, double constant) { return glsl::vec4(axis.x, axis.y, axis.z, constant); }

}  // namespace

struct VoxelTriangles::Impl {
  Impl(const Device& device_, const VoxelGrid& grid, std::span<const VoxelPlace> places_)
      : device(device_),
        words(face_words(grid)),
        places(places_.begin(), places_.end()),
        pipeline(device_, kVertexWords, kFragmentWords, "triangles",
                 {.push_bytes = sizeof(glsl::VoxelTrianglesPush), .colours = 1, .of = RasterColours::words}),
        faces(device_, 4 * words.size(), "faces"),
        objects(device_, sizeof(glsl::vec3) * places.size(), "objects"),
        solid(grid.solid_count() > 0) {
    upload(faces, 0, words.data(), faces.bytes());
  }

  Device device;
  std::vector<std::uint32_t> words;
  std::vector<VoxelPlace> places;
  RasterPipeline pipeline;
  DeviceBuffer faces, objects;
  bool solid;
  std::optional<RasterTarget> target;
  std::optional<DeviceBuffer> pixels;
  Commands commands{device};  // declared after the resources of its runs: it waits for them
};

VoxelTriangles::VoxelTriangles(const Device& device, const VoxelGrid& grid, std::span<const VoxelPlace> places)
    : impl_(std::make_unique<Impl>(device, grid, places)) {}
VoxelTriangles::VoxelTriangles(VoxelTriangles&&) noexcept = default;
VoxelTriangles& VoxelTriangles::operator=(VoxelTriangles&&) noexcept = default;
VoxelTriangles::~VoxelTriangles() = default;

void VoxelTriangles::draw(const PictureFrame& frame) {
  Impl& all = *impl_;
  const auto width = static_cast<std::uint32_t>(frame.width), height = static_cast<std::uint32_t>(frame.height);
  if (!all.target || all.target->width() != width || all.target->height() != height) {
    all.target.emplace(all.device, width, height, 1, RasterColours::words);
    all.pixels.emplace(all.device, std::uint64_t{16} * width * height, "picture of triangles");
  }
  std::vector<glsl::vec3> less_eye;
  for (const VoxelPlace& place : all.places) less_eye.emplace_back(place.origin - frame.eye);
  upload(all.objects, 0, less_eye.data(), all.objects.bytes());
  glsl::VoxelTrianglesPush push{};
  push.faces = all.faces.address();
  push.objects = all.objects.address();
  push.side = static_cast<float>(all.places[0].world_from_grid[0][0]);
  push.near = static_cast<float>(frame.perspective ? kNear : kFar);
  push.x = row_of(frame.right * (2 / (frame.pixel * frame.width)), 0);
  push.y = row_of(frame.up * (-2 / (frame.pixel * frame.height)), 0);
  push.w = frame.perspective ? row_of(frame.forward, 0) : row_of(dvec3(0.0), 1);
  push.forward = glsl::vec3(frame.forward);
  push.parallel = !frame.perspective;
  const auto count = all.solid ? static_cast<std::uint32_t>(6 * all.words.size()) : 0;
  all.commands.draw(*all.target, {draw_call(all.pipeline, push, count, static_cast<std::uint32_t>(all.places.size()))});
  all.commands.copy(*all.target, 0, *all.pixels);
  all.commands.run();
}

const std::vector<PassTime>& VoxelTriangles::passes() const { return impl_->commands.passes(); }

std::vector<Hit> VoxelTriangles::drawn() const {
  std::vector<glsl::uvec4> words(impl_->pixels->bytes() / sizeof(glsl::uvec4));
  download(*impl_->pixels, 0, words.data(), impl_->pixels->bytes());
  std::vector<Hit> hits(words.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].x == 0) continue;
    const std::uint32_t face = words[i].y;
    hits[i].status = HitStatus::hit;
    hits[i].part = words[i].x - 1;
    hits[i].voxel = ivec3(face & 255u, face >> 8 & 255u, face >> 16 & 255u);
    hits[i].face = static_cast<VoxelFace>(face >> 24);
  }
  return hits;
}

double VoxelTriangles::snap(const PictureFrame& frame) const {
  const double corner = std::ldexp(1, -1 - static_cast<int>(raster_limits(impl_->device).subpixel_bits));
  // Positions as far as the farthest object at the depth of the picture's corner, where |place| / W is largest.
  const dvec2 edge = frame.place(0, 0) * frame.pixel;
  double far = 0;
  for (const VoxelPlace& place : impl_->places) far = std::max(far, length(place.origin - frame.eye) + 16);
  const double places = frame.perspective ? std::sqrt(1 + dot(edge, edge)) : far;
  return std::sqrt(2.0) * (corner + std::ldexp(frame.width, -22) + std::ldexp(places / frame.pixel, -21));
}

std::size_t VoxelTriangles::triangles() const { return impl_->solid ? 2 * impl_->words.size() : 0; }
std::uint64_t VoxelTriangles::bytes() const { return impl_->faces.bytes() + impl_->objects.bytes(); }

TrianglesMatch compare_with_triangles(const RasterPicture& quads, std::span<const Hit> drawn, std::span<const Hit> hits,
                                      const PictureFrame& frame) {
  TrianglesMatch match;
  auto near = quads.near_edges.begin();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    bool at_edge = false;
    for (; near != quads.near_edges.end() && near->pixel == i; ++near) at_edge = true;
    ++match.pixels;
    match.near_edges += at_edge;
    const Hit &a = drawn[i], &b = hits[i];
    const bool same = static_cast<bool>(a) == static_cast<bool>(b) &&
                      (!a || (a.part == b.part && a.voxel == b.voxel && a.face == b.face));
    if (same) continue;
    ++(at_edge ? match.other : match.differ);
    if (at_edge || !match.first.empty()) continue;
    const auto width = static_cast<std::size_t>(frame.width);
    match.first = fmt::format(
        "pixel ({}, {}): {} object {} voxel ({}, {}, {}) face {}; triangles: {} object {} voxel ({}, {}, {}) face {}",
        i % width, i / width, b ? "hit" : "miss", b.part, b.voxel.x, b.voxel.y, b.voxel.z, static_cast<int>(b.face),
        a ? "hit" : "miss", a.part, a.voxel.x, a.voxel.y, a.voxel.z, static_cast<int>(a.face));
  }
  return match;
}

VoxelPicture picture_of(const PictureFrame& frame) {
  VoxelPicture picture{static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height)};
  const dvec3 right = frame.pixel * frame.right, down = -frame.pixel * frame.up;
  const dvec3 corner = -(0.5 * frame.width * right + 0.5 * frame.height * down);
  picture.origin = frame.eye;
  picture.direction = frame.forward;
  if (frame.perspective) {
    picture.right = right, picture.down = down;
    picture.direction += corner;
  } else {
    picture.origin_right = right, picture.origin_down = down;
    picture.origin += corner;
  }
  return picture;
}

}  // namespace scarp::bench
