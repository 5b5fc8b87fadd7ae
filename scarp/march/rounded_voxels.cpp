// SPDX-License-Identifier: MIT
#include "scarp/march/rounded_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far a quantised ray may be from itself, in voxels (voxel_ray.h): what is told to be on the surface is that close.
const double kOffRay = std::ldexp(1, -17);

bool solid(const VoxelGrid& grid, const ivec3& voxel) { return grid.box().contains(voxel) && grid.solid(voxel); }

struct InnerBox {
  dvec3 low, high;
};

InnerBox inner_box(const VoxelGrid& grid, const ivec3& voxel, const VoxelRounding& rounding) {
  InnerBox box{dvec3(voxel), dvec3(voxel) + 1.0};
  for (int axis = 0; axis < 3; ++axis) {
    ivec3 below = voxel, above = voxel;
    --below[axis], ++above[axis];
    if (rounding.each || !solid(grid, below)) box.low[axis] += rounding.radius;
    if (rounding.each || !solid(grid, above)) box.high[axis] -= rounding.radius;
  }
  return box;
}

dvec3 from_inner_box(const InnerBox& box, const dvec3& p) { return p - glm::clamp(p, box.low, box.high); }

// The first t of [begin, end] at which the ray is no farther from the box than the radius.
std::optional<double> enter(const InnerBox& box, const VoxelRay& ray, double radius, double begin, double end) {
  std::array<double, 8> cuts{begin};
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0) continue;
    for (const double plane : {box.low[axis], box.high[axis]}) {
      const double t = (plane - ray.origin[axis]) / ray.direction[axis];
      if (t > begin && t < end) cuts[count++] = t;
    }
  }
  std::sort(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(count));
  cuts[count] = end;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 here = ray.origin + cuts[i] * ray.direction;
    const dvec3 away = from_inner_box(box, here);
    double c = dot(away, away) - radius * radius;
    if (c <= 0) return cuts[i];
    // In between the ray is outside in the same axes.
    const dvec3 middle = ray.origin + 0.5 * (cuts[i] + cuts[i + 1]) * ray.direction;
    double a = 0, b = 0;
    c = -radius * radius;
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

// Where a ray leaves a voxel, and into which neighbour.
struct Leaving {
  double t = kInfinity;
  int axis = 0;
};

Leaving leaving(const ivec3& voxel, const VoxelRay& ray) {
  Leaving out;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d == 0) continue;
    const double t = (voxel[axis] + (d > 0 ? 1 : 0) - ray.origin[axis]) / d;
    if (t < out.t) out = {t, axis};
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
        fmt::format("rounding of voxels: the radius is {}; it must be 0 to 0.5 sides of a voxel", rounding.radius));
  }
}

VoxelHit first_rounded_voxel(const VoxelTarget& target, VoxelMarch march, const VoxelRay& ray,
                             const VoxelDirection& direction, const VoxelRounding& rounding, const ivec3* from,
                             MarchStats* stats) {
  if (stats) *stats = {};
  VoxelRay rest = ray;
  std::optional<VoxelFace> came_by;  // into rest.start_voxel
  const auto go_on_from = [&](const ivec3& voxel) {
    const Leaving out = leaving(voxel, ray);
    const int step = ray.direction[out.axis] > 0 ? 1 : -1;
    rest.t_min = std::max(rest.t_min, out.t);
    rest.start_voxel = voxel;
    (*rest.start_voxel)[out.axis] += step;
    came_by = static_cast<VoxelFace>(2 * out.axis + (step < 0 ? 1 : 0));
  };
  if (from) go_on_from(*from);
  while (rest.t_min <= rest.t_max) {
    const auto quantised = quantise(rest, direction, target.box);
    if (!quantised) break;
    MarchStats part;
    VoxelHit hit = march(target, *quantised, stats ? &part : nullptr);
    if (stats) stats->steps += part.steps;
    if (!hit) break;
    if (hit.face == VoxelFace::inside && came_by) hit.face = *came_by;
    const InnerBox box = inner_box(*target.grid, hit.voxel, rounding);
    if (const auto t = enter(box, ray, rounding.radius, hit.t, std::max(hit.t, leaving(hit.voxel, ray).t))) {
      if (*t > ray.t_max) break;
      const bool later = *t > hit.t;
      hit.t = *t;
      const dvec3 away = from_inner_box(box, ray.origin + hit.t * ray.direction);
      if ((later || hit.face != VoxelFace::inside) && length(away) >= rounding.radius - kOffRay)
        hit.face = face_along(away);
      return hit;
    }
    rest.t_min = hit.t;
    go_on_from(hit.voxel);
  }
  return {};
}

dvec3 rounded_normal(const VoxelGrid& grid, const VoxelHit& hit, const dvec3& point, const VoxelRounding& rounding) {
  if (hit.face == VoxelFace::inside) return dvec3(0.0);
  const dvec3 away = from_inner_box(inner_box(grid, hit.voxel, rounding), point);
  // On the part of a face that a neighbour, rounded itself, leaves open.
  if (length(away) < rounding.radius - kOffRay) return dvec3(normal_of(hit.face));
  return normalize(away);
}

}  // namespace scarp
