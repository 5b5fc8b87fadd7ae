// SPDX-License-Identifier: MIT
// Voxels apart from their hits: normals, corners, coarser models, and voxelised scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "scarp/base/error.h"
#include "scarp/field/rotate_voxels.h"
#include "scarp/scene/file/from_volume.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/scene/file/to_vox.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel/coarse_voxels.h"
#include "scarp/scene/voxel/voxel_objects.h"
#include "scarp/scene/voxelised.h"

namespace scarp {
namespace {

// Rounding of normals: sums of some two hundred terms, each rounded to 2^-53 of itself, a hundredfold.
constexpr double kRounding = 2e4 * 0x1p-53;

template <class Solid>
VoxelGrid grid_where(const ivec3& size, const Solid& solid) {
  VoxelGrid grid(size, 24);
  grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    return solid(v) ? VoxelGrid::Voxel(0x0a0b0c) : VoxelGrid::Voxel();
  });
  return grid;
}

std::shared_ptr<const VoxelModel> model_of(VoxelGrid grid) {
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
}

// Symmetry gives the answer: planes along the axes, and a staircase that all orders of the axes leave as it is.
TEST(SmoothNormal, MatchesPlanes) {
  const VoxelGrid level = grid_where(ivec3(16), [](const ivec3& v) { return v.z < 8; });
  EXPECT_LT(length(smooth_normal(level, {8.5, 8.5, 8}, 2.5) - dvec3(0, 0, 1)), kRounding);
  const VoxelGrid stairs = grid_where(ivec3(16), [](const ivec3& v) { return v.x + v.y + v.z < 24; });
  EXPECT_LT(length(smooth_normal(stairs, dvec3(8), 3) - dvec3(1 / std::sqrt(3.0))), kRounding);
  EXPECT_EQ(smooth_normal(level, {8, 8, 14}, 3), dvec3(0.0));
}

// In the middle of a row of voxels that touch at edges, both sides are equal: the normal is the face's own, and does
// not jump on the path to this point.
TEST(SmoothNormal, FallsBackToTheFaceNormal) {
  const VoxelGrid row = grid_where(ivec3(16), [](const ivec3& v) { return v.x == v.z; });
  const dvec3 face(0, 0, 1);
  EXPECT_LT(length(smooth_normal(row, {8, 8.5, 8}, 3, face) - face), kRounding);
  for (double x = 7; x < 8; x += 0.01) {
    const dvec3 here = smooth_normal(row, {x, 8.5, 8}, 3, face), next = smooth_normal(row, {x + 0.01, 8.5, 8}, 3, face);
    EXPECT_LT(length(next - here), 0.1) << x;
    EXPECT_GT(here.z, 0.5);
  }
}

TEST(SmoothNormal, RotatesWithTheGrid) {
  const VoxelGrid grid =
      grid_where({9, 10, 11}, [](const ivec3& v) { return (v.x * v.x + 3 * v.y + v.z * v.y) % 5 < 2; });
  const dvec3 middle = 0.5 * dvec3(grid.size()), point(3.2, 5.1, 6.4);
  for (const LatticeRotation& turn : lattice_rotations()) {
    const VoxelGrid turned = rotated(grid, turn);
    const dvec3 there = turn(point - middle) + 0.5 * dvec3(turned.size());
    EXPECT_LT(length(smooth_normal(turned, there, 2.5) - turn(smooth_normal(grid, point, 2.5))), kRounding);
  }
}

// The four levels of a corner, by hand.
TEST(CornerOpenness, CountsTheVoxelsAtACorner) {
  VoxelGrid grid(ivec3(3));
  grid.set({1, 1, 0}, 1);
  const auto at = [&](double x, double y) { return corner_openness(grid, {1, 1, 0}, VoxelFace::high_z, {x, y, 1}); };
  EXPECT_EQ(at(2, 2), 1);
  grid.set({2, 2, 1}, 1);
  EXPECT_EQ(at(2, 2), 0.75);
  EXPECT_EQ(at(1, 1), 1);
  EXPECT_EQ(at(1.5, 1.5), (3 + 0.75) / 4);
  grid.set({2, 1, 1}, 1);
  EXPECT_EQ(at(2, 2), 0.5);
  EXPECT_EQ(at(2, 1), 0.75);
  grid.set({1, 2, 1}, 1);
  EXPECT_EQ(at(2, 2), 0.25);
  grid.clear(ivec3(2, 2, 1));
  EXPECT_EQ(at(2, 2), 0.25);  // hidden by the two
  EXPECT_EQ(corner_openness(grid, {1, 1, 0}, VoxelFace::inside, {2, 2, 1}), 1);
}

