// SPDX-License-Identifier: MIT
// Voxels that emit light, and voxels that mirror.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/picture.h"

namespace scarp {
namespace {

constexpr int kSide = 16, kWidth = 48, kHeight = 32;
constexpr std::uint32_t kFloor = 1, kWall = 2;
const std::vector<VoxelColour> kPalette = {{0, 0, 0}, {255, 255, 255}, {200, 40, 30}};

// A floor of one layer, and a wall behind it from one side to the other.
Scene room(VoxelMaterial floor, VoxelMaterial wall = {}) {
  VoxelGrid grid(ivec3(kSide), 8);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    if (v.y == kSide - 1) return VoxelGrid::Voxel(kWall);
    return v.z == 0 ? VoxelGrid::Voxel(kFloor) : VoxelGrid::Voxel();
  });
  auto model =
      std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"), kPalette,
                                         VoxelModel::Extent::bounds, std::vector{VoxelMaterial{}, floor, wall});
  return Scene(scene_voxels({{std::move(model)}, {VoxelPlace{}}}));
}

Camera camera() {
  Camera camera = Camera::look_at({8, 1, 9}, {8, 12, 1}, 40, kWidth, kHeight);
  camera.set_reach(100);
  return camera;
}

PictureLayers layers(const Scene& scene, bool unlit = false) {
  PictureSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.aa = 1;
  settings.haze = 0;
  settings.unlit = unlit;
  return render_layers(scene, camera(), settings);
}

bool is_wall(const PictureLayers& of, std::size_t i) {
  return std::isfinite(of.depth[i]) && of.position[i].y > kSide - 1.001f;
}
bool is_floor(const PictureLayers& of, std::size_t i) {
  return std::isfinite(of.depth[i]) && of.position[i].z < 1.001f && of.normal[i].z > 0.5f;
}

TEST(VoxelLight, EmissionScalesTheColour) {
  const PictureLayers plain = layers(room({})), glowing = layers(room({}, {.emission = 2}));
  int walls = 0;
  for (std::size_t i = 0; i < plain.colour.size(); ++i) {
    vec3 expected = plain.colour[i];
    if (is_wall(plain, i)) {
      expected += 2.0f * linear_from_srgb(vec3(200, 40, 30) / 255.0f);
      ++walls;
    }
    EXPECT_LT(length(glowing.colour[i] - expected), 1e-5f) << i;
  }
  EXPECT_GT(walls, 100);
}

TEST(VoxelLight, ReflectionsTakeTheSurfaceTint) {
  const Scene metal = room({.mirror = 0.75f});
  const PictureLayers plain = layers(room({})), mirrored = layers(metal);
  int of_wall = 0, of_sky = 0;
  for (std::size_t i = 0; i < plain.colour.size(); ++i) {
    if (!is_floor(plain, i)) {
      EXPECT_EQ(mirrored.colour[i], plain.colour[i]);
      continue;
    }
    // A separate ray finds the hit of the mirrored ray.
    const dvec3 p = dvec3(plain.position[i]);
    const dvec3 d = normalize(p - camera().eye());
    const dvec3 to(d.x, d.y, -d.z);
    Ray ray{p, to};
    ray.t_max = 100;
    ray.t_min = 1e-4;
    const Hit hit = metal.closest_hit(ray);
    const vec3 other = (mirrored.colour[i] - 0.25f * plain.colour[i]) / 0.75f;
    if (hit) {
      // The wall: red in any light.
      EXPECT_GT(other.x, 4 * other.y);
      ++of_wall;
    } else {
      EXPECT_GT(other.z, 0.8f * other.x);
      ++of_sky;
    }
  }
  EXPECT_GT(of_wall, 100);
  EXPECT_GT(of_sky, 20);
}

TEST(VoxelLight, IsOmittedFromUnlitPictures) {
  const PictureLayers plain = layers(room({}), true), metal = layers(room({.mirror = 1}, {.emission = 3}), true);
  EXPECT_EQ(plain.colour, metal.colour);
}

}  // namespace
}  // namespace scarp
