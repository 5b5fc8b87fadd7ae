// SPDX-License-Identifier: MIT
// Every look and every part of the environment works with every kind of scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cases.h"
#include "render/terrain.h"
#include "scarp/field/function_node.h"
#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/picture.h"

namespace scarp {
namespace {

// Judges of functions take milliseconds per ray, and a hundred times that under sanitizers.
const int kWidth = test::cases(64, 64, 20), kHeight = test::cases(48, 48, 15);
constexpr int kCells = 32;

// A round hill on 32 m x 32 m, 12 m high.
double hill(double x, double y) { return 12 * std::exp(-((x - 16) * (x - 16) + (y - 16) * (y - 16)) / 60); }

Scene heights() {
  std::vector<float> samples;
  for (int row = 0; row <= kCells; ++row) {
    for (int col = 0; col <= kCells; ++col) samples.push_back(static_cast<float>(hill(col, kCells - row)));
  }
  return test::terrain(HeightField::own(std::move(samples), kCells + 1, kCells + 1));
}

Scene voxels() {
  VoxelGrid grid({kCells, kCells, 16}, 24);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return v.z + 0.5 <= 1 + hill(v.x + 0.5, v.y + 0.5) ? VoxelGrid::Voxel(0x60a040) : VoxelGrid::Voxel();
  });
  auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  return Scene(scene_voxels({{std::move(model)}, {VoxelPlace{}}}));
}

Scene function() {
  return Scene(
      scene_function(HeightFunction(make_function(Fractal{.wavelength = 24, .height = 12, .octaves = {3, 3, 4}}))));
}

// A ball that is half below the ground.
Scene shape() {
  return Scene({scene_shape(DistanceField(make_shape(shape::Sphere{.radius = 9})))},
               {{.placement = {.origin = {16, 16, 2}}}});
}

Scene terrain_with_a_ball() {
  const Scene ground = with_plinth(heights());
  std::vector<SceneFieldPtr> fields = ground.fields();
  std::vector<SceneObject> objects = ground.objects();
  objects.push_back({.field = static_cast<std::uint32_t>(fields.size()), .placement = {.origin = {8, 8, 6}}});
  fields.push_back(scene_shape(DistanceField(make_shape(shape::Sphere{.radius = 3}))));
  return {std::move(fields), std::move(objects)};
}

struct Kind {
  std::string name;
  Scene (*make)();
};

class EveryInput : public testing::TestWithParam<Kind> {
 protected:
  static PictureSettings settings() {
    PictureSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.aa = 1;
    settings.haze = 0;
    return settings;
  }
  static Camera camera() {
    Camera camera = Camera::look_at({16, -22, 26}, {16, 14, 3}, 45, kWidth, kHeight);
    camera.set_reach(1000);
    return camera;
  }
};

// Pixels whose colour differs from that of most.
int varied(const Image& image) {
  int count = 0;
  for (int i = 0; i < image.width * image.height; ++i)
    count += !std::equal(image.rgb.begin(), image.rgb.begin() + 3, image.rgb.begin() + 3 * i);
  return count;
}

TEST_P(EveryInput, SupportsEveryLook) {
  const Scene scene = GetParam().make();
  for (const Look look : {Look::shaded, Look::height, Look::steps, Look::cost, Look::error, Look::comanche}) {
    PictureSettings with = settings();
    with.look = look;
    with.comanche.scale = 2;
    const Picture picture = render_picture(scene, camera(), with);
    EXPECT_EQ(picture.image.width, look == Look::comanche ? 2 * kWidth : kWidth);
    EXPECT_GT(varied(picture.image), kWidth * kHeight / 8) << name_of(look);
    EXPECT_EQ(picture.steps.has_value(), look == Look::steps);
    EXPECT_EQ(picture.cost.has_value(), look == Look::cost);
    EXPECT_EQ(picture.errors.has_value(), look == Look::error);
  }
}

TEST_P(EveryInput, HasNoErrorsWithExactMarches) {
  PictureSettings with = settings();
  with.look = Look::error;
  const ErrorCounts errors = render_picture(GetParam().make(), camera(), with).errors.value();
  EXPECT_GT(errors[Verdict::right_hit], kWidth * kHeight / 11) << errors.judges;
  for (const Verdict wrong : {Verdict::lost, Verdict::false_hit, Verdict::early, Verdict::late, Verdict::gave_up})
    EXPECT_EQ(errors[wrong], 0) << name_of(wrong) << ", judged by " << errors.judges;
  EXPECT_EQ(errors.contradictions, 0);
}