std::int64_t solid_after(const VoxelGrid& grid, int level) {
  return coarse_voxels(model_of(grid), level)->grid().solid_count();
}

TEST(CoarseVoxels, PreserveCoverage) {
  for (int axis = 0; axis < 3; ++axis) {
    const int other = (axis + 1) % 3;
    // A wall of a single voxel stays closed.
    const VoxelGrid wall = grid_where(ivec3(64), [&](const ivec3& v) { return v[axis] == 21; });
    EXPECT_EQ(solid_after(wall, 1), 32 * 32);
    EXPECT_EQ(solid_after(wall, 3), 8 * 8);
    // Every second block of a thread's 32 remains.
    const VoxelGrid thread = grid_where(ivec3(64), [&](const ivec3& v) { return v[axis] == 21 && v[other] == 33; });
    EXPECT_EQ(solid_after(thread, 1), 16);
  }
  EXPECT_EQ(solid_after(grid_where(ivec3(64), [](const ivec3&) { return true; }), 2), 16 * 16 * 16);
  // Single voxels in each 8 x 8 x 8: 4,096, of which a quarter stays, give or take five standard errors of that many
  // draws; a pattern in step with theirs would keep all or none.
  const VoxelGrid dust =
      grid_where(ivec3(128), [](const ivec3& v) { return v.x % 8 == 3 && v.y % 8 == 6 && v.z % 8 == 1; });
  EXPECT_NEAR(static_cast<double>(solid_after(dust, 1)), 1024, 5 * std::sqrt(4096 * 0.25 * 0.75));
}

// Hidden voxels do not affect the colour of visible ones; means are in linear light.
TEST(CoarseVoxels, HaveTheMeanColourOfVisibleVoxels) {
  VoxelGrid grid(ivec3(4), 24);
  grid.fill(grid.box(), 0xffffff);
  grid.fill({{0, 0, 0}, {4, 4, 1}}, 0x000000);
  grid.fill({{1, 1, 1}, {3, 3, 3}}, 0x0000ff);  // buried
  const auto coarse = coarse_voxels(model_of(grid), 1);
  // 7 of a block's 8 voxels are visible: 4 of them black, 3 white at the bottom; all 7 white at the top.
  EXPECT_EQ(coarse->colour(coarse->grid().entry({0, 0, 1})), (VoxelColour{255, 255, 255}));
  // 3/7 of white light: 255 * (1.055 * (3/7)^(1/2.4) - 0.055).
  const auto grey = static_cast<std::uint8_t>(std::lround(255 * (1.055 * std::pow(3.0 / 7, 1 / 2.4) - 0.055)));
  EXPECT_EQ(coarse->colour(coarse->grid().entry({0, 0, 0})), (VoxelColour{grey, grey, grey}));
}

TEST(CoarseVoxels, AreUsedWherePixelsAreLarger) {
  const VoxelGrid wall = grid_where(ivec3(64), [](const ivec3& v) { return v.z == 0; });
  const SceneFieldPtr field = scene_voxels({{model_of(wall)}, {VoxelPlace{}}});
  const Scene scene({field}, {SceneObject{0, 0, {glm::dmat3(1.0), 0.5, {0, 0, 0}}}, SceneObject{0, 0, {}}});
  // The eye is 100 m above; voxels are 0.5 and 1 m, a pixel 2.2 m: levels 2 and 1.
  const Scene coarse = scene.coarser({{0, 0, 101}, {0, 0, -1}, [](double depth) { return 0.022 * depth; }});
  const auto detail = [&](std::size_t object) { return coarse.fields()[coarse.objects()[object].field]->cell_side(); };
  EXPECT_EQ(detail(0), 4);
  EXPECT_EQ(detail(1), 2);
  EXPECT_EQ(coarse.box().high, dvec3(64, 64, 2));
  const Scene near = scene.coarser({{0, 0, 11}, {0, 0, -1}, [](double depth) { return 0.022 * depth; }});
  EXPECT_EQ(near.fields().size(), 1U);
}

