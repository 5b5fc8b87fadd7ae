// SPDX-License-Identifier: MIT
// Judges scenes of turned voxel objects: all of them are written into one grid, and a ray is traced through it in
// integers. Shares no code and no rounding with the marches.
//
//   scene   objects in all 48 orientations at integer positions, touching and overlapping
//   grid    cell (x, y, z) of the lattice -> solid or not
//   ray     origin in halves of a voxel, direction of whole numbers, ends in whole multiples of it
//
// The rule, in the directions of the lattice: planes crossed simultaneously are crossed in the order x, y, z; a ray
// along a plane belongs to the upper side, and a ray that starts on a plane to the cell that it enters.
//
// Half of the scenes have sides and places that are rounded, such as 0.1 m at 371.3 m: there a plane has a slightly
// different position in each object, and a ray one that differs slightly from any plane. Results for rays along planes
// must nevertheless follow the rule exactly. Where a rounded ray crosses several planes simultaneously, any order is
// admissible, but the ray must not pass between two cells that touch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bench/random.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel/placed_voxels.h"

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

/// The solid cells that may be hit first.
struct LatticeAnswer {
  struct Entry {
    std::int64_t t_num, t_den;  ///< t = t_num / t_den
    std::array<int, 3> cell;
  };
  std::vector<Entry> entries;  ///< in the order in which the ray enters them
  bool certain = false;        ///< whether one of them must be hit

  bool decided() const { return certain || entries.empty(); }
};

class VoxelSceneJudge {
 public:
  static constexpr int kSide = 20;  // of the lattice

  /// A random scene. `march` of all models; empty: any.
  VoxelSceneJudge(Random& random, std::string_view march)
      : solid_(static_cast<std::size_t>(kSide * kSide * kSide)),
        rounded_(random.below(2) == 0),
        side_(rounded_               ? random_side(random)
              : random.below(3) == 0 ? 0.25
                                     : 1),
        base_(rounded_ ? random_base(random, side_) : dvec3(0.0)),
        corner_(random.below(9) - 4, random.below(9) - 4, random.below(9) - 4) {
    const int objects = 2 + random.below(23), models = 1 + random.below(4);
    const bool tiles = random.below(3) == 0;  // equal sizes, side by side
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
      placed_.places.push_back({static_cast<std::uint32_t>(model), turn, base_ + side_ * dvec3(corner_ + low + shift)});
      at_.push_back(low + shift);
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

  /// Whether a ray's coordinates are exact in every object.
  bool exact(const LatticeRay& ray) const { return ray.exact && !rounded_; }

  /// The same objects as separate fields, rotated and partly scaled by their placements; mirrored ones are mirrored in
  /// their fields.
  Scene as_fields() const {
    std::vector<SceneFieldPtr> fields;
    std::vector<SceneObject> objects;
    for (const VoxelPlace& place : placed_.places) {
      const glm::dmat3 mirror(dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1));
      const glm::dmat3 turn = place.world_from_grid / side_;
      const bool mirrored = dot(cross(turn[0], turn[1]), turn[2]) < 0;
      SceneObject object;
      object.placement.scale = std::array{1.0, side_, 0.5}[objects.size() % 3];
      PlacedVoxels own;
      own.models = {placed_.models[place.model]};
      own.places = {{0, side_ / object.placement.scale * (mirrored ? mirror : glm::dmat3(1.0)), dvec3(0.0)}};
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
      int at = at_[static_cast<std::size_t>(object)][to];
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
    // Outside the scene or in it.
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
      world.origin[i] = std::fma(side_, 0.5 * static_cast<double>(ray.origin[at]) + corner_[i], base_[i]);
      world.direction[i] = side_ * 0.5 * static_cast<double>(ray.direction[at]);
    }
    world.t_max = static_cast<double>(ray.t_max);
    return world;
  }

