// SPDX-License-Identifier: MIT
// Unions, intersections and differences of placed voxels, against every single voxel.
#include "scarp/scene/voxel/combined_voxels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "base/refusal.h"
#include "scarp/base/lattice_rotation.h"
#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

using test::refusal;

glm::dmat3 matrix_of(const LatticeRotation& turn) {
  glm::dmat3 matrix(0.0);
  for (int row = 0; row < 3; ++row) matrix[turn.axis[row]][row] = turn.sign[row];
  return matrix;
}

// About z.
glm::dmat3 turned(double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  glm::dmat3 turn(1.0);
  turn[0][0] = turn[1][1] = std::cos(angle);
  turn[0][1] = std::sin(angle);
  turn[1][0] = -turn[0][1];
  return turn;
}

PlacedVoxels one(VoxelGrid grid, const glm::dmat3& world_from_grid, const dvec3& origin,
                 std::vector<VoxelColour> palette = {}) {
  const auto model =
      std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-planes"), std::move(palette));
  return {{model}, {{0, world_from_grid, origin}}, {}};
}

// A cube with this many voxels per side.
PlacedVoxels cube(int side, const glm::dmat3& world_from_grid = glm::dmat3(1.0), const dvec3& origin = dvec3(0.0)) {
  VoxelGrid grid(ivec3(side), 8);
  grid.fill(grid.box(), 1);
  return one(std::move(grid), world_from_grid, origin, {{}, {200, 100, 50}});
}

// The colour at a point; nullopt if it is empty.
std::optional<VoxelColour> colour_at(const PlacedVoxels& voxels, const dvec3& point) {
  for (const VoxelPlace& place : voxels.places) {
    const VoxelModel& model = *voxels.models[place.model];
    const dvec3 local = glm::inverse(place.world_from_grid) * (point - place.origin);
    const ivec3 v(glm::floor(local));
    if (model.grid().box().contains(v) && model.grid().solid(v)) return model.colour(model.grid().entry(v));
  }
  return {};
}

// Two objects, each with two random placements of a model on one lattice, which is rotated, scaled and moved.
TEST(CombinedVoxels, MatchPerVoxelCombination) {
  std::mt19937 random(7);
  const auto rotations = lattice_rotations();
  const glm::dmat3 lattice = 0.5 * turned(30);
  const dvec3 corner(100.25, -3.5, 7.125);
  for (int round = 0; round < 8; ++round) {
    std::vector<PlacedVoxels> parts;
    for (std::size_t part = 0; part < 2 + static_cast<std::size_t>(round % 2); ++part) {
      VoxelGrid grid({3, 1, 2}, 8);
      grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
        return random() % 3 > 0 ? VoxelGrid::Voxel(1 + random() % 2) : VoxelGrid::Voxel();
      });
      const auto level = static_cast<std::uint8_t>(80 * part);
      PlacedVoxels placed = one(std::move(grid), {}, {}, {{}, {level, 1, 2}, {level, 9, 8}});
      placed.places.clear();
      for (int copy = 0; copy < 2; ++copy) {
        const auto step = [&] { return static_cast<double>(random() % 3); };
        const dvec3 voxels(step() + 4 * copy, step(), step());
        placed.places.push_back(
            {0, lattice * matrix_of(rotations[random() % rotations.size()]), corner + lattice * voxels});
      }
      parts.push_back(std::move(placed));
    }
    for (const auto combination : {VoxelCombination::unite, VoxelCombination::intersect, VoxelCombination::subtract}) {
      const PlacedVoxels combined = combined_voxels(combination, parts);
      std::int64_t solid = 0;
      for_each_voxel({ivec3(-4), ivec3(11)}, [&](const ivec3& v) {
        const dvec3 point = corner + lattice * (dvec3(v) + 0.5);
        const auto found = colour_at(combined, point), first = colour_at(parts[0], point);
        std::optional<VoxelColour> expected = first;
        for (std::size_t i = 1; i < parts.size(); ++i) {
          const auto other = colour_at(parts[i], point);
          if (combination == VoxelCombination::unite && !expected) expected = other;
          if (combination == VoxelCombination::intersect && !other) expected.reset();
          if (combination == VoxelCombination::subtract && other) expected.reset();
        }
        ASSERT_EQ(found, expected) << round << ' ' << v.x << ' ' << v.y << ' ' << v.z;
        solid += found ? 1 : 0;
      });
      EXPECT_EQ(combined.places.empty() ? 0 : combined.models[0]->grid().solid_count(), solid);
    }
  }
}

TEST(CombinedVoxels, EmptyResultsHaveNoPlaces) {
  const std::vector<PlacedVoxels> same{cube(3), cube(3)}, apart{cube(3), cube(3, glm::dmat3(1.0), {9, 0, 0})};
  EXPECT_TRUE(combined_voxels(VoxelCombination::subtract, same).places.empty());
  EXPECT_TRUE(combined_voxels(VoxelCombination::intersect, apart).places.empty());
  EXPECT_TRUE(combined_voxels(VoxelCombination::unite, {}).places.empty());
  EXPECT_TRUE(scene_voxels(combined_voxels(VoxelCombination::subtract, same))->box()->empty());
}

TEST(CombinedVoxels, RequireACommonLattice) {
  const auto message = [](const PlacedVoxels& other) {
    return refusal([&] { combined_voxels(VoxelCombination::unite, std::vector<PlacedVoxels>{cube(2), other}); });
  };
  EXPECT_EQ(message(cube(2, turned(90), {3, 0, 0})), "");
  EXPECT_EQ(message(cube(2, glm::dmat3(1.0), {0, 0.5, 0})),
            "part 1 is (0, 0.5, 0) voxels off the lattice of the first one (combined voxels need whole offsets)");
  const std::string turned_or_scaled =
      "part 1 is rotated or scaled relative to the first one (combined voxels need quarter turns and equal sizes)";
  EXPECT_EQ(message(cube(2, turned(45))), turned_or_scaled);
  EXPECT_EQ(message(cube(2, glm::dmat3(2.0))), turned_or_scaled);
  EXPECT_EQ(message(cube(2, glm::dmat3(1.0), {3000, 0, 0})),
            "3002 x 2 x 2 combined voxels (each side is limited to 2048)");
  EXPECT_EQ(message(cube(2, glm::dmat3(1.0), {1e12, 0, 0})), "part 1 is more than 268435456 voxels from the first one");
}

}  // namespace
}  // namespace scarp
