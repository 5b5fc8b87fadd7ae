// SPDX-License-Identifier: MIT
#include "march/voxel/spiteful_voxels.h"

#include <cmath>

namespace scarp::test {
namespace {

ivec3 random_size(Random& random, int most) {
  return {whole(random, 1, most), whole(random, 1, most), whole(random, 1, most)};
}

ivec3 random_voxel(const ivec3& size, Random& random) {
  return {whole(random, 0, size.x - 1), whole(random, 0, size.y - 1), whole(random, 0, size.z - 1)};
}

VoxelGrid made(const ivec3& size, const std::function<bool(const ivec3&)>& solid) {
  VoxelGrid grid(size, 8);
  grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    return solid(v) ? VoxelGrid::Voxel((v.x * 7 + v.y * 31 + v.z * 101) % 255 + 1) : VoxelGrid::Voxel();
  });
  return grid;
}

VoxelGrid scattered(const ivec3& size, double share, Random& random) {
  return made(size, [&](const ivec3&) { return uniform(random, 0, 1) < share; });
}

dvec3 inside(const VoxelGrid& grid, Random& random) {
  const ivec3& size = grid.size();
  return {uniform(random, 0, size.x), uniform(random, 0, size.y), uniform(random, 0, size.z)};
}

dvec3 lattice_point(const VoxelGrid& grid, Random& random) {
  const ivec3& size = grid.size();
  return {static_cast<double>(whole(random, 0, size.x)), static_cast<double>(whole(random, 0, size.y)),
          static_cast<double>(whole(random, 0, size.z))};
}

dvec3 any_direction(Random& random) {
  for (;;) {
    const dvec3 d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    if (dot(d, d) > 1e-3 && dot(d, d) < 1) return d;
  }
}

// Small integers, so that planes are crossed at once.
dvec3 lattice_direction(Random& random) {
  for (;;) {
    const dvec3 d(whole(random, -2, 2), whole(random, -2, 2), whole(random, -2, 2));
    if (d != dvec3(0.0)) return d;
  }
}

VoxelRay through(const dvec3& point, const dvec3& direction, double before) {
  VoxelRay ray;
  ray.origin = point - before * direction;
  ray.direction = direction;
  return ray;
}

}  // namespace

const std::vector<VoxelGridKind>& spiteful_voxel_grids() {
  static const std::vector<VoxelGridKind> kinds = {
      {"sparse", [](Random& r) { return scattered(random_size(r, 24), 0.02, r); }},
      {"half", [](Random& r) { return scattered(random_size(r, 12), 0.5, r); }},
      {"dense", [](Random& r) { return scattered(random_size(r, 9), 0.9, r); }},
      {"empty or full",
       [](Random& r) {
         const bool full = whole(r, 0, 1) == 1;
         return made(random_size(r, 9), [&](const ivec3&) { return full; });
       }},
      {"one voxel",
       [](Random& r) {
         const ivec3 size = random_size(r, 40), at = random_voxel(size, r);
         return made(size, [&](const ivec3& v) { return v == at; });
       }},
      {"ball",
       [](Random& r) {
         VoxelGrid grid(random_size(r, 21), 8);
         grid.fill_sphere(dvec3(grid.size()) * 0.5,
                          0.47 * std::cbrt(static_cast<double>(grid.size().x) * grid.size().y * grid.size().z), 7);
         return grid;
       }},
      {"diagonal wall",
       [](Random& r) {
         const int at = whole(r, 2, 30);
         return made(random_size(r, 16), [&](const ivec3& v) { return v.x + v.y + v.z == at; });
       }},
      {"room",
       [](Random& r) {
         const ivec3 size = random_size(r, 14) + 2;
         return made(size, [&](const ivec3& v) {
           return glm::any(glm::equal(v, ivec3(0))) || glm::any(glm::equal(v, size - 1));
         });
       }},
      {"sticks", [](Random& r) {
         const int every = whole(r, 2, 7);
         return made(random_size(r, 24),
                     [&](const ivec3& v) { return (v.x % every == 0) + (v.y % every == 0) + (v.z % every == 0) == 2; });
       }}};
  return kinds;
}

