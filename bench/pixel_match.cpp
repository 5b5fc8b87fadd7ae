// SPDX-License-Identifier: MIT
#include "bench/pixel_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

constexpr double kFov = std::numbers::pi / 4;

std::string text_of(const FaceOf& face) {
  return fmt::format("object {} voxel ({}, {}, {}) face {}", face.object, face.voxel.x, face.voxel.y, face.voxel.z,
                     static_cast<int>(face.face));
}

// Compares a row of pixels; `near` are the faces near edges of its pixels.
class Rows {
 public:
  Rows(const RasterPicture& quads, std::span<const Hit> hits, const PictureFrame& frame, double off)
      : quads_(quads), hits_(hits), frame_(frame), off_(off) {}

  void compare(int row) {
    const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.width);
    auto near = std::lower_bound(quads_.near_edges.begin(), quads_.near_edges.end(), first,
                                 [](const NearEdge& edge, std::size_t pixel) { return edge.pixel < pixel; });
    for (int col = 0; col < frame_.width; ++col) {
      const std::size_t pixel = first + static_cast<std::size_t>(col);
      auto end = near;
      while (end != quads_.near_edges.end() && end->pixel == pixel) ++end;
      compare(col, row, hits_[pixel], quads_.seen[pixel], {near, end});
      near = end;
    }
  }
  const PixelMatch& found() const { return found_; }

 private:
  void compare(int col, int row, const Hit& hit, const SeenFace& seen, std::span<const NearEdge> near) {
    const Ray ray = frame_.ray(col, row);
    const FaceOf face{hit.part, hit.voxel, hit.face};
    const bool covered = std::isfinite(seen.t);
    ++found_.pixels;
    found_.hits += hit ? 1 : 0;
    bool same = static_cast<bool>(hit) == covered && (!hit || face == seen.face);
    if (same && hit) {
      const int axis = static_cast<int>(face.face) / 2;
      // The error is twice as large along slow axes (kSlow of march/voxel/voxel_ray.h).
      const dvec3 d = glm::abs(ray.direction);
      const double off = off_ * (d[axis] < 0x1p-14 * std::max({d.x, d.y, d.z}) ? 2 : 1);
      const double error = std::abs((hit.t - seen.t) * ray.direction[axis]) / off;
      found_.t_error = std::max(found_.t_error, error);
      same = error <= 1;
    }
    if (near.empty()) {
      if (!same)
        differs(found_.differ, col, row, hit ? text_of(face) : "nothing", covered ? text_of(seen.face) : "nothing");
      return;
    }
    ++found_.near_edges;
    const bool one_of_them =
        hit && std::any_of(near.begin(), near.end(), [&](const NearEdge& edge) { return edge.face == face; });
    if (!same && !one_of_them) differs(found_.near_edge_wrong, col, row, hit ? text_of(face) : "nothing", "edges");
  }

  void differs(std::int64_t& count, int col, int row, const std::string& is, const std::string& expected) {
    ++count;
    if (found_.first.empty()) found_.first = fmt::format("pixel ({}, {}): {}; the quads: {}", col, row, is, expected);
  }

  const RasterPicture& quads_;
  std::span<const Hit> hits_;
  const PictureFrame& frame_;
  double off_;
  PixelMatch found_;
};

void add(PixelMatch& to, const PixelMatch& part) {
  to.pixels += part.pixels, to.hits += part.hits, to.near_edges += part.near_edges;
  to.differ += part.differ, to.near_edge_wrong += part.near_edge_wrong;
  to.t_error = std::max(to.t_error, part.t_error);
  if (to.first.empty()) to.first = part.first;
}

}  // namespace

std::vector<Ray> rays_of(const PictureFrame& frame) {
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  for (int row = 0; row < frame.height; ++row) {
    for (int col = 0; col < frame.width; ++col) rays.push_back(frame.ray(col, row));
  }
  return rays;
}

std::vector<Hit> hits_of(const Scene& scene, const PictureFrame& frame) {
  const std::vector<Ray> rays = rays_of(frame);
  std::vector<Hit> hits(rays.size());
  scene.closest_hits(rays, hits);
  return hits;
}

PixelMatch compare_with_quads(const RasterPicture& quads, std::span<const Hit> hits, const VoxelGrid& grid, double side,
                              const PictureFrame& frame) {
  const ivec3 size = grid.bounds().high - grid.bounds().low;
  const double longest = std::max({size.x, size.y, size.z});
  // In metres; the rounding error in double is far smaller.
  const double off = (std::ldexp(1, -21) + std::ldexp(longest, -29)) * side * (1 + std::ldexp(1, -10));
  PixelMatch match;
  const dvec2 corner = frame.place(0, 0) * frame.pixel;
  const double slant = frame.perspective ? std::sqrt(1 + dot(corner, corner)) / quads.least_depth : 1;
  match.ray_pixels = std::sqrt(3.0) * off * slant / frame.pixel;
  if (match.ray_pixels > kPixelMargin)
    throw Error(
        fmt::format("pixel-match: rays may be off by {} pixels, more than the margin of {}; the camera is too "
                    "close",
                    match.ray_pixels, kPixelMargin));
  std::mutex mutex;
  parallel_for(frame.height, 8, [&](std::int64_t begin, std::int64_t end) {
    Rows rows(quads, hits, frame, off);
    for (std::int64_t row = begin; row < end; ++row) rows.compare(static_cast<int>(row));
    const std::lock_guard lock(mutex);
    add(match, rows.found());
  });
  return match;
}

std::vector<NamedFrame> pixel_match_frames(int width, int height) {
  const auto looking = [&](const dvec3& eye, const dvec3& target, const dvec3& top) {
    return frame_looking(eye, target, top, kFov, width, height);
  };
  std::vector<NamedFrame> frames{{"post", looking({-16, 0, -16}, dvec3(0.0), {0, 1, 0})}};
  // Eyes are at multiples of a fraction of a voxel, off the planes between voxels.
  const dvec3 middle(128, 0, 128);
  for (int octant = 0; octant < 8; ++octant) {
    const dvec3 side(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    frames.push_back({fmt::format("octant {}", octant),
                      looking(middle + side * dvec3(100.3125, 60.1875, 90.4375), middle, {0, 1, 0})});
  }
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    dvec3 forward(0.0), top(0.0);
    forward[axis] = face % 2 ? 1 : -1;
    top[axis == 1 ? 2 : 1] = 1;
    const dvec3 eye = middle + dvec3(0.21875, 0.34375, 0.15625) - 170.0 * forward;
    const std::string name = fmt::format("{}{}", face % 2 ? '+' : '-', "xyz"[axis]);
    frames.push_back({name, looking(eye, eye + forward, top)});
    frames.push_back({name + " parallel", frame_along(eye, forward, top, 39.0625, width, height)});
  }
  // In the empty corner of an object, where eight objects meet.
  const dvec3 eye = dvec3(128, -8, 128) + 0.25 * dvec3(3.125, 2.875, 3.375);
  frames.push_back({"inside", looking(eye, eye + dvec3(-1, -0.25, 0.375), {0, 1, 0})});
  return frames;
}

}  // namespace scarp::bench
