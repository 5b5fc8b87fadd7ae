// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/rounded_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Maximum distance of a quantised ray from the original, in voxels (voxel_ray.h): reported surface points are that
// close.
const double kOffRay = std::ldexp(1, -17);

bool solid(const VoxelGrid& grid, const ivec3& voxel) { return grid.box().contains(voxel) && grid.solid(voxel); }

struct InnerBox {
  dvec3 low, high;
};

// Parts of a voxel's surface that are rounded off. Each eighth of the voxel, on the high side of the axes whose bits
// are set, has its own inner box.
class RoundedShape {
 public:
  RoundedShape(const VoxelGrid& grid, const ivec3& voxel, const VoxelRounding& rounding)
      : voxel_(voxel), radius_(rounding.radius) {
    std::array<std::array<bool, 2>, 3> open{};
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) open[axis][side] = rounding.each || !solid(grid, beyond(axis, side));
    }
    for (int eighth = 0; eighth < 8; ++eighth) {
      const auto side = [&](int axis) { return eighth >> axis & 1; };
      std::array<bool, 3> taken_off;
      for (int axis = 0; axis < 3; ++axis) taken_off[axis] = open[axis][side(axis)];
      // An edge that touches another voxel's stays sharp; otherwise rays would pass there.
      for (int axis = 0; axis < 3 && !rounding.each; ++axis) {
        const int next = (axis + 1) % 3;
        if (!open[axis][side(axis)] || !open[next][side(next)]) continue;
        ivec3 diagonal = beyond(axis, side(axis));
        diagonal[next] += side(next) ? 1 : -1;
        if (solid(grid, diagonal)) taken_off[axis] = taken_off[next] = false;
      }
      InnerBox& box = boxes_[eighth];
      box = {dvec3(voxel), dvec3(voxel) + 1.0};
      for (int axis = 0; axis < 3; ++axis) {
        if (!taken_off[axis]) continue;
        if (side(axis)) {
          box.high[axis] -= radius_;
        } else {
          box.low[axis] += radius_;
        }
      }
    }
  }

  double radius() const { return radius_; }
  double middle(int axis) const { return voxel_[axis] + 0.5; }
  const InnerBox& box_at(const dvec3& p) const {
    int eighth = 0;
    for (int axis = 0; axis < 3; ++axis) eighth |= p[axis] > middle(axis) ? 1 << axis : 0;
    return boxes_[eighth];
  }

 private:
  ivec3 beyond(int axis, int side) const {
    ivec3 neighbour = voxel_;
    neighbour[axis] += side ? 1 : -1;
    return neighbour;
  }

  ivec3 voxel_;
  double radius_;
  std::array<InnerBox, 8> boxes_;
};

dvec3 from_inner_box(const InnerBox& box, const dvec3& p) { return p - glm::clamp(p, box.low, box.high); }

// Returns the first t in [begin, end], within the voxel's cube, at which the ray is within the radius of the inner box.
std::optional<double> enter(const RoundedShape& shape, const VoxelRay& ray, double begin, double end) {
  const double square = shape.radius() * shape.radius();
  // Between the planes of the inner boxes and of the middle the ray is in one eighth, and outside along the same axes.
  std::array<double, 11> cuts{begin};
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0) continue;
    for (const double plane :
         {shape.middle(axis) - 0.5 + shape.radius(), shape.middle(axis), shape.middle(axis) + 0.5 - shape.radius()}) {
      const double t = (plane - ray.origin[axis]) / ray.direction[axis];
      if (t > begin && t < end) cuts[count++] = t;
    }
  }
  std::sort(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(count));
  cuts[count] = end;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 here = ray.origin + cuts[i] * ray.direction;
    const dvec3 middle = ray.origin + 0.5 * (cuts[i] + cuts[i + 1]) * ray.direction;
    const InnerBox& box = shape.box_at(middle);
    const dvec3 away = from_inner_box(box, here);
    if (dot(away, away) <= square) return cuts[i];
    double a = 0, b = 0, c = -square;
    for (int axis = 0; axis < 3; ++axis) {
      if (middle[axis] >= box.low[axis] && middle[axis] <= box.high[axis]) continue;
      const double from = here[axis] - (middle[axis] < box.low[axis] ? box.low[axis] : box.high[axis]);
      const double d = ray.direction[axis];
      a += d * d, b += from * d, c += from * from;
    }
    const double root = b * b - a * c;
    if (!(b < 0) || root < 0) continue;
    const double t = cuts[i] + std::max(0.0, c / (std::sqrt(root) - b));
    if (t <= cuts[i + 1]) return t;
  }
  return {};
}