// Stairs with the sun slightly above their slope: flat-shaded stairs shadow themselves, smooth ones do not.
TEST(SmoothVoxels, AreNotShadowedByTheirOwnSteps) {
  const VoxelGrid stairs = grid_where(ivec3(64, 16, 40), [](const ivec3& v) { return 2 * v.z < v.x; });
  const PlacedVoxels voxels{{model_of(stairs)}, {VoxelPlace{0, glm::dmat3(0.5), {10, 0, 0}}}};
  const auto blocked = [&](VoxelNormals normals, int towards) {
    VoxelShading shading;
    shading.normals = normals;
    const Scene scene(scene_voxels(voxels, shading));
    int count = 0;
    for (int i = 0; i < 100; ++i) {
      Ray down;
      down.origin = {15 + 0.1 * i, 4.05, 30};
      const Hit hit = scene.closest_hit(down);
      Ray sun;
      sun.origin = down.at(hit.t);
      sun.direction = {towards, 0, towards > 0 ? 0.6 : -3};
      count += scene.occluded(sun, &hit) ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(blocked(VoxelNormals::flat, 1), 30);
  EXPECT_EQ(blocked(VoxelNormals::smooth, 1), 0);
  // Inside the stairs it stays dark.
  EXPECT_EQ(blocked(VoxelNormals::smooth, -1), 100);
}

// Symmetry gives the answers: a voxel that protrudes from a slope rising along x, seen from up the slope, and a sheet
// in front of a thick wall, seen from between them.
TEST(SmoothVoxels, LightFacesOfOppositeOrientation) {
  const auto seen = [](const VoxelGrid& grid, const dvec3& from, const dvec3& direction) {
    const SceneFieldPtr field = scene_voxels({{model_of(grid)}, {VoxelPlace{}}}, {.normals = VoxelNormals::smooth});
    Ray ray;
    ray.origin = from, ray.direction = direction;
    return field->surface(ray, field->closest_hit(ray, nullptr, nullptr));
  };
  const FieldSurface step =
      seen(grid_where(ivec3(64, 17, 40),
                      [](const ivec3& v) { return 2 * v.z < v.x || v == ivec3(30, 8, 15) || v == ivec3(30, 8, 16); }),
           {40, 8.5, 25.5}, {-1, 0, -1});
  EXPECT_EQ(step.normal, dvec3(1, 0, 0));
  EXPECT_LT(length(step.shading_normal - dvec3(0, 0, 1)), kRounding);
  const FieldSurface sheet = seen(grid_where(ivec3(24, 17, 17), [](const ivec3& v) { return v.x == 8 || v.x >= 11; }),
                                  {10, 8.5, 8.5}, {-1, 0, 0});
  EXPECT_EQ(sheet.normal, dvec3(1, 0, 0));
  EXPECT_LT(length(sheet.shading_normal - dvec3(1, 0, 0)), kRounding);
}

TEST(SmoothVoxels, UseTheModelThatWasHit) {
  const auto slab = model_of(grid_where(ivec3(8), [](const ivec3& v) { return v.z < 1; }));
  const auto stairs = model_of(grid_where(ivec3(16), [](const ivec3& v) { return v.x + v.y + v.z < 24; }));
  const VoxelShading shading{.normals = VoxelNormals::smooth, .corner_ao = true};
  const SceneFieldPtr alone = scene_voxels({{stairs}, {VoxelPlace{}}}, shading);
  const SceneFieldPtr second =
      scene_voxels({{slab, stairs}, {VoxelPlace{.origin = {40, 0, 0}}, VoxelPlace{.model = 1}}}, shading);
  Ray down;
  down.origin = {8.3, 7.6, 30};
  const Hit hit = second->closest_hit(down, nullptr, nullptr);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.part, 1u);
  const FieldSurface is = second->surface(down, hit),
                     expected = alone->surface(down, alone->closest_hit(down, nullptr, nullptr));
  EXPECT_EQ(is.shading_normal, expected.shading_normal);
  EXPECT_EQ(is.openness, expected.openness);
  EXPECT_LT(expected.openness, 1);
  EXPECT_LT(expected.shading_normal.z, 0.9);
}

SceneFieldPtr ball(double radius) {
  Shape shape = make_shape(shape::Sphere{radius});
  return scene_shape(DistanceField(std::move(shape)));
}

TEST(Voxelised, SamplesVoxelCentres) {
  const Scene scene({ball(3)}, {SceneObject{0, 0, {glm::dmat3(1.0), 2, {1, -20, 3.3}}}});
  const VoxelLattice lattice = lattice_around(scene, 0.5);
  // (-5, -26, -2.7) to (7, -14, 9.3); the box of the shape may be larger by rounding, and so by a voxel.
  EXPECT_EQ(intersection(lattice.box, {{-10, -52, -6}, {14, -28, 19}}), (VoxelBox{{-10, -52, -6}, {14, -28, 19}}));
  EXPECT_EQ(intersection(lattice.box, {{-11, -53, -6}, {15, -27, 19}}), lattice.box);
  const VoxelGrid grid = voxelised(scene, lattice, [](const SceneSurface&) { return 5U; });
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    const dvec3 from = 0.5 * (dvec3(lattice.box.low + v) + 0.5) - dvec3(1, -20, 3.3);
    ASSERT_EQ(grid.solid(v), dot(from, from) <= 36) << v.x << ' ' << v.y << ' ' << v.z;
  });
}