// Ground below the level is under water, whose surface is visible; ground above it does not change.
TEST_P(EveryInput, SupportsWater) {
  constexpr double kWater = 3.25;  // between two faces of voxels
  const Scene scene = GetParam().make();
  PictureSettings dry = settings(), wet = settings();
  dry.shadows = wet.shadows = false;
  wet.water.emplace();
  wet.water->level = kWater;
  wet.water->waves = 0;
  const PictureLayers before = render_layers(scene, camera(), dry), after = render_layers(scene, camera(), wet);
  int flooded = 0, above = 0;
  for (std::size_t i = 0; i < before.depth.size(); ++i) {
    const bool hit = std::isfinite(before.depth[i]), in_box = std::isfinite(after.depth[i]);
    if (in_box && after.normal[i].z == 1 && std::abs(after.position[i].z - kWater) < 1e-4) {
      ++flooded;
      EXPECT_TRUE(!hit || before.position[i].z <= kWater + 1e-4);
      EXPECT_NE(before.colour[i], after.colour[i]);
    } else if (hit && before.position[i].z > kWater + 0.1) {
      ++above;
      // Marches that converge to a surface stop at a different point, within their tolerance, if a ray ends at the
      // water.
      EXPECT_LT(length(before.colour[i] - after.colour[i]), 1e-3);
    }
  }
  EXPECT_GT(flooded, kWidth * kHeight / 200);
  EXPECT_GT(above, kWidth * kHeight / 200);
}

TEST_P(EveryInput, SupportsFogAndHaze) {
  const Scene scene = GetParam().make();
  const PictureLayers clear = render_layers(scene, camera(), settings());
  for (const FogKind kind : {FogKind::none, FogKind::distance, FogKind::height}) {
    PictureSettings with = settings();
    with.fog.kind = kind;
    with.fog.visibility = 60;
    with.fog.falloff = 20;
    if (kind == FogKind::none) with.haze_distance = 60;
    const PictureLayers layers = render_layers(scene, camera(), with);
    for (std::size_t i = 0; i < layers.depth.size(); ++i) {
      if (std::isfinite(layers.depth[i])) {
        EXPECT_NE(layers.colour[i], clear.colour[i]) << name_of(kind);
      }
    }
  }
}

TEST_P(EveryInput, SupportsGroundPaintOnTop) {
  const Scene scene = GetParam().make();
  const Image plain = render_picture(scene, camera(), settings()).image;
  std::vector<std::function<void(PictureSettings&)>> changes = {
      [](PictureSettings& s) { s.ground.detail = 1; }, [](PictureSettings& s) { s.ground.natural = true; },
      [](PictureSettings& s) {
        s.ground.drape = std::make_shared<Drape>(Drape{1, 1, {200, 0, 0, 255}});
      }};
  // Level faces have no contour lines, and vertical faces have too many, which fade.
  if (GetParam().name != "voxels") changes.emplace_back([](PictureSettings& s) { s.ground.contours = 2; });
  for (const auto& change : changes) {
    PictureSettings with = settings();
    change(with);
    const Image painted = render_picture(scene, camera(), with).image;
    int different = 0;
    for (std::size_t i = 0; i < plain.rgb.size(); ++i) different += plain.rgb[i] != painted.rgb[i];
    EXPECT_GT(different, kWidth * kHeight / 31);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryInput,
                         testing::Values(Kind{"heights", heights}, Kind{"voxels", voxels}, Kind{"function", function},
                                         Kind{"shape", shape}, Kind{"terrain_with_a_ball", terrain_with_a_ball}),
                         [](const auto& kind) { return kind.param.name; });

// Only a plinth is visible.
TEST(PlinthInScene, CastsNoShadowAndIsNotGround) {
  const Scene bare = heights(), scene = with_plinth(bare);
  EXPECT_LT(scene.box().low.z, bare.box().low.z);
  EXPECT_EQ(scene.height(16, 16), bare.height(16, 16));
  EXPECT_EQ(scene.only_heights()->max_height(), bare.only_heights()->max_height());
  EXPECT_EQ(scene.marches(), bare.marches());
  Ray ray;
  ray.origin = {16, -5, -0.1};
  ray.direction = {0, 1, 0};
  EXPECT_FALSE(bare.closest_hit(ray));
  const Hit hit = scene.closest_hit(ray);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit.wall);
  EXPECT_EQ(hit.t, 5);
  EXPECT_EQ(scene.surface(ray, hit).normal, dvec3(0, -1, 0));
  EXPECT_FALSE(scene.occluded(ray));
}

}  // namespace
}  // namespace scarp