// Exit of a ray from a voxel, and the neighbour that it enters.
struct Leaving {
  double t = kInfinity;
  int axis = 0;
};

Leaving leaving(const ivec3& voxel, const VoxelRay& ray, VoxelTies ties = {}) {
  Leaving out;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d == 0) continue;
    const double t = (voxel[axis] + (d > 0 ? 1 : 0) - ray.origin[axis]) / d;
    if (t < out.t || (t == out.t && t < kInfinity && ties.before(axis, out.axis))) out = {t, axis};
  }
  return out;
}

VoxelFace face_along(const dvec3& normal) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) axis = std::abs(normal[i]) > std::abs(normal[axis]) ? i : axis;
  return static_cast<VoxelFace>(2 * axis + (normal[axis] > 0 ? 1 : 0));
}

}  // namespace

void validate(const VoxelRounding& rounding) {
  if (!(rounding.radius >= 0 && rounding.radius <= 0.5)) {
    throw Error(
        fmt::format("rounding of voxels: the radius is {} (must be 0 to 0.5 sides of a voxel)", rounding.radius));
  }
}

VoxelHit first_rounded_voxel(const VoxelTarget& target, VoxelMarch march, const VoxelRay& ray,
                             const VoxelDirection& direction, const VoxelRounding& rounding, const ivec3* from,
                             MarchStats* stats, const VoxelFilter* accept) {
  if (stats) *stats = {};
  VoxelRay rest = ray;
  std::optional<VoxelFace> came_by;  // face into rest.start_voxel
  const auto go_on_from = [&](const ivec3& voxel) {
    const Leaving out = leaving(voxel, ray, direction.quantised.ties);
    const int step = ray.direction[out.axis] > 0 ? 1 : -1;
    rest.t_min = std::max(rest.t_min, out.t);
    rest.start_voxel = voxel;
    (*rest.start_voxel)[out.axis] += step;
    came_by = static_cast<VoxelFace>(2 * out.axis + (step < 0 ? 1 : 0));
  };
  if (from) go_on_from(*from);
  while (rest.t_min <= rest.t_max) {
    QuantisedRay quantised;
    if (!quantise(rest, direction, target.box, quantised)) break;
    MarchStats part;
    VoxelHit hit = march(target, quantised, stats ? &part : nullptr);
    if (stats) stats->steps += part.steps;
    if (!hit) break;
    if (hit.face == VoxelFace::inside && came_by) hit.face = *came_by;
    const RoundedShape shape(*target.grid, hit.voxel, rounding);
    if (const auto t = enter(shape, ray, hit.t, std::max(hit.t, leaving(hit.voxel, ray).t))) {
      if (*t > ray.t_max) break;
      const bool later = *t > hit.t;
      hit.t = *t;
      const dvec3 p = ray.origin + hit.t * ray.direction, away = from_inner_box(shape.box_at(p), p);
      if ((later || hit.face != VoxelFace::inside) && length(away) >= rounding.radius - kOffRay)
        hit.face = face_along(away);
      if (!accept || (*accept)(hit)) return hit;
    }
    rest.t_min = hit.t;
    go_on_from(hit.voxel);
  }
  return {};
}

dvec3 rounded_normal(const VoxelGrid& grid, const ivec3& voxel, VoxelFace face, const dvec3& point,
                     const VoxelRounding& rounding) {
  if (face == VoxelFace::inside) return dvec3(0.0);
  const dvec3 away = from_inner_box(RoundedShape(grid, voxel, rounding).box_at(point), point);
  // On the part of a face that a rounded neighbour leaves open.
  if (length(away) < rounding.radius - kOffRay) return dvec3(normal_of(face));
  return normalize(away);
}

}  // namespace scarp
