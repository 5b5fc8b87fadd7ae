// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_ray.h"

#include <algorithm>
#include <cmath>

namespace scarp {
namespace {

VoxelFace face_of(int axis, int step) { return static_cast<VoxelFace>(2 * axis + (step < 0 ? 1 : 0)); }

// The voxel of a position along one axis. Positions are not negative, so conversion rounds down.
int voxel_at(double place, int step) {
  const int voxel = static_cast<int>(place);
  return step < 0 && voxel == place ? voxel - 1 : voxel;
}

// Calls to library functions would make the loops of quantise() save all their numbers around them.

std::int64_t rounded_up(double units) {
  const auto down = static_cast<std::int64_t>(units);
  return down + (static_cast<double>(down) < units ? 1 : 0);
}

// The origin of a level ray: the adjacent plane. Others are not in the box. At `border`, the side of the box that takes
// rays along it, twice as far: the box in front may already have given up a ray that its own rounding puts nearer.
constexpr double kFarthest = 1 << 20;  // beyond all boxes
double on_plane(double origin, double room, int border) {
  if (!(origin > -1 && origin < kFarthest)) return origin;
  const double plane = static_cast<int>(origin + 1.5) - 1;
  return std::abs(origin - plane) <= (plane == border ? 2 * room : room) ? plane : origin;
}

}  // namespace

ivec3 normal_of(VoxelFace face) {
  ivec3 normal(0);
  if (face == VoxelFace::inside) return normal;
  const int index = static_cast<int>(face);
  normal[index / 2] = index % 2 == 0 ? -1 : 1;
  return normal;
}

// Objects on one lattice share planes, with equal or opposite normals. The sign of a normal's component along a fixed
// vector distinguishes the two directions, its magnitude the three normals: for world axes these are the signs and the
// order of x, y, z. 1 and the roots are linearly independent over the integers, so no normal with rational slopes is
// perpendicular to the vector.
VoxelTies::VoxelTies(const glm::dmat3& grid_from_world, VoxelTies frame) {
  static const std::array<double, 3> by_rank{1.0, std::cbrt(0.5), std::cbrt(0.25)};
  dvec3 upwards{0.0};
  for (int axis = 0; axis < 3; ++axis)
    upwards[axis] = frame.up(axis) * by_rank[static_cast<std::size_t>(frame.rank(axis))];
  const dvec3 parts = grid_from_world * upwards;
  for (int axis = 0; axis < 3; ++axis) bits |= parts[axis] < 0 ? 1u << axis : 0;
  for (int a = 1; a < 3; ++a) {
    for (int b = 0; b < a; ++b) bits |= std::abs(parts[a]) > std::abs(parts[b]) ? 1u << (a + b + 2) : 0;
  }
}

VoxelDirection::VoxelDirection(const dvec3& direction, VoxelTies ties) : given(direction), inverse(1.0 / direction) {
  // Divisions dominate the cost here; the one by the longest component is already done.
  const double per_longest = std::min({std::abs(inverse.x), std::abs(inverse.y), std::abs(inverse.z)});
  auto& [speed, slowness, step, own_ties, after, exact, plain, t_per_s] = quantised;
  own_ties = ties;
  const std::uint32_t y_x = ties.bits >> 3 & 1, z_x = ties.bits >> 4 & 1, z_y = ties.bits >> 5 & 1;
  after = {static_cast<std::uint8_t>(6 ^ (y_x << 1 | z_x << 2)), static_cast<std::uint8_t>(4 ^ (y_x | z_y << 2)),
           static_cast<std::uint8_t>(z_x | z_y << 1)};
  exact = true;
  for (int axis = 0; axis < 3; ++axis) {
    // Not finite for a direction that is too short.
    const double share = std::abs(direction[axis]) * per_longest;
    const double units = share <= 1 ? share * (1 << kDirectionBits) : 0;
    speed[axis] = static_cast<std::int64_t>(units < kSlow ? units : units + 0.5);
    const bool power = static_cast<double>(speed[axis]) == units && (speed[axis] & (speed[axis] - 1)) == 0;
    exact = exact && ((power && speed[axis] >= kSlow) || direction[axis] == 0);
    slowness[axis] = 1 / static_cast<double>(speed[axis]);
    step[axis] = direction[axis] == 0 ? ties.up(axis) : direction[axis] < 0 ? -1 : 1;
  }
  t_per_s = static_cast<double>(1 << (kDirectionBits - kPlaceBits)) * per_longest;
  plain = speed[0] >= kSlow && speed[1] >= kSlow && speed[2] >= kSlow && std::isfinite(t_per_s);
}

namespace {

// Whether the path is exact: neither the direction nor the start of the ray needs rounding.
bool is_exact(const VoxelRay& ray, const VoxelDirection& direction) {
  if (!direction.quantised.exact) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction.given[axis] == 0) continue;
    const double parts = (ray.origin[axis] + ray.t_min * direction.given[axis]) * kExactStart;
    if (!(std::abs(parts) < 0x1p52) || static_cast<double>(static_cast<std::int64_t>(parts)) != parts) return false;
  }
  return true;
}