TEST(Voxelised, GroundIsSolidBelow) {
  std::vector<float> samples;
  for (int row = 0; row < 9; ++row) {
    for (int col = 0; col < 9; ++col) samples.push_back(static_cast<float>(col) * 0.75F + 0.125F);
  }
  const Scene scene({scene_heights(HeightField::own(std::move(samples), 9, 9, {}))}, {SceneObject{}});
  const VoxelLattice lattice = lattice_around(scene, 1);
  const VoxelGrid grid = voxelised(scene, lattice, [](const SceneSurface& surface) {
    EXPECT_LT(length(surface.normal - normalize(dvec3(-0.75, 0, 1))), kRounding);
    return 5U;
  });
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    const dvec3 p = dvec3(lattice.box.low + v) + 0.5;
    ASSERT_EQ(grid.solid(v), p.z <= 0.75 * p.x + 0.125);
  });
}

TEST(Voxelised, RejectsInvalidLattices) {
  const Scene scene({ball(3)}, {SceneObject{}});
  EXPECT_THROW(lattice_around(scene, 0), Error);
  EXPECT_THROW(lattice_around(scene, 0.001), Error);
  EXPECT_THROW(lattice_around(scene, 1, WorldBox{{10, 10, 10}, {20, 20, 20}}), Error);
}

// A file of two models, read back: every voxel has the same position and colour.
TEST(ToVox, KeepsPlacesAndColours) {
  VoxelGrid grid({300, 3, 2}, 24);
  grid.set({0, 0, 0}, 0x010203);
  grid.set({255, 2, 1}, 0x040506);
  grid.set({256, 1, 0}, 0x070809);
  grid.set({299, 2, 1}, 0x010203);
  bool exact = false;
  const VoxFile file = vox_file_of(grid, {-7, 20, 5}, exact);
  EXPECT_TRUE(exact);
  EXPECT_EQ(file.models.size(), 2U);
  const VoxelObjects scene(placed_voxels_from(parse_vox(vox_bytes(file))));
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    const auto colour = scene.colour_at(dvec3(v + ivec3(-7, 20, 5)) + 0.5);
    ASSERT_EQ(colour.has_value(), grid.solid(v)) << v.x << ' ' << v.y << ' ' << v.z;
    if (!colour) return;
    ASSERT_EQ(static_cast<std::uint32_t>((*colour)[0] | (*colour)[1] << 8 | (*colour)[2] << 16), grid.entry(v));
  });
}

// 12^3 voxels of one colour with an alpha.
std::int64_t solid_of(std::uint8_t alpha) {
  VoxFile file;
  file.palette.emplace();
  (*file.palette)[4] = {9, 9, 9, alpha};
  VoxModel model{ivec3(12), {}};
  for_each_voxel({ivec3(0), ivec3(12)}, [&](const ivec3& v) {
    model.voxels.push_back(
        {static_cast<std::uint8_t>(v.x), static_cast<std::uint8_t>(v.y), static_cast<std::uint8_t>(v.z), 5});
  });
  file.models = {std::move(model)};
  return placed_voxels_from(file).models.at(0)->grid().solid_count();
}