  LatticeAnswer answer(const LatticeRay& ray) const {
    const bool in_order = exact(ray);
    LatticeAnswer answer;
    // The cell and, per axis with a direction, halves of a voxel to the next plane: it is crossed at halves / |d|.
    Cell cell{}, halves{}, speed{}, step{};
    unsigned begun = 0;  // axes whose planes it starts on
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t at = ray.origin[i], d = ray.direction[i];
      step[i] = d < 0 ? -1 : 1, speed[i] = d < 0 ? -d : d;
      const std::int64_t floor = at >= 0 ? at / 2 : -((1 - at) / 2);
      cell[i] = d < 0 && 2 * floor == at ? floor - 1 : floor;
      halves[i] = d < 0 ? at - 2 * cell[i] : 2 * (cell[i] + 1) - at;
      begun |= d != 0 && 2 * floor == at ? 1u << i : 0u;
    }
    const auto behind = [&](unsigned axes) {
      Cell at = cell;
      for (std::size_t i = 0; i < 3; ++i) at[i] -= axes >> i & 1 ? step[i] : 0;
      return at;
    };
    // A rounded start may be behind its planes.
    if (rounded_) {
      for (unsigned axes = begun; axes != 0; axes = (axes - 1) & begun) enter(behind(axes), 0, 1, answer);
    }
    bool over = enter(cell, 0, 1, answer) && (in_order || ray.t_max > 0);
    answer.certain = over;
    std::int64_t num = 0, den = 1;
    for (;;) {
      // The axes of the planes that are crossed next.
      unsigned axes = 0;
      std::size_t first = 3;
      for (std::size_t i = 0; i < 3; ++i) {
        if (speed[i] == 0) continue;
        const bool inwards = step[i] > 0 ? cell[i] < kSide : cell[i] >= 0;
        if (!inwards) return answer;
        const std::int64_t left = first < 3 ? halves[i] * speed[first] : 0,
                           right = first < 3 ? halves[first] * speed[i] : 1;
        if (left < right) first = i, axes = 0;
        if (left <= right) axes |= 1u << i;
      }
      const std::int64_t next_num = halves[first], next_den = speed[first];
      const bool later = next_num * den > num * next_den;
      if ((over && later) || next_num > ray.t_max * next_den) return answer;
      num = next_num, den = next_den;
      if (in_order) axes = 1u << first;
      for (std::size_t i = 0; i < 3; ++i) {
        if (axes >> i & 1) cell[i] += step[i], halves[i] += 2;
      }
      const bool blocked = enter_around(behind, axes, num, den, answer);
      over = over || (blocked && (in_order || num != ray.t_max * den));
      answer.certain = over;
    }
  }

  /// Whether a hit of the scene is admissible for the ray.
  bool agrees(const LatticeRay& ray, const LatticeAnswer& expected, const Hit& hit) const {
    if (!hit) return !expected.certain;
    const std::array<int, 3> cell = cell_of(static_cast<int>(hit.part), hit.voxel);
    // In voxels, along the longest component; a quantised ray is off by less than 2^-14.
    const double longest = 0.5 * static_cast<double>(std::max({std::abs(ray.direction[0]), std::abs(ray.direction[1]),
                                                               std::abs(ray.direction[2])}));
    return std::any_of(expected.entries.begin(), expected.entries.end(), [&](const LatticeAnswer::Entry& entry) {
      const double t = static_cast<double>(entry.t_num) / static_cast<double>(entry.t_den);
      return entry.cell == cell && (exact(ray) ? hit.t == t : std::abs(hit.t - t) * longest < 0x1p-13);
    });
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  static double random_side(Random& random) {
    constexpr std::array<double, 6> kSides = {0.1, 0.3, 1.0 / 3, 7.7, 0.01, 1};
    return kSides[static_cast<std::size_t>(random.below(6))];
  }
  // Decimals, multiples of the side, or any number.
  static dvec3 random_base(Random& random, double side) {
    const int kind = random.below(4);
    dvec3 base;
    for (int i = 0; i < 3; ++i) {
      base[i] = kind == 0   ? 0
                : kind == 1 ? 0.1 * (random.below(20'001) - 10'000)
                : kind == 2 ? side * (random.below(1'000'001) - 500'000)
                            : random.uniform(-1e4, 1e4);
    }
    return base;
  }

  // Returns whether the cell is solid.
  bool enter(const Cell& cell, std::int64_t num, std::int64_t den, LatticeAnswer& answer) const {
    if (!solid(cell)) return false;
    answer.entries.push_back(
        {num, den, {static_cast<int>(cell[0]), static_cast<int>(cell[1]), static_cast<int>(cell[2])}});
    return true;
  }

  // Enters the cells around planes that are crossed at the same time, in any order. behind(axes) is the cell before the
  // planes of these axes are crossed. Returns whether every order leads into a solid cell.
  template <class Behind>
  bool enter_around(const Behind& behind, unsigned axes, std::int64_t num, std::int64_t den,
                    LatticeAnswer& answer) const {
    std::array<bool, 8> open{};
    open[axes] = true;
    for (unsigned ahead = axes; ahead != 0;) {
      ahead = (ahead - 1) & axes;
      bool reached = false;
      for (unsigned axis = 1; axis < 8; axis *= 2)
        reached = reached || ((axes & ~ahead & axis) != 0 && open[ahead | axis]);
      open[ahead] = !enter(behind(ahead), num, den, answer) && reached;
    }
    return !open[0];
  }

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
  bool rounded_;  // whether sides or positions are rounded
  double side_;
  dvec3 base_;             // position of the lattice in the world, in metres
  ivec3 corner_;           // corner relative to base_, in voxels
  std::vector<ivec3> at_;  // places of the objects on the lattice
  PlacedVoxels placed_;
};

}  // namespace scarp::bench
