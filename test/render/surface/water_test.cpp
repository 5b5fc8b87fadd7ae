// SPDX-License-Identifier: MIT
#include "scarp/render/surface/water.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/terrain.h"
#include "scarp/base/error.h"
#include "scarp/render/frame/layers.h"
#include "scarp/render/light/sky_model.h"

namespace scarp {
namespace {

// The plain sky towards a direction with this z.
vec3 sky_at(double z) { return Sky({}, {0, 0, 1}, 0).colour({std::sqrt(1 - z * z), 0, z}); }

HeightField flat(float height, int side = 9, double cell = 1000, Wrap wrap = Wrap::none) {
  HeightFieldSettings settings;
  settings.cell_x = settings.cell_y = cell;
  settings.wrap = wrap;
  return HeightField::own(std::vector<float>(static_cast<std::size_t>(side * side), height), side, side, settings);
}

PictureSettings plain(int width, int height) {
  PictureSettings settings;
  settings.width = width;
  settings.height = height;
  settings.aa = 1;
  settings.haze = 0;
  settings.water.emplace();
  settings.water->waves = 0;
  return settings;
}

TEST(Water, ObeysReflectionAndRefractionLaws) {
  const double r0 = 0.333 / 2.333 * (0.333 / 2.333);
  EXPECT_NEAR(r0, 0.0204, 5e-5);
  EXPECT_DOUBLE_EQ(schlick(1), r0);
  EXPECT_DOUBLE_EQ(schlick(0), 1);
  EXPECT_NEAR(schlick(0.5), r0 + (1 - r0) / 32, 1e-15);
  for (const double angle : {0.0, 0.3, 1.0, 1.5}) {
    const dvec3 in(std::sin(angle), 0, -std::cos(angle)), up(0, 0, 1);
    const dvec3 down = refracted(in, up), back = reflected(in, up);
    EXPECT_NEAR(down.x * 1.333, std::sin(angle), 1e-14) << "Snell";
    EXPECT_NEAR(length(down), 1, 1e-14);
    EXPECT_LT(down.z, 0);
    EXPECT_NEAR(back.x, in.x, 1e-15);
    EXPECT_NEAR(back.z, -in.z, 1e-15);
  }
}

// A cone of slope 1 whose top is at the middle node. Between nodes, a bilinear patch deviates from the cone by at most
// (1 / 8) (d2/dx2 + d2/dy2) = 1 / (8 r) cells, and so is the coast: 0.006 cells at r = 20.4.
constexpr int kConeSide = 65;
constexpr double kMiddle = 32, kTop = 40, kLevel = 19.6, kCoast = kTop - kLevel;
HeightField cone() {
  std::vector<float> samples;
  for (int row = 0; row < kConeSide; ++row) {
    for (int col = 0; col < kConeSide; ++col) {
      samples.push_back(static_cast<float>(kTop - std::hypot(col - kMiddle, row - kMiddle)));
    }
  }
  return HeightField::own(std::move(samples), kConeSide, kConeSide);
}

TEST(Water, CoastOfAConeIsACircle) {
  constexpr int kSide = 192;
  const Scene scene = test::terrain(cone(), "max-mip");
  PictureSettings settings = plain(kSide, kSide);
  settings.water->level = kLevel;
  settings.shadows = false;
  const Camera camera = Camera::look_at({kMiddle, kMiddle, 200}, {kMiddle, kMiddle, 0}, 16, kSide, kSide);
  const PictureLayers layers = render_layers(scene, camera, settings);
  // Size of a pixel on the water, in cells: the coast is known to half a pixel.
  const double half_pixel = camera.pixel_width(200 - kLevel) / 2;
  EXPECT_GT(half_pixel, 0.006 * 10) << "a cone of patches is a cone here";
  const Water water(*settings.water, scene);
  const StepMarch steps((*scene.only_heights()), {.steps = 64, .interpolate = false}, 250, camera.forward());
  int sea = 0, land = 0, ragged = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const std::size_t i = static_cast<std::size_t>(y * kSide + x);
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const dvec3 p = ray.at((kLevel - ray.origin.z) / ray.direction.z);
      const double from_coast = std::hypot(p.x - kMiddle, p.y - kMiddle) - kCoast;
      if (std::abs(from_coast) <= half_pixel) continue;
      const bool is_sea = layers.normal[i].z == 1;
      EXPECT_EQ(is_sea, from_coast > 0) << x << ", " << y;
      if (is_sea) {
        EXPECT_NEAR(layers.position[i].z, kLevel, 1e-5);
      }
      ++(is_sea ? sea : land);
      ragged += steps.march(ray, &water).water != is_sea;
    }
  }
  EXPECT_GT(sea, 5000);
  EXPECT_GT(land, 5000);
  EXPECT_GT(ragged, 100) << "first samples below the level give no circle";
}

