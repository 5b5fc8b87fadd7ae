// SPDX-License-Identifier: MIT
#include "bench/quad_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kStripRows = 32;

// Homogeneous picture coordinates are linear in those of a grid.
struct Projection {
  dvec3 origin;               // position of the grid's corner
  std::array<dvec3, 3> axis;  // vectors along the sides of a voxel
};

Projection projection(const PictureFrame& frame, const VoxelPlace& place) {
  const auto linear = [&](const dvec3& v) {
    return dvec3(dot(v, frame.right) / frame.pixel, dot(v, frame.up) / frame.pixel,
                 frame.perspective ? dot(v, frame.forward) : 0.0);
  };
  Projection to{linear(place.origin - frame.eye), {}};
  if (!frame.perspective) to.origin.z = 1;
  for (int a = 0; a < 3; ++a) to.axis[static_cast<std::size_t>(a)] = linear(place.world_from_grid[a]);
  return to;
}

// Extent of a convex object in the picture, in pixels; the whole picture if it reaches the eye's plane.
struct Extent {
  double x_low = kInfinity, x_high = -kInfinity, y_low = kInfinity, y_high = -kInfinity;
  bool behind = true;  // entirely behind the eye

  void add(const dvec3& corner, double least_w) {
    if (corner.z <= least_w) return;
    behind = false;
    x_low = std::min(x_low, corner.x / corner.z), x_high = std::max(x_high, corner.x / corner.z);
    y_low = std::min(y_low, corner.y / corner.z), y_high = std::max(y_high, corner.y / corner.z);
  }
  // Corners in order around it, so that clipping at the eye's plane cuts edges.
  void add_ring(std::span<const dvec3> ring, double least_w) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const dvec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      add(a, least_w);
      if ((a.z > least_w) == (b.z > least_w)) continue;
      dvec3 cut = a + (b - a) * ((least_w - a.z) / (b.z - a.z));
      cut.z = least_w;
      add(cut, 0);
    }
  }
};

// Nothing visible is closer to the eye's plane, in voxel sides: it would fill the picture.
constexpr double kLeastDepth = 1e-9;

double distance_to_segment(const dvec2& p, const dvec3& a, const dvec3& b) {
  if (a.z <= 0 || b.z <= 0) return kInfinity;  // its line decides
  const dvec2 from(a.x / a.z, a.y / a.z), along = dvec2(b.x / b.z, b.y / b.z) - from;
  const double square = dot(along, along);
  const double s = square > 0 ? std::clamp(dot(p - from, along) / square, 0.0, 1.0) : 0.0;
  return length(p - from - s * along);
}

class Strip {
 public:
  Strip(const PictureFrame& frame, double margin, int row_begin, int row_end, RasterPicture& picture)
      : frame_(frame), margin_(margin), row_begin_(row_begin), row_end_(row_end), picture_(picture) {}

  void draw(const VoxelPlace& place, std::uint32_t object, const Projection& to, std::span<const VoxelFaceAt> faces) {
    const double side = place.world_from_grid[0][0];
    const dvec3 eye = (frame_.eye - place.origin) / side;
    for (const VoxelFaceAt& face : faces) {
      const int axis = static_cast<int>(face.face) / 2, out = static_cast<int>(face.face) % 2 ? 1 : -1;
      const int plane = face.voxel[axis] + (out > 0 ? 1 : 0);
      // Seen from behind or edge-on.
      if (frame_.perspective ? !((eye[axis] - plane) * out > 0) : !(frame_.forward[axis] * out < 0)) continue;
      const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
      const auto a = static_cast<std::size_t>(axis);
      dvec3 corner = to.origin + static_cast<double>(plane) * to.axis[a];
      corner += static_cast<double>(face.voxel[static_cast<int>(u)]) * to.axis[u];
      corner += static_cast<double>(face.voxel[static_cast<int>(v)]) * to.axis[v];
      const std::array<dvec3, 4> ring = {corner, corner + to.axis[u], corner + to.axis[u] + to.axis[v],
                                         corner + to.axis[v]};
      draw_quad(ring, {object, face.voxel, face.face}, axis, place.origin[axis] + side * plane, place);
    }
  }

  std::vector<NearEdge>& near_edges() { return near_edges_; }