const std::vector<VoxelRayKind>& spiteful_voxel_rays() {
  static const std::vector<VoxelRayKind> kinds = {
      {"anyhow",
       [](const VoxelGrid& g, Random& r) { return through(inside(g, r), any_direction(r), uniform(r, 0, 60)); }},
      {"along an axis",
       [](const VoxelGrid& g, Random& r) {
         dvec3 d(0.0);
         d[whole(r, 0, 2)] = whole(r, 0, 1) == 1 ? 1.5 : -0.25;
         const dvec3 p = whole(r, 0, 2) == 0 ? lattice_point(g, r) : inside(g, r);
         return through(p, d, whole(r, 0, 1) * 100);
       }},
      {"along a diagonal",
       [](const VoxelGrid& g, Random& r) {
         return through(lattice_point(g, r), lattice_direction(r), whole(r, 0, 40));
       }},
      {"in a plane between voxels",
       [](const VoxelGrid& g, Random& r) {
         dvec3 d = any_direction(r), p = inside(g, r);
         const int axis = whole(r, 0, 2);
         d[axis] = 0;
         p[axis] = std::round(p[axis]);
         return through(p, d, uniform(r, 0, 50));
       }},
      {"through a corner",
       [](const VoxelGrid& g, Random& r) { return through(lattice_point(g, r), any_direction(r), uniform(r, 0, 50)); }},
      {"from a face",
       [](const VoxelGrid& g, Random& r) {
         VoxelRay ray = through(inside(g, r), any_direction(r), 0);
         const int axis = whole(r, 0, 2);
         ray.origin[axis] = std::round(ray.origin[axis]);
         return ray;
       }},
      {"from a corner",
       [](const VoxelGrid& g, Random& r) {
         return through(lattice_point(g, r), whole(r, 0, 1) == 1 ? any_direction(r) : lattice_direction(r), 0);
       }},
      {"from inside",
       [](const VoxelGrid& g, Random& r) {
         VoxelRay ray = through(inside(g, r), any_direction(r), 0);
         ray.t_max = uniform(r, 0, 20);
         return ray;
       }},
      {"from far away",
       [](const VoxelGrid& g, Random& r) { return through(inside(g, r), normalize(any_direction(r)), 1e7); }},
      // Down to lengths whose inverse overflows.
      {"of any length",
       [](const VoxelGrid& g, Random& r) {
         VoxelRay ray = through(inside(g, r), any_direction(r), uniform(r, 0, 50));
         if (whole(r, 0, 1) == 0) ray.direction[whole(r, 0, 2)] = 0;
         ray.direction *= std::ldexp(1.0, whole(r, -1070, 1000));
         return ray;
       }},
      {"nearly along a plane",
       [](const VoxelGrid& g, Random& r) {
         dvec3 d = any_direction(r), p = lattice_point(g, r);
         const int axis = whole(r, 0, 2);
         d[axis] = std::ldexp(uniform(r, -1, 1), -whole(r, 20, 45));
         p[axis] += std::ldexp(uniform(r, -1, 1), -whole(r, 15, 45));
         return through(p, d, uniform(r, 0, 50));
       }},
      {"from a neighbour",
       [](const VoxelGrid& g, Random& r) {
         VoxelRay ray = through(inside(g, r), any_direction(r), 0);
         const int axis = whole(r, 0, 2);
         ray.origin[axis] = std::round(ray.origin[axis]);
         ivec3 voxel;
         for (int i = 0; i < 3; ++i) voxel[i] = static_cast<int>(std::floor(ray.origin[i]));
         if (ray.direction[axis] < 0) --voxel[axis];
         ray.start_voxel = voxel;
         return ray;
       }},
      {"of a range", [](const VoxelGrid& g, Random& r) {
         VoxelRay ray = through(inside(g, r), any_direction(r) * std::ldexp(1.0, whole(r, -20, 20)), 0);
         ray.t_min = uniform(r, -50, 20) / length(ray.direction);
         ray.t_max = ray.t_min + uniform(r, 0, 40) / length(ray.direction);
         return ray;
       }}};
  return kinds;
}

glm::dmat3 random_orientation(Random& random) {
  glm::dmat3 turn(1.0);
  if (random() % 2) return turn;
  for (int k = 2; k > 0; --k) std::swap(turn[k], turn[static_cast<int>(random() % static_cast<std::uint64_t>(k + 1))]);
  for (int k = 0; k < 3; ++k) {
    if (random() % 2) turn[k] = -turn[k];
  }
  return turn;
}

VoxelBox random_edit(VoxelGrid& grid, Random& random) {
  const ivec3 a = random_voxel(grid.size() + 4, random) - 2, b = a + random_size(random, 6);
  const dvec3 centre = inside(grid, random);
  const double radius = uniform(random, 0, 5);
  const auto entry = static_cast<std::uint32_t>(whole(random, 1, 255));
  switch (whole(random, 0, 7)) {
    case 0:
      return grid.fill({a, b}, entry);
    case 1:
      return grid.clear(VoxelBox{a, b});
    case 2:
      return grid.fill_sphere(centre, radius, entry);
    case 3:
      return grid.clear_sphere(centre, radius);
    case 4:
      return grid.paint({a, b}, entry);
    case 5:
      return grid.paint_sphere(centre, radius, entry);
    case 6:
      return grid.set(a, entry);
    default:
      return grid.clear(a);
  }
}

}  // namespace scarp::test