TEST(FromVox, AlphaIsTheFractionOfSolidVoxels) {
  constexpr std::int64_t kAll = 12 * 12 * 12;
  EXPECT_EQ(solid_of(255), kAll);
  EXPECT_EQ(solid_of(0), kAll);  // left out
  EXPECT_EQ(solid_of(191), kAll * 3 / 4);
  EXPECT_EQ(solid_of(128), kAll / 2);
  EXPECT_EQ(solid_of(64), kAll / 4);
  EXPECT_EQ(solid_of(1), kAll / 4);
}

TEST(FromVox, ReadsMaterials) {
  VoxFile file;
  file.models = {{ivec3(2, 1, 1), {{0, 0, 0, 1}, {1, 0, 0, 2}}}};
  file.materials = {{2, {{"_type", "_metal"}, {"_metal", "0.5"}}}, {3, {{"_type", "_emit"}, {"_emit", "1"}}}};
  const PlacedVoxels placed = placed_voxels_from(file);
  const VoxelModel& model = *placed.models.at(0);
  EXPECT_TRUE(model.mirrors());
  EXPECT_EQ(model.material(1).mirror, 0);
  EXPECT_EQ(model.material(2).mirror, 0.5f);
  EXPECT_EQ(model.material(3).emission, 1);
  EXPECT_EQ(model.material(300).emission, 0);
}

TEST(ToVox, MapsToTheNearestPaletteColour) {
  VoxelGrid grid(ivec3(16), 24);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return VoxelGrid::Voxel(static_cast<std::uint32_t>(17 * v.x | 17 * v.y << 8 | 17 * v.z << 16));
  });
  bool exact = true;
  const VoxelObjects scene(placed_voxels_from(vox_file_of(grid, ivec3(0), exact)));
  EXPECT_FALSE(exact);
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    const auto colour = *scene.colour_at(dvec3(v) + 0.5);
    // Half a step: 255 / 5, 255 / 6 and 255 / 5, and a half for rounding.
    EXPECT_LE(std::abs(colour[0] - 17 * v.x), 26);
    EXPECT_LE(std::abs(colour[1] - 17 * v.y), 22);
    EXPECT_LE(std::abs(colour[2] - 17 * v.z), 26);
  });
}

TEST(FromVolume, RotatesTheUpAxis) {
  Binvox binvox;
  binvox.size = {2, 3, 4};
  binvox.clear();
  binvox.set({1, 2, 0});
  const VoxelObjects as_is(placed_voxels_from(binvox, {9, 8, 7}));
  EXPECT_EQ(as_is.colour_at({1.5, 2.5, 0.5}), (VoxelColour{9, 8, 7}));
  FromVolumeOptions options;
  options.up = UpAxis::y;
  // y goes up, z comes towards the viewer: south.
  const VoxelObjects up(placed_voxels_from(binvox, {9, 8, 7}, options));
  EXPECT_EQ(up.colour_at({1.5, 3.5, 2.5}), (VoxelColour{9, 8, 7}));
  EXPECT_EQ(up.models()[0]->grid().solid_count(), 1);
}

TEST(FromVolume, ColoursByIndex) {
  const DenseVolume volume(parse_volume_format("5x1x1:u8"), std::string("\0\12\24\36\31", 5));
  const std::vector<VoxelColour> colours{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  FromVolumeOptions options;
  const VoxelObjects all(placed_voxels_from(volume, colours, solid_range(volume, options.solid_from), options));
  EXPECT_FALSE(all.colour_at({0.5, 0.5, 0.5}));
  EXPECT_EQ((*all.colour_at({1.5, 0.5, 0.5}))[0], 1);
  EXPECT_EQ((*all.colour_at({2.5, 0.5, 0.5}))[0], 2);
  EXPECT_EQ((*all.colour_at({3.5, 0.5, 0.5}))[0], 3);
  EXPECT_EQ((*all.colour_at({4.5, 0.5, 0.5}))[0], 3);  // 1.5 steps of 10: the nearest above
  options.solid_from = 25;
  const VoxelObjects some(placed_voxels_from(volume, colours, solid_range(volume, options.solid_from), options));
  EXPECT_FALSE(some.colour_at({2.5, 0.5, 0.5}));
  EXPECT_EQ((*some.colour_at({4.5, 0.5, 0.5}))[0], 1);
}

}  // namespace
}  // namespace scarp
