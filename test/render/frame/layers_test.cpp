// SPDX-License-Identifier: MIT
#include "scarp/render/frame/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "render/terrain.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr int kWidth = 48, kHeight = 32;

// 33 x 33 nodes, 1 m apart, on the plane z = 7 + x / 4 - y / 2.
HeightField plane() {
  std::vector<float> samples;
  for (int row = 0; row < 33; ++row) {
    for (int col = 0; col < 33; ++col) {
      samples.push_back(7 + 0.25f * static_cast<float>(col) - 0.5f * static_cast<float>(32 - row));
    }
  }
  return HeightField::own(std::move(samples), 33, 33);
}

PictureSettings small() {
  PictureSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  return settings;
}

TEST(Layers, ReportThePixelCentreOnAPlane) {
  const Scene scene = test::terrain(plane(), "max-mip");
  const dvec3 normal = normalize(dvec3(-0.25, 0.5, 1));
  for (const Camera& camera : {Camera::look_at({10, 60, 40}, {16, 16, 3}, 40, kWidth, kHeight),
                               Camera::top(picture_box(scene), kWidth, kHeight)}) {
    const PictureLayers layers = render_layers(scene, camera, small());
    int hits = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        const double t = dot(dvec3(0, 0, 7) - ray.origin, normal) / dot(ray.direction, normal);
        const dvec3 p = ray.at(t);
        MarchStats stats;
        scene.closest_hit(ray, nullptr, &stats);
        EXPECT_EQ(layers.steps[i], stats.steps);
        if (p.x < 0 || p.x > 32 || p.y < 0 || p.y > 32) {
          EXPECT_EQ(layers.depth[i], std::numeric_limits<float>::infinity());
          EXPECT_EQ(layers.normal[i], vec3(0));
          EXPECT_EQ(layers.position[i], vec3(0));
          continue;
        }
        ++hits;
        // One rounding to float each.
        const auto near = [](float value, double expected) {
          return std::abs(value - expected) <= 1e-12 + std::abs(expected) * std::numeric_limits<float>::epsilon() / 2;
        };
        EXPECT_TRUE(near(layers.depth[i], t * dot(ray.direction, camera.forward()))) << x << ", " << y;
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_TRUE(near(layers.position[i][axis], p[axis])) << x << ", " << y << ": " << p[axis];
          EXPECT_TRUE(near(layers.normal[i][axis], normal[axis])) << x << ", " << y;
        }
      }
    }
    EXPECT_GT(hits, kWidth * kHeight / 4);
    EXPECT_LT(hits, kWidth * kHeight) << "some rays miss";
  }
}

TEST(Layers, ColourIsThePictureBeforeTheTransferCurve) {
  const Scene scene = test::terrain_on_plinth(plane());
  PictureSettings settings = small();
  settings.samples = 4;
  const Camera camera = Camera::framed(picture_box(scene), {}, 0, kWidth, kHeight);
  const PictureLayers layers = render_layers(scene, camera, settings);
  const Image image = render_picture(scene, camera, settings).image;
  Image developed(kWidth, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i) {
    set_pixel(developed, i % kWidth, i / kWidth, toned(layers.colour[static_cast<std::size_t>(i)]));
  }
  EXPECT_EQ(developed.rgb, image.rgb);
}

TEST(Layers, PlinthWallsCountAsHits) {
  const Scene scene = test::terrain_on_plinth(plane());
  PictureSettings settings = small();
  // Level, from the south, below the ground's border: the wall at y = 0.
  const Camera camera = Camera::look_at({16, -20, 2}, {16, 0, 2}, 2, kWidth, kHeight);
  const PictureLayers layers = render_layers(scene, camera, settings);
  for (std::size_t i = 0; i < layers.depth.size(); ++i) {
    EXPECT_FLOAT_EQ(layers.depth[i], 20);
    EXPECT_EQ(layers.normal[i], vec3(0, -1, 0));
    EXPECT_NEAR(layers.position[i].y, 0, 1e-6);
  }
}

TEST(Layers, SolidWallsAreNotSurfaces) {
  HeightFieldSettings solid;
  solid.solid = true;
  std::vector<float> samples(33 * 33);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = 7 + static_cast<float>(i % 33 % 3);
  const HeightField field = HeightField::own(std::move(samples), 33, 33, solid);
  // Level, from the south, below the ground's border: the wall at y = 0.
  const Camera camera = Camera::look_at({16, -20, 6.6}, {16, 0, 6.6}, 2, kWidth, kHeight);
  PictureSettings settings = small();
  settings.haze = 0;  // haze depends on the size of the plinth
  const PictureLayers layers = render_layers(test::terrain(field), camera, settings);
  const PictureLayers on_plinth = render_layers(test::terrain_on_plinth(field), camera, settings);
  for (std::size_t i = 0; i < layers.depth.size(); ++i) {
    EXPECT_FLOAT_EQ(layers.depth[i], 20);
    EXPECT_EQ(layers.normal[i], vec3(0, -1, 0));
    EXPECT_EQ(layers.colour[i], on_plinth.colour[i]) << "that of the plinth's wall";
  }
}

TEST(Layers, ApplyOnlyToTheShadedLook) {
  const Scene scene = test::terrain(plane(), "max-mip");
  const Camera camera = Camera::top(picture_box(scene), kWidth, kHeight);
  for (const Look look : {Look::height, Look::steps, Look::error}) {
    PictureSettings settings = small();
    settings.look = look;
    EXPECT_THROW(render_layers(scene, camera, settings), Error);
  }
  PictureSettings settings = small();
  settings.samples = -1;
  EXPECT_THROW(render_layers(scene, camera, settings), Error);
  EXPECT_THROW(render_layers(scene, camera, small(), [](double) { return false; }), Interrupted);
}

}  // namespace
}  // namespace scarp