 private:
  void draw_quad(const std::array<dvec3, 4>& ring, const FaceOf& face, int axis, double plane,
                 const VoxelPlace& place) {
    Extent extent;
    extent.add_ring(ring, frame_.perspective ? kLeastDepth * place.world_from_grid[0][0] : 0);
    if (extent.behind) return;
    const double middle_x = 0.5 * frame_.width, middle_y = 0.5 * frame_.height;
    // Pixels whose centres are in the extent plus the margin.
    const auto first = [&](double low) { return static_cast<int>(std::ceil(std::max(low - margin_ - 0.5, 0.0))); };
    const auto last = [&](double high, int count) {
      return static_cast<int>(std::floor(std::min(high + margin_ - 0.5, count - 1.0)));
    };
    const int col_begin = first(extent.x_low + middle_x), col_end = last(extent.x_high + middle_x, frame_.width) + 1;
    const int row_begin = std::max(first(middle_y - extent.y_high), row_begin_);
    const int row_end = std::min(last(middle_y - extent.y_low, frame_.height) + 1, row_end_);
    if (col_begin >= col_end || row_begin >= row_end) return;

    std::array<dvec3, 4> edge;
    for (std::size_t i = 0; i < 4; ++i) {
      edge[i] = cross(ring[i], ring[(i + 1) % 4]);
      edge[i] /= std::hypot(edge[i].x, edge[i].y);
    }
    // The middle of the quad is inside.
    const double sign = dot(edge[0], ring[0] + ring[1] + ring[2] + ring[3]) > 0 ? 1 : -1;
    for (int row = row_begin; row < row_end; ++row) {
      for (int col = col_begin; col < col_end; ++col) {
        const dvec2 p = frame_.place(col, row);
        double inside = kInfinity;
        for (const dvec3& e : edge) inside = std::min(inside, sign * (e.x * p.x + e.y * p.y + e.z));
        if (inside <= -margin_) continue;
        if (inside < margin_ && !near_edge(p, ring, inside)) continue;
        const std::size_t pixel =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.width) + static_cast<std::size_t>(col);
        if (inside < margin_) {
          near_edges_.push_back({static_cast<std::uint32_t>(pixel), face, least_t(face, place)});
        } else if (const double t = depth(col, row, axis, plane); t < picture_.seen[pixel].t) {
          picture_.seen[pixel] = {t, face};
        }
      }
    }
  }

  // Beyond a sharp corner the lines are close although the edges are not.
  bool near_edge(const dvec2& p, const std::array<dvec3, 4>& ring, double inside) const {
    if (inside > 0) return true;
    double distance = kInfinity;
    for (std::size_t i = 0; i < 4; ++i) {
      const double to_edge = distance_to_segment(p, ring[i], ring[(i + 1) % 4]);
      if (to_edge == kInfinity) return true;
      distance = std::min(distance, to_edge);
    }
    return distance < margin_;
  }

  double depth(int col, int row, int axis, double plane) const {
    const Ray ray = frame_.ray(col, row);
    return (plane - ray.origin[axis]) / ray.direction[axis];
  }

  double least_t(const FaceOf& face, const VoxelPlace& place) const {
    const int axis = static_cast<int>(face.face) / 2;
    double least = kInfinity;
    for (int corner = 0; corner < 8; ++corner) {
      if ((corner >> axis & 1) != static_cast<int>(face.face) % 2) continue;
      const dvec3 p = place.world_from_grid * dvec3(face.voxel + ivec3(corner & 1, corner >> 1 & 1, corner >> 2));
      least = std::min(least, dot(p + place.origin - frame_.eye, frame_.forward));
    }
    return least;
  }

  const PictureFrame& frame_;
  double margin_;
  int row_begin_, row_end_;
  RasterPicture& picture_;  // only its own rows
  std::vector<NearEdge> near_edges_;
};

