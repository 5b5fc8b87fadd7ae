// SPDX-License-Identifier: MIT
// Judges scenes of turned voxel objects: all of them are written into one grid, and a ray is followed through it in
// integers. Shares no code and no rounding with the marches.
//
//   scene   objects in all 48 orientations at whole places, touching and overlapping
//   grid    cell (x, y, z) of the lattice -> solid or not
//   ray     origin in halves of a voxel, direction of whole numbers, ends in whole multiples of it
//
// The rule, in the directions of the lattice: planes crossed at once are crossed in the order x, y, z; a ray along a
// plane belongs to the upper side, and a ray that starts on a plane to the cell that it enters.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bench/random.h"
#include "scarp/scene/placed_voxels.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {

/// A ray in halves of a voxel from the lattice's corner.
struct LatticeRay {
  std::array<std::int64_t, 3> origin{};     ///< halves of a voxel
  std::array<std::int64_t, 3> direction{};  ///< halves of a voxel per t
  std::int64_t t_max = 0;
  /// The components are powers of two or 0, so quantisation is exact. All other rays are exact unless they pass an
  /// edge.
  bool exact = false;
};

/// The first solid cell, or all that are entered at the same t.
struct LatticeAnswer {
  std::int64_t t_num = 0, t_den = 1;  ///< t = t_num / t_den
  std::vector<std::array<int, 3>> cells;
  bool decided = true;  ///< false: an inexact ray passes an edge, where its quantised ray may take either side

  bool hit() const { return !cells.empty(); }
};

class VoxelSceneJudge {
 public:
  static constexpr int kSide = 20;  // of the lattice