// kPlain: for a plain direction and no start voxel, which nearly all rays have. Without tests for the others, a ray
// through many objects takes 3 to 6 % less time.
template <bool kPlain>
bool quantise_as(const VoxelRay& ray, const VoxelDirection& ray_direction, const VoxelBox& box,
                 QuantisedRay& quantised) {
  const QuantisedDirection& direction = ray_direction.quantised;
  if (!kPlain && !std::isfinite(direction.t_per_s)) return false;
  const bool has_start = !kPlain && ray.start_voxel;
  const VoxelTies ties = direction.ties;
  const double late = std::max(ray.room, kTouch * 0x1p-20);
  // Clips to the box. If planes are crossed at the same t, the last one is the entry face.
  double t = ray.t_min, t_out = ray.t_max;
  int entered = -1;
  dvec3 from = ray.origin;
  for (int axis = 0; axis < 3; ++axis) {
    double& origin = from[axis];
    const int low = box.low[axis], high = box.high[axis], step = direction.step[axis];
    if (!kPlain && ray_direction.given[axis] == 0) {
      origin = on_plane(origin, ray.room, step > 0 ? low : high);
      if (!(step > 0 ? origin >= low && origin < high : origin > low && origin <= high)) return false;
      continue;
    }
    const bool slow = !kPlain && direction.speed[axis] < kSlow;
    const double early = slow ? ray.room : 0;
    const double t_near = ((step > 0 ? low - early : high + early) - origin) * ray_direction.inverse[axis];
    const double t_far = ((step > 0 ? high + late : low - late) - origin) * ray_direction.inverse[axis];
    bool outside = false;
    if (has_start) {
      const int start = (*ray.start_voxel)[axis];
      if (step > 0 ? start >= high : start < low) return false;
      outside = step > 0 ? start < low : start >= high;
    }
    if (outside || t_near >= t) {
      if (t_near > t || entered < 0 || ties.before(entered, axis)) entered = axis;
      t = std::max(t, t_near);
    }
    t_out = std::min(t_out, t_far);
  }
  if (!(t <= t_out)) return false;
  const bool starts_inside = has_start && entered < 0;
  if (starts_inside && !box.contains(*ray.start_voxel)) return false;

  quantised.direction = direction;
  quantised.face = entered >= 0 ? face_of(entered, direction.step[entered]) : VoxelFace::inside;
  quantised.t = t;
  quantised.t_max = ray.t_max;
  const bool comes_in = t > ray.t_min;  // on its path, not where it starts
  for (int axis = 0; axis < 3; ++axis) {
    const int low = box.low[axis], high = box.high[axis], step = direction.step[axis];
    // Not beyond the box, where only rounding could place it.
    double place = from[axis] + t * ray_direction.given[axis];
    place = place > low ? place : low;
    place = place < high ? place : high;
    int voxel;
    if (axis == entered) {
      place = step > 0 ? low : high;
      voxel = step > 0 ? low : high - 1;
    } else if (starts_inside) {
      voxel = (*ray.start_voxel)[axis];
    } else {
      voxel = voxel_at(place, step);
    }
    const double distance = step > 0 ? voxel + 1 - place : place - voxel, units = distance * kVoxelPlaces;
    const bool slow = !kPlain && direction.speed[axis] < kSlow;
    std::int64_t next =
        std::clamp<std::int64_t>(slow ? rounded_up(units) : static_cast<std::int64_t>(units + 0.5), 0, kVoxelPlaces);
    bool never = slow && direction.speed[axis] == 0;
    // Planes behind that are not crossed yet.
    const bool moves = kPlain || ray_direction.given[axis] != 0;
    if (comes_in && next >= kVoxelPlaces - kTouch && moves && axis != entered && voxel != (step > 0 ? low : high - 1) &&
        (distance != 1 || ties.before(entered, axis) || !is_exact(ray, ray_direction))) {
      voxel -= step;
      next = 0;
      if (never) {
        // The ray crosses this plane at once, and never another one.
        quantised.direction.speed[axis] = 1;
        quantised.direction.slowness[axis] = 1;
        never = false;
      }
    }
    // A plane by which the ray leaves the box at once is crossed after others at the same position.
    if (next == 0 && comes_in && !slow && voxel == (step > 0 ? high - 1 : low) && !is_exact(ray, ray_direction))
      next = 1;
    // On the border and leaving.
    if (voxel < low || voxel >= high) return false;
    quantised.voxel[axis] = voxel;
    quantised.to_plane[axis] = never ? QuantisedRay::kNever : next;
  }
  return true;
}

}  // namespace

bool quantise(const VoxelRay& ray, const VoxelDirection& direction, const VoxelBox& box, QuantisedRay& quantised) {
  const bool plain = direction.quantised.plain && !ray.start_voxel;
  return plain ? quantise_as<true>(ray, direction, box, quantised) : quantise_as<false>(ray, direction, box, quantised);
}

std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelDirection& direction, const VoxelBox& box) {
  QuantisedRay quantised;
  if (!quantise(ray, direction, box, quantised)) return {};
  return quantised;
}

std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelBox& box) {
  if (box.empty()) return {};
  return quantise(ray, VoxelDirection(ray.direction), box);
}

}  // namespace scarp