// The rows of a picture that an object may reach; all of them if it reaches the eye's plane.
std::pair<int, int> rows_of(const PictureFrame& frame, const Projection& to, const VoxelBox& box, double margin) {
  Extent extent;
  bool all_in_front = true;
  for (int i = 0; i < 8; ++i) {
    const dvec3 corner = to.origin + static_cast<double>(i & 1 ? box.high.x : box.low.x) * to.axis[0] +
                         static_cast<double>(i & 2 ? box.high.y : box.low.y) * to.axis[1] +
                         static_cast<double>(i & 4 ? box.high.z : box.low.z) * to.axis[2];
    all_in_front = all_in_front && corner.z > 0;
    extent.add(corner, 0);
  }
  if (extent.behind) return {0, 0};
  if (!all_in_front) return {0, frame.height};
  const double half_width = 0.5 * frame.width + margin, half_height = 0.5 * frame.height + margin;
  if (extent.x_low > half_width || extent.x_high < -half_width) return {0, 0};
  if (extent.y_low > half_height || extent.y_high < -half_height) return {0, 0};
  const double low = std::max(half_height - extent.y_high - 1, 0.0);
  const double high = std::min(half_height - extent.y_low + 1, static_cast<double>(frame.height));
  return {static_cast<int>(low), static_cast<int>(std::ceil(high))};
}

}  // namespace

std::vector<VoxelFaceAt> faces_of(const VoxelGrid& grid) {
  std::vector<VoxelFaceAt> faces;
  for_each_voxel(grid.bounds(), [&](const ivec3& voxel) {
    if (!grid.solid(voxel)) return;
    for (int face = 0; face < 6; ++face) {
      ivec3 beyond = voxel;
      beyond[face / 2] += face % 2 ? 1 : -1;
      if (!grid.box().contains(beyond) || !grid.solid(beyond)) faces.push_back({voxel, static_cast<VoxelFace>(face)});
    }
  });
  return faces;
}

Ray PictureFrame::ray(int col, int row) const {
  const dvec2 p = place(col, row) * pixel;
  Ray ray;
  ray.origin = perspective ? eye : eye + p.x * right + p.y * up;
  ray.direction = perspective ? forward + p.x * right + p.y * up : forward;
  return ray;
}

PictureFrame frame_looking(const dvec3& eye, const dvec3& target, const dvec3& top, double fov, int width, int height) {
  PictureFrame frame = frame_along(eye, normalize(target - eye), top, 2 * std::tan(fov / 2), width, height);
  frame.perspective = true;
  return frame;
}

PictureFrame frame_along(const dvec3& eye, const dvec3& forward, const dvec3& top, double high, int width, int height) {
  const dvec3 right = normalize(cross(forward, top));
  return {eye, right, cross(right, forward), forward, false, high / height, width, height};
}

RasterPicture rasterise(const VoxelGrid& grid, std::span<const VoxelPlace> places, const PictureFrame& frame,
                        double margin) {
  for (const VoxelPlace& place : places) {
    if (place.world_from_grid != glm::dmat3(place.world_from_grid[0][0]))
      throw Error("rasterise: objects must not be turned");
  }
  const std::vector<VoxelFaceAt> faces = faces_of(grid);
  std::vector<Projection> to;
  std::vector<std::pair<int, int>> rows;
  for (const VoxelPlace& place : places) {
    to.push_back(projection(frame, place));
    rows.push_back(rows_of(frame, to.back(), grid.bounds(), margin));
  }
  RasterPicture picture;
  picture.seen.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  std::mutex mutex;
  parallel_for((frame.height + kStripRows - 1) / kStripRows, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const int row_begin = static_cast<int>(i) * kStripRows, row_end = std::min(row_begin + kStripRows, frame.height);
      Strip strip(frame, margin, row_begin, row_end, picture);
      for (std::size_t object = 0; object < places.size(); ++object) {
        if (rows[object].first >= row_end || rows[object].second <= row_begin) continue;
        strip.draw(places[object], static_cast<std::uint32_t>(object), to[object], faces);
      }
      const std::lock_guard lock(mutex);
      for (const NearEdge& near : strip.near_edges()) {
        if (near.least_t < picture.seen[near.pixel].t) picture.near_edges.push_back(near);
      }
    }
  });
  std::sort(picture.near_edges.begin(), picture.near_edges.end(),
            [](const NearEdge& a, const NearEdge& b) { return a.pixel < b.pixel; });
  for (const SeenFace& seen : picture.seen) picture.least_depth = std::min(picture.least_depth, seen.t);
  for (const NearEdge& near : picture.near_edges) picture.least_depth = std::min(picture.least_depth, near.least_t);
  return picture;
}

}  // namespace scarp::bench