  /// A random scene. `march` of all models; empty: any.
  VoxelSceneJudge(Random& random, std::string_view march)
      : solid_(static_cast<std::size_t>(kSide * kSide * kSide)),
        side_(random.below(3) == 0 ? 0.25 : 1),
        corner_(random.below(9) - 4, random.below(9) - 4, random.below(9) - 4) {
    const int objects = 2 + random.below(23), models = 1 + random.below(4);
    const bool tiles = random.below(3) == 0;  // of one size, side by side
    const ivec3 tile(1 + random.below(5), 1 + random.below(5), 1 + random.below(5));
    constexpr std::array<double, 3> kShares = {1, 0.6, 0.15};
    std::vector<VoxelGrid> grids;
    for (int m = 0; m < models; ++m) {
      const double share = kShares[static_cast<std::size_t>(random.below(3))];
      // Cubes fit in any orientation.
      grids.emplace_back(tiles ? ivec3(tile.x) : ivec3(1 + random.below(6), 1 + random.below(6), 1 + random.below(6)),
                         8);
      grids.back().edit(grids.back().box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
        return random.uniform() < share ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
      });
      const auto entries = voxel_marches();
      const VoxelMarchEntry& entry =
          march.empty() ? entries[static_cast<std::size_t>(random.below(static_cast<int>(entries.size())))]
                        : find_voxel_march(march);
      placed_.models.push_back(std::make_shared<const VoxelModel>(grids.back(), entry));
    }
    for (int i = 0; i < objects; ++i) {
      const int model = random.below(models);
      const ivec3 size = grids[static_cast<std::size_t>(model)].size();
      // A signed permutation, as columns.
      std::array<int, 3> axis{0, 1, 2}, sign{1, 1, 1};
      for (int k = 2; k > 0; --k)
        std::swap(axis[static_cast<std::size_t>(k)], axis[static_cast<std::size_t>(random.below(k + 1))]);
      if (random.below(8) == 0) axis = {0, 1, 2};
      for (int& s : sign) s = random.below(2) ? 1 : -1;
      // Its box on the lattice starts at `low`.
      ivec3 low(0), shift(0);
      glm::dmat3 turn(0.0);
      for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const int to = axis[at], length = size[k];
        low[to] = tiles ? random.below(kSide / tile.x) * tile.x : random.below(kSide - length + 1);
        turn[k][to] = sign[at] * side_;
        if (sign[at] < 0) shift[to] = length;
      }
      placed_.places.push_back({static_cast<std::uint32_t>(model), turn, side_ * dvec3(corner_ + low + shift)});
      for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y) {
          for (int x = 0; x < size.x; ++x) {
            if (grids[static_cast<std::size_t>(model)].solid({x, y, z})) mark(cell_of(i, {x, y, z}));
          }
        }
      }
    }
  }

  const PlacedVoxels& placed() const { return placed_; }

  /// The same objects as separate fields, rotated by their placements; mirrored ones are mirrored in their fields.
  Scene as_fields() const {
    std::vector<SceneFieldPtr> fields;
    std::vector<SceneObject> objects;
    for (const VoxelPlace& place : placed_.places) {
      const glm::dmat3 mirror(dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1));
      const glm::dmat3 turn = place.world_from_grid / side_;
      const bool mirrored = dot(cross(turn[0], turn[1]), turn[2]) < 0;
      PlacedVoxels own;
      own.models = {placed_.models[place.model]};
      own.places = {{0, side_ * (mirrored ? mirror : glm::dmat3(1.0)), dvec3(0.0)}};
      SceneObject object;
      object.field = static_cast<std::uint32_t>(fields.size());
      object.placement.turn = mirrored ? turn * mirror : turn;
      object.placement.origin = place.origin;
      fields.push_back(scene_voxels(own));
      objects.push_back(object);
    }
    return {fields, objects};
  }

  /// The cell of the lattice that a voxel of an object fills.
  std::array<int, 3> cell_of(int object, const ivec3& voxel) const {
    const VoxelPlace& place = placed_.places[static_cast<std::size_t>(object)];
    std::array<int, 3> cell{};
    for (int to = 0; to < 3; ++to) {
      int at = static_cast<int>(place.origin[to] / side_) - corner_[to];
      for (int k = 0; k < 3; ++k) {
        if (place.world_from_grid[k][to] > 0) at += voxel[k];
        if (place.world_from_grid[k][to] < 0) at -= voxel[k] + 1;
      }
      cell[static_cast<std::size_t>(to)] = at;
    }
    return cell;
  }

  /// Rays along edges and planes, through edges and corners, and any others.
  static LatticeRay random_ray(Random& random) {
    LatticeRay ray;
    const int kind = random.below(4);
    constexpr std::array<int, 8> kPowers = {-4, -2, -1, 0, 0, 1, 2, 4};
    ray.exact = kind < 3;
    for (std::size_t i = 0; i < 3; ++i) {
      ray.origin[i] = random.below(2 * kSide + 5) - 2;
      ray.direction[i] = kind == 3 ? random.below(19) - 9 : kPowers[static_cast<std::size_t>(random.below(8))];
      if (kind == 0 && random.below(2)) ray.direction[i] = 0;
    }
    if (ray.direction == std::array<std::int64_t, 3>{})
      ray.direction[static_cast<std::size_t>(random.below(3))] = random.below(2) ? 1 : -1;
    // Outside of the scene, or in it.
    if (random.below(2)) {
      const std::int64_t back = random.below(64);
      for (std::size_t i = 0; i < 3; ++i) ray.origin[i] -= back * ray.direction[i];
    }
    ray.t_max = random.below(3) ? 1000 : random.below(40);
    return ray;
  }

  Ray world_ray(const LatticeRay& ray) const {
    Ray world;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      world.origin[i] = side_ * (0.5 * static_cast<double>(ray.origin[at]) + corner_[i]);
      world.direction[i] = side_ * 0.5 * static_cast<double>(ray.direction[at]);
    }
    world.t_max = static_cast<double>(ray.t_max);
    return world;
  }

  LatticeAnswer answer(const LatticeRay& ray) const {
    LatticeAnswer answer;
    // The cell and, per axis with a direction, halves of a voxel to the next plane: it is crossed at halves / |d|.
    std::array<std::int64_t, 3> cell{}, halves{}, speed{}, step{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t at = ray.origin[i], d = ray.direction[i];
      step[i] = d < 0 ? -1 : 1, speed[i] = d < 0 ? -d : d;
      const std::int64_t floor = at >= 0 ? at / 2 : -((1 - at) / 2);
      cell[i] = d < 0 && 2 * floor == at ? floor - 1 : floor;
      halves[i] = d < 0 ? at - 2 * cell[i] : 2 * (cell[i] + 1) - at;
    }
    std::int64_t num = 0, den = 1;  // t of the cell's entry
    for (;;) {
      const bool later = answer.hit() && num * answer.t_den > answer.t_num * den;
      if (later || num > ray.t_max * den) return answer;
      if (solid(cell)) {
        if (!answer.hit()) answer.t_num = num, answer.t_den = den;
        answer.decided = answer.decided && (ray.exact || num != ray.t_max * den);
        answer.cells.push_back({static_cast<int>(cell[0]), static_cast<int>(cell[1]), static_cast<int>(cell[2])});
      }
      std::size_t first = 3;
      for (std::size_t i = 0; i < 3; ++i) {
        if (speed[i] == 0) continue;
        const bool inwards = step[i] > 0 ? cell[i] < kSide : cell[i] >= 0;
        if (!inwards) return answer;
        if (first == 3) {
          first = i;
          continue;
        }
        const std::int64_t left = halves[i] * speed[first], right = halves[first] * speed[i];
        if (left == right && !ray.exact && !answer.hit()) answer.decided = false;
        if (left < right) first = i;
      }
      num = halves[first], den = speed[first];
      cell[first] += step[first];
      halves[first] += 2;
    }
  }

  /// Whether a hit of the scene is admissible for the ray.
  bool agrees(const LatticeRay& ray, const LatticeAnswer& expected, const Hit& hit) const {
    if (!expected.decided) return true;
    if (static_cast<bool>(hit) != expected.hit()) return false;
    if (!hit) return true;
    const double t = static_cast<double>(expected.t_num) / static_cast<double>(expected.t_den);
    // In voxels, along the longest component; a quantised ray is off by less than 2^-14.
    const double longest = 0.5 * static_cast<double>(std::max({std::abs(ray.direction[0]), std::abs(ray.direction[1]),
                                                               std::abs(ray.direction[2])}));
    if (ray.exact ? hit.t != t : !(std::abs(hit.t - t) * longest < 0x1p-13)) return false;
    const std::array<int, 3> cell = cell_of(static_cast<int>(hit.part), hit.voxel);
    return std::find(expected.cells.begin(), expected.cells.end(), cell) != expected.cells.end();
  }

 private:
  static std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>((z * kSide + y) * kSide + x);
  }
  void mark(const std::array<int, 3>& cell) { solid_[index(cell[0], cell[1], cell[2])] = 1; }
  bool solid(const std::array<std::int64_t, 3>& cell) const {
    for (const std::int64_t at : cell) {
      if (at < 0 || at >= kSide) return false;
    }
    return solid_[index(cell[0], cell[1], cell[2])] != 0;
  }

  std::vector<std::uint8_t> solid_;
  double side_;
  ivec3 corner_;
  PlacedVoxels placed_;
};

}  // namespace scarp::bench
