// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/kept_memory.h"
#include "scarp/march/closest_of.h"

namespace scarp {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// A cube of blocks or voxels that may contain the result.
struct Block {
  double bound;
  ivec3 low;
  int side;
};

// Best-first search over the blocks with solid voxels: bound(low, high) is the best possible result in a box,
// solid(voxel) examines a solid voxel, best() is the best result so far.
template <class Bound, class Solid, class Best>
void search(const VoxelGrid& grid, const Bound& bound, const Solid& solid, const Best& best) {
  const VoxelBox& within = grid.bounds();
  if (within.empty()) return;
  int side = VoxelGrid::kBrick;
  while (side < std::max({grid.size().x, grid.size().y, grid.size().z})) side *= 2;
  const auto later = [](const Block& a, const Block& b) { return a.bound > b.bound; };
  KeptVector<Block> blocks;  // a heap, the smallest bound on top
  blocks.push_back({0, ivec3(0), side});
  while (!blocks.empty()) {
    std::pop_heap(blocks.begin(), blocks.end(), later);
    const Block block = blocks.back();
    blocks.pop_back();
    if (!(block.bound < best())) break;
    if (block.side == 1) {
      solid(block.low, block.bound);
      continue;
    }
    if (block.side == VoxelGrid::kBrick && grid.mask(block.low / VoxelGrid::kBrick) == 0) continue;
    const int half = block.side / 2;
    for (int i = 0; i < 8; ++i) {
      const ivec3 low = block.low + half * ivec3(i & 1, i >> 1 & 1, i >> 2);
      const ivec3 from = max(low, within.low), to = min(low + half, within.high);
      if (from.x >= to.x || from.y >= to.y || from.z >= to.z) continue;
      if (half == 1 && !grid.solid(low)) continue;
      const double least = bound(dvec3(from), dvec3(to));
      if (!(least < best())) continue;
      blocks.push_back({least, low, half});
      std::push_heap(blocks.begin(), blocks.end(), later);
    }
  }
}

bool is_solid(const VoxelGrid& grid, const ivec3& voxel) { return grid.box().contains(voxel) && grid.solid(voxel); }

std::optional<VoxelContact> starts_inside(const VoxelGrid& grid, const Capsule& capsule) {
  const dvec3 size(grid.size());
  for (const dvec3& end : {capsule.a, capsule.b}) {
    // Compared as doubles: too far away for integers.
    if (!(end.x >= 0 && end.y >= 0 && end.z >= 0 && end.x < size.x && end.y < size.y && end.z < size.z)) continue;
    const ivec3 voxel(floor(end));
    if (grid.solid(voxel)) return VoxelContact{{0, end, dvec3(0.0)}, voxel};
  }
  return {};
}

}  // namespace

std::optional<VoxelContact> sweep(const VoxelGrid& grid, const Capsule& capsule, const dvec3& motion) {
  validate(capsule, motion);
  if (const auto inside = starts_inside(grid, capsule)) return inside;
  double best = kNever;
  Triangle touched{};
  ivec3 touched_voxel(-1);
  const auto reach = [&] { return std::min(best, 1.0); };
  // Calls visit(triangle) for the triangles of the faces that are not between solid voxels; `towards`: only those that
  // the motion approaches.
  const auto faces = [&](const ivec3& voxel, bool towards, const auto& visit) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        ivec3 beside = voxel;
        beside[axis] += side ? 1 : -1;
        if (is_solid(grid, beside) || (towards && (side ? motion[axis] >= 0 : motion[axis] <= 0))) continue;
        dvec3 corner(voxel), u(0.0), v(0.0);
        corner[axis] += side;
        u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = 1;
        visit(Triangle{corner, corner + u, corner + v});
        visit(Triangle{corner + u + v, corner + v, corner + u});
      }
    }
  };
  const auto bound = [&](const dvec3& low, const dvec3& high) {
    return sweep_bound(capsule, motion, low, high, reach());
  };
  const auto solid = [&](const ivec3& voxel, double least) {
    // Faces that the motion does not approach are touched at its start, or after others.
    faces(voxel, least > 0, [&](const Triangle& triangle) {
      const auto t = sweep_time(capsule, motion, triangle, reach());
      if (t && *t < best) best = *t, touched = triangle, touched_voxel = voxel;
    });
  };
  search(grid, bound, solid, [&] { return best; });
  if (best == kNever) return {};
  if (best == 0) {
    // The closest face, for the depth.
    double nearest = std::nextafter(capsule.radius, kNever);
    const dvec3 first = min(capsule.a, capsule.b), last = max(capsule.a, capsule.b);
    search(
        grid,
        [&](const dvec3& low, const dvec3& high) { return length(max(max(low - last, first - high), dvec3(0.0))); },
        [&](const ivec3& voxel, double) {
          faces(voxel, false, [&](const Triangle& triangle) {
            const double distance =
                std::sqrt(closest_of_segment_and_triangle(capsule.a, capsule.b - capsule.a, triangle).square());
            if (distance < nearest) nearest = distance, touched = triangle, touched_voxel = voxel;
          });
        },
        [&] { return nearest; });
  }
  return VoxelContact{contact_at(capsule, motion, touched, best), touched_voxel};
}

std::optional<VoxelPoint> closest_point(const VoxelGrid& grid, const dvec3& p, double max_distance) {
  if (!(max_distance >= 0)) return {};
  VoxelPoint best;
  best.distance = std::nextafter(max_distance, kNever);
  const auto closest = [&](const dvec3& low, const dvec3& high) { return min(max(p, low), high); };
  const auto bound = [&](const dvec3& low, const dvec3& high) { return length(closest(low, high) - p); };
  const auto solid = [&](const ivec3& voxel, double distance) {
    const dvec3 q = closest(dvec3(voxel), dvec3(voxel) + 1.0);
    best = {q, distance > 0 ? (p - q) / distance : dvec3(0.0), distance, voxel};
  };
  search(grid, bound, solid, [&] { return best.distance; });
  if (best.voxel == ivec3(-1)) return {};
  return best;
}

bool overlaps(const VoxelGrid& grid, const TurnedBox& box) {
  bool found = false;
  const auto bound = [&](const dvec3& low, const dvec3& high) { return overlaps(box, low, high) ? 0 : kNever; };
  // Its bound was that of the voxel.
  const auto solid = [&](const ivec3&, double) { found = true; };
  search(grid, bound, solid, [&] { return found ? 0 : kNever; });
  return found;
}

}  // namespace scarp