TEST(Water, ReflectsTheVisibleSky) {
  const Scene scene = test::terrain(flat(0), "max-mip");
  PictureSettings settings = plain(64, 48);
  settings.water->level = 50;
  settings.water->turbidity = 1e6;  // no visible bottom
  const Camera camera = Camera::look_at({4000, 100, 300}, {4000, 3000, 0}, 50, 64, 48);
  const PictureLayers layers = render_layers(scene, camera, settings);
  const vec3 deep = Water(*settings.water, scene).deep();
  int seen = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::size_t i = static_cast<std::size_t>(y * 64 + x);
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      if (layers.normal[i].z != 1) continue;
      ++seen;
      const double mirror = schlick(-ray.direction.z);
      for (int c = 0; c < 3; ++c) {
        const double expected = mirror * sky_at(-ray.direction.z)[c] + (1 - mirror) * deep[c];
        EXPECT_NEAR(layers.colour[i][c], expected, 1e-3) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(Water, AbsorbsByTracedDepth) {
  const double depth = 3;
  const Scene scene = test::terrain(flat(10), "max-mip");
  PictureSettings settings = plain(32, 32);
  settings.sun.altitude_deg = 90;
  const Camera camera = Camera::look_at({4000, 4000, 400}, {4000, 4200, 0}, 40, 32, 32);
  PictureSettings dry_settings = settings;
  dry_settings.water.reset();
  const PictureLayers dry = render_layers(scene, camera, dry_settings);
  settings.water->level = 10 + depth;
  settings.water->turbidity = 0.1;
  const PictureLayers wet = render_layers(scene, camera, settings);
  const vec3 deep = Water(*settings.water, scene).deep();
  const double absorbed[] = {0.340 + 0.1, 0.0565 + 0.1, 0.00922 + 0.1};
  for (int y = 0; y < 32; y += 3) {
    for (int x = 0; x < 32; x += 3) {
      const std::size_t i = static_cast<std::size_t>(y * 32 + x);
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const double sine = std::sqrt(1 - ray.direction.z * ray.direction.z) / 1.333;
      const double way = depth / std::sqrt(1 - sine * sine), mirror = schlick(-ray.direction.z);
      for (int c = 0; c < 3; ++c) {
        // Sunlight from overhead passes down through the depth, then back to the eye.
        const double bottom = dry.colour[0][c] * std::exp(-absorbed[c] * depth);
        const double left = std::exp(-absorbed[c] * way);
        const double body = bottom * left + deep[c] * (1 - left);
        const double expected = mirror * sky_at(-ray.direction.z)[c] + (1 - mirror) * body;
        EXPECT_NEAR(wet.colour[i][c], expected, 1e-3) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(dry.colour[0].y, 0.1f) << "the ground is no darkness";
}

TEST(Water, FillsItsBasin) {
  const Scene scene = test::terrain(flat(0, 11, 1));
  WaterSettings settings;
  settings.level = 4;
  const Water water(settings, scene);
  const auto meets = [&](const dvec3& from, const dvec3& direction) {
    Ray ray;
    ray.origin = from;
    ray.direction = normalize(direction);
    return water.meets(ray);
  };
  const auto top = meets({5, 5, 9}, {0, 1, -2});
  ASSERT_TRUE(top);
  EXPECT_EQ(top->normal, dvec3(0, 0, 1));
  const auto side = meets({-3, 5, 2}, {1, 0, 0});
  ASSERT_TRUE(side);
  EXPECT_EQ(side->t, 3);
  EXPECT_EQ(side->normal, dvec3(-1, 0, 0));
  const auto north = meets({5, 13, 2}, {0, -1, 0});
  ASSERT_TRUE(north);
  EXPECT_EQ(north->normal, dvec3(0, 1, 0));
  EXPECT_FALSE(meets({-3, 5, 2}, {-1, 0, 0}));
  EXPECT_FALSE(meets({5, 5, 9}, {0, 0, 1}));
  EXPECT_FALSE(meets({-3, 5, 9}, {0, 0, -1})) << "beside it";
  EXPECT_FALSE(meets({5, 5, 2}, {0, 0, -1})) << "already in it";
  EXPECT_FALSE(meets({-3, 5, -1}, {1, 0, 0})) << "under the ground";
  Ray across;
  across.origin = {2, 5, 3};
  across.direction = {1, 0, -0.01};
  EXPECT_EQ(water.leaves(across), 8);

  std::vector<float> torn(121, 0);
  torn[60] = NAN;
  const Scene holed = test::terrain(HeightField::own(std::move(torn), 11, 11));
  const Water lake(settings, holed);
  Ray down;
  down.origin = {4.8, 5.2, 9};
  EXPECT_FALSE(lake.meets(down)) << "nothing holds water over a hole";
  down.origin = {2.5, 2.5, 9};
  EXPECT_TRUE(lake.meets(down));
}

TEST(Water, DoesNotExistUnderHigherGround) {
  const Scene scene = test::terrain(flat(7, 11, 1));
  WaterSettings settings;
  settings.level = 4;
  const Water below(settings, scene);
  Ray ray;
  ray.origin = {-3, 5, 6};
  ray.direction = normalize(dvec3(2, 0, -1));
  EXPECT_FALSE(below.meets(ray)) << "in under the edge of the ground, down to the level";
  settings.level = 7;
  const Water sea(settings, scene);
  ray.origin.z = 9;
  EXPECT_TRUE(sea.meets(ray)) << "ground just at the level";
}

TEST(Water, FlatSeaAtTheLevelIsWater) {
  const Scene scene = test::terrain(flat(0), "max-mip");
  PictureSettings settings = plain(32, 24);
  settings.water->level = 0;
  const Camera camera = Camera::look_at({4000, 3000, 900}, {4100, 4200, 0}, 40, 32, 24);
  const PictureLayers layers = render_layers(scene, camera, settings);
  const vec3 deep = Water(*settings.water, scene).deep();
  for (int i = 0; i < 32 * 24; ++i) {
    const Ray ray = camera.ray(i % 32 + 0.5, i / 32 + 0.5);
    const double mirror = schlick(-ray.direction.z);
    EXPECT_NEAR(layers.colour[static_cast<std::size_t>(i)].x,
                mirror * sky_at(-ray.direction.z).x + (1 - mirror) * deep.x, 1e-3);
  }
}

// Rounding does not decide between water and ground in its plane.
TEST(Water, VoxelTopsAtTheLevelAreDeepWater) {
  VoxelGrid grid({64, 64, 8}, 24);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return v.z < 4 || (v.x == 0 && v.y == 0) ? VoxelGrid::Voxel(0x60a040) : VoxelGrid::Voxel();
  });
  auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  const Scene scene(scene_voxels({{std::move(model)}, {VoxelPlace{}}}));
  PictureSettings settings = plain(48, 32);
  settings.water->level = 4;
  const Camera camera = Camera::look_at({32.3, 3.1, 15.7}, {33.1, 34.2, 4}, 40, 48, 32);
  const PictureLayers layers = render_layers(scene, camera, settings);
  const vec3 deep = Water(*settings.water, scene).deep();
  int seen = 0;
  for (int i = 0; i < 48 * 32; ++i) {
    const auto pixel = static_cast<std::size_t>(i);
    if (std::abs(layers.position[pixel].z - 4) > 1e-3) continue;
    const Ray ray = camera.ray(i % 48 + 0.5, i / 48 + 0.5);
    const double mirror = schlick(-ray.direction.z);
    ++seen;
    EXPECT_NEAR(layers.colour[pixel].x, mirror * sky_at(-ray.direction.z).x + (1 - mirror) * deep.x, 1e-3) << i;
  }
  EXPECT_GT(seen, 1000);
}

TEST(Water, WavesHaveTheRequestedSlope) {
  const Scene scene = test::terrain(flat(0));
  WaterSettings settings;
  settings.waves = 0.05;
  settings.wavelength = 40;
  const Water water(settings, scene);
  double squares = 0;
  constexpr int kSide = 300;
  for (int i = 0; i < kSide * kSide; ++i) {
    const dvec3 n = water.normal_at({3.7 * (i % kSide), 3.1 * (i / kSide), 0}, 1e-3);
    squares += (n.x * n.x + n.y * n.y) / (n.z * n.z);
  }
  // Over 27 waves of the longest kind in each direction the mean of cos^2 is 1/2 to within 1 / (4 pi 27), twice.
  EXPECT_NEAR(std::sqrt(squares / (kSide * kSide)), 0.05, 0.05 * 0.01);
  EXPECT_EQ(water.normal_at({17, 31, 0}, 1000), dvec3(0, 0, 1)) << "shorter than a pixel";
}

TEST(Water, RejectsValuesOutOfRange) {
  for (const auto& spoil : {+[](WaterSettings& s) { s.level = NAN; }, +[](WaterSettings& s) { s.turbidity = -1; },
                            +[](WaterSettings& s) { s.waves = 0.6; }, +[](WaterSettings& s) { s.wavelength = -1; },
                            +[](WaterSettings& s) { s.srgb.y = 2; }}) {
    WaterSettings settings;
    validate(settings);
    spoil(settings);
    EXPECT_THROW(validate(settings), Error);
  }
  const Scene scene = test::terrain(flat(0), "max-mip");
  PictureSettings settings = plain(8, 8);
  settings.water->level = 500;
  const Camera camera = Camera::look_at({4000, 100, 300}, {4000, 3000, 0}, 50, 8, 8);
  EXPECT_THROW(render_layers(scene, camera, settings), Error) << "the eye is under water";
}

}  // namespace
}  // namespace scarp
