// SPDX-License-Identifier: MIT
#include "scarp/render/look/comanche.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "render/terrain.h"
#include "scarp/base/error.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/look/height_look.h"

namespace scarp {
namespace {

constexpr int kPeriod = 16, kCopies = 13;

std::vector<float> rough() {
  std::mt19937 random(7);
  std::vector<float> samples(kPeriod * kPeriod);
  for (float& sample : samples) sample = static_cast<float>(random() % 4096) / 1024;
  return samples;
}

HeightField endless() {
  HeightFieldSettings settings;
  settings.wrap = Wrap::periodic;
  return HeightField::own(rough(), kPeriod, kPeriod, settings);
}

// The same ground, repeated kCopies times along each axis. Row 0 is the northern one: both fields have the same
// south-west sample.
HeightField tiled() {
  const std::vector<float> tile = rough();
  std::vector<float> samples;
  for (int row = 0; row < kPeriod * kCopies; ++row) {
    for (int col = 0; col < kPeriod * kCopies; ++col) {
      samples.push_back(tile[static_cast<std::size_t>(row % kPeriod * kPeriod + col % kPeriod)]);
    }
  }
  return HeightField::own(std::move(samples), kPeriod * kCopies, kPeriod * kCopies);
}

PictureSettings comanche(int width, int height) {
  PictureSettings settings;
  settings.look = Look::comanche;
  settings.width = width;
  settings.height = height;
  settings.aa = 1;
  settings.shadows = false;
  settings.comanche.scale = 1;
  settings.comanche.steps = 64;
  return settings;
}

TEST(Comanche, WrappedGroundMatchesTheTiledField) {
  for (const char* march : {"max-mip", "fixed-step"}) {
    for (const bool shadows : {false, true}) {
      if (shadows && march == std::string("fixed-step")) continue;
      PictureSettings settings = comanche(96, 72);
      settings.shadows = shadows;
      settings.water = WaterSettings{.level = 1.1, .waves = 0};
      settings.fog.kind = FogKind::distance;
      settings.fog.visibility = 60;
      const Scene wrapped = test::terrain(endless(), march), laid_out = test::terrain(tiled(), march);
      // Six periods from the border of the tiled field, 40 cells of sight and 40 of mirrored sight: no ray reaches it.
      constexpr double kOffset = 6 * kPeriod;
      const dvec3 eye(7.25, 4.5, 6), ahead(0.5, 0.75, -0.25), offset(kOffset, kOffset, 0);
      Camera near = Camera::look_at(eye, eye + ahead, 60, 96, 72);
      Camera far = Camera::look_at(eye + offset, eye + offset + ahead, 60, 96, 72);
      near.set_reach(40);
      far.set_reach(40);
      const Image a = render_picture(wrapped, near, settings).image, b = render_picture(laid_out, far, settings).image;
      int different = 0, ground = 0;
      for (int y = 0; y < 72; ++y) {
        for (int x = 0; x < 96; ++x) {
          ground += static_cast<bool>(laid_out.closest_hit(far.ray(x + 0.5, y + 0.5)));
          for (int c = 0; c < 3; ++c) different += std::abs(a.pixel(x, y)[c] - b.pixel(x, y)[c]) > 1;
        }
      }
      EXPECT_EQ(different, 0) << march;
      EXPECT_GT(ground, 2000) << march;
    }
  }
}

TEST(Comanche, StepsLieOnPlanesOrShells) {
  // Level ground: a sample on or below it is past the ray's intersection.
  HeightFieldSettings field_settings;
  field_settings.wrap = Wrap::periodic;
  const HeightField flat = HeightField::own(std::vector<float>(16, 0.0f), 4, 4, field_settings);
  const Camera camera = Camera::look_at({1, 1, 3}, {1, 9, 0}, 70, 64, 64);
  constexpr double kReach = 64;
  constexpr int kSteps = 40;
  for (const bool shells : {false, true}) {
    for (const bool by_view : {false, true}) {
      ComancheSettings settings{.steps = kSteps, .shells = shells, .step_by_view = by_view, .interpolate = false};
      const StepMarch plain(flat, settings, kReach, camera.forward());
      settings.interpolate = true;
      const StepMarch between(flat, settings, kReach, camera.forward());
      int hits = 0;
      for (int i = 0; i < 64; ++i) {
        const Ray ray = camera.ray(i + 0.5, 63.5 - i / 4);
        const double truth = -ray.origin.z / ray.direction.z;
        double step = kReach / kSteps;
        if (!shells) step /= dot(ray.direction, camera.forward());
        if (by_view) step /= std::max(length(dvec2(ray.direction)), 1 / kLongestStep);
        const StepMarch::Answer first = plain.march(ray, nullptr), line = between.march(ray, nullptr);
        if (!(truth < step * kSteps)) continue;
        ++hits;
        ASSERT_TRUE(first.hit) << i;
        EXPECT_NEAR(first.hit.t / step, std::ceil(truth / step), 1e-9) << shells << by_view;
        EXPECT_NEAR(line.hit.t, truth, 1e-9) << "a straight line between two samples is what level ground is";
        EXPECT_EQ(first.steps, std::ceil(truth / step) + 1);
      }
      EXPECT_GT(hits, 20);
    }
  }
}

TEST(Comanche, PlainWaterShowsAtTheFirstSampleBelow) {
  HeightFieldSettings field_settings;
  field_settings.wrap = Wrap::periodic;
  const HeightField flat = HeightField::own(std::vector<float>(16, -50.0f), 4, 4, field_settings);
  const Scene scene = test::terrain(flat);
  const Water water({.level = -1}, scene);
  const StepMarch plain(flat, {.steps = 100, .shells = true, .interpolate = false}, 100, {0, 1, 0});
  const StepMarch exact(flat, {.steps = 100, .shells = true, .interpolate = true}, 100, {0, 1, 0});
  Ray ray;
  ray.origin = {1, 1, 5.25};
  ray.direction = normalize(dvec3(0, 1, -0.4));
  const double truth = 6.25 / -ray.direction.z;
  const StepMarch::Answer first = plain.march(ray, &water), met = exact.march(ray, &water);
  ASSERT_TRUE(first.water && met.water);
  EXPECT_EQ(first.t, std::ceil(truth));
  EXPECT_DOUBLE_EQ(met.t, truth);
}

TEST(Comanche, UpwardRaysEndAboveTheHighestGround) {
  const HeightField field = endless();
  const StepMarch march(field, {.steps = 1000, .shells = true}, 1000, {0, 1, 0});
  Ray ray;
  ray.origin = {3, 3, 5};  // over the highest ground, below 4
  ray.direction = normalize(dvec3(0, 1, 0.1));
  EXPECT_EQ(march.march(ray, nullptr).steps, 1u);
  ray.origin.z = 3.9;
  EXPECT_LE(march.march(ray, nullptr).steps, 4u) << "0.1 to rise, 0.0995 a step";
}

TEST(Comanche, StepsPictureRangesFromBlackToWhite) {
  const Scene scene = test::terrain(endless(), "fixed-step");
  PictureSettings settings = comanche(48, 36);
  settings.comanche.iterations = true;
  settings.comanche.scale = 3;
  settings.comanche.steps = 30;
  Camera camera = Camera::look_at({3, 3, 8}, {3, 9, 7}, 60, 48, 36);
  camera.set_reach(30);
  const Image image = render_picture(scene, camera, settings).image;
  ASSERT_EQ(image.width, 144);
  ASSERT_EQ(image.height, 108);
  EXPECT_EQ(image.pixel(72, 0)[0], 255) << "sky: all steps";
  EXPECT_LT(image.pixel(72, 107)[0], 200) << "near ground: few steps";
  int white = 0;
  for (int y = 0; y < 108; y += 3) {
    for (int x = 0; x < 144; x += 3) {
      white += image.pixel(x, y)[0] == 255;
      for (int i = 1; i < 9; ++i) {
        EXPECT_TRUE(std::equal(image.pixel(x, y), image.pixel(x, y) + 3, image.pixel(x + i % 3, y + i / 3)));
      }
    }
  }
  EXPECT_GT(white, 20) << "rays that came to the end of their steps";
}

TEST(Comanche, HeightsMatchItsRays) {
  const HeightField field = endless();
  PictureSettings settings = comanche(48, 36);
  settings.comanche.heights = true;
  settings.comanche.interpolate = false;
  settings.comanche.steps = 30;
  settings.comanche.scale = 2;
  Camera camera = Camera::look_at({3, 3, 8}, {3, 9, 6}, 60, 48, 36);
  camera.set_reach(30);
  for (const char* march : {"fixed-step", "max-mip"}) {
    const Scene scene = test::terrain(field, march);
    const bool stepped = march == std::string("fixed-step");
    const StepMarch steps(field, settings.comanche, 30, camera.forward());
    const Image image = render_picture(scene, camera, settings).image;
    ASSERT_EQ(image.width, 96);
    int ground = 0;
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 48; ++x) {
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        const Hit hit = stepped ? steps.march(ray, nullptr).hit : scene.closest_hit(ray);
        const int grey = hit ? grey_of_height(ray.at(hit.t).z, {field.min_height(), field.max_height()}) : 0;
        EXPECT_EQ(image.pixel(2 * x, 2 * y + 1)[1], grey) << march << " " << x << ", " << y;
        ground += grey > 0;
      }
    }
    EXPECT_GT(ground, 400) << march;
  }
}

TEST(Comanche, RejectsValuesOutOfRange) {
  EXPECT_THROW(validate(ComancheSettings{.scale = 0}), Error);
  EXPECT_THROW(validate(ComancheSettings{.scale = 65}), Error);
  EXPECT_THROW(validate(ComancheSettings{.steps = 0}), Error);
  EXPECT_EQ(find_look("comanche"), Look::comanche);
}

}  // namespace
}  // namespace scarp
