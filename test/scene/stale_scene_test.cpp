// SPDX-License-Identifier: MIT
// Fields edited under a scene: the scene throws instead of returning answers for the former field.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "base/refusal.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp {
namespace {

using test::refusal;

constexpr int kSide = 17;
const Ray kOverHill{.origin = {-1, 8, 50}, .direction = {1, 0, 0}};

Terrain flat() { return Terrain::own(std::vector<float>(kSide * kSide, 1.0f), kSide, kSide); }

void raise_hill(Terrain& terrain) {
  const std::vector<float> hill(9, 100.0f);
  terrain.set_samples({7, 7, 3, 3}, hill.data());
}

// Enough fields that some of them are found only by the hierarchy.
std::vector<ScenePart> with_grounds_around(const Scene& part) {
  std::vector<ScenePart> parts{{part}};
  for (int i = 1; i < 6; ++i) parts.push_back({flat(), {.scale = 2, .origin = {100.0 * i, 0, 0}}});
  return parts;
}

TEST(StaleScene, IsReportedAfterSampleEdits) {
  Terrain terrain = flat();
  const Scene scene = combine(with_grounds_around(terrain));
  EXPECT_FALSE(cast(scene, kOverHill));
  raise_hill(terrain);
  EXPECT_TRUE(cast(terrain, kOverHill));
  const std::string message =
      "scene: field 0 (heights) was edited after the scene was built (build the scene again, or edit in "
      "LiveScene::edit())";
  EXPECT_EQ(refusal([&] { cast(scene, kOverHill); }), message);
  EXPECT_EQ(refusal([&] { occluded(scene, kOverHill); }), message);
  std::vector<Hit> hits(1);
  std::vector<std::uint8_t> blocked(1);
  EXPECT_EQ(refusal([&] { scene.closest_hits({&kOverHill, 1}, hits); }), message);
  EXPECT_EQ(refusal([&] { scene.occluded({&kOverHill, 1}, blocked); }), message);
  // A copy is as old as its original; a new scene is not.
  const Scene copy = scene;
  EXPECT_EQ(refusal([&] { cast(copy, kOverHill); }), message);
  EXPECT_TRUE(cast(combine(with_grounds_around(terrain)), kOverHill));
}

TEST(StaleScene, IsReportedAfterVoxelEdits) {
  VoxelGrid grid({32, 32, 32});
  grid.fill({{0, 0, 0}, {32, 32, 2}}, 1);
  Voxels voxels(std::move(grid));
  const Scene scene = combine({{voxels}, {flat(), {.origin = {100, 0, 0}}}});
  const Ray ray{.origin = {-1, 8.5, 20.5}, .direction = {1, 0, 0}};
  EXPECT_FALSE(cast(scene, ray));
  voxels.edit([](VoxelGrid& g) { return g.fill({{4, 4, 4}, {12, 12, 24}}, 2); });
  EXPECT_TRUE(cast(voxels, ray));
  EXPECT_NE(refusal([&] { cast(scene, ray); }).find("field 0 (voxels) was edited"), std::string::npos);
  // The field itself still has its former box.
  EXPECT_EQ(refusal([&] { Scene(scene.fields()[0]); }),
            "scene: field 0 (voxels) was edited after it was built (build the field again)");
  EXPECT_TRUE(cast(combine({{voxels}}), ray));
}

TEST(StaleScene, IsReportedWhenItsPyramidIsOld) {
  HeightField field = HeightField::own(std::vector<float>(kSide * kSide, 1.0f), kSide, kSide);
  const SceneFieldPtr heights = scene_heights(field);
  const Scene scene(heights);
  EXPECT_FALSE(cast(scene, kOverHill));
  const float hill = 100;
  field.set_samples({8, 8, 1, 1}, &hill, 1);
  EXPECT_NE(refusal([&] { cast(scene, kOverHill); }), "");
  EXPECT_NE(refusal([&] { Scene{heights}; }).find("build the field again"), std::string::npos);
  EXPECT_TRUE(cast(Scene(scene_heights(field)), kOverHill));
}

TEST(StaleScene, IsReportedWhenItsPlinthIsOld) {
  Terrain terrain = flat();
  const Scene scene = with_plinth(terrain);
  raise_hill(terrain);
  EXPECT_NE(refusal([&] { cast(scene, kOverHill); }), "");
  EXPECT_NE(refusal([&] { Scene{scene.fields()[1]}; }).find("(plinth)"), std::string::npos);
}

TEST(StaleScene, IsReportedWhenItsMemoryWasFreed) {
  auto samples = std::make_shared<std::vector<float>>(kSide * kSide, 1.0f);
  const Terrain terrain = Terrain::view(samples->data(), kSide, kSide, {}, 0, samples);
  const Scene scene = combine(with_grounds_around(terrain));
  const Ray down{.origin = {8, 8, 50}, .direction = {0, 0, -1}};
  EXPECT_TRUE(cast(scene, down));
  samples.reset();
  const std::string message =
      "scene: field 0 (heights): the memory of its samples was freed (keep it as long as its scenes)";
  EXPECT_EQ(refusal([&] { cast(scene, down); }), message);
  EXPECT_EQ(refusal([&] { occluded(terrain, down); }), message);
}

TEST(StaleScene, IsNotCausedByEditsOfOtherFields) {
  Terrain terrain = flat(), other = flat();
  const Scene scene = combine(with_grounds_around(terrain));
  raise_hill(other);
  EXPECT_FALSE(cast(scene, kOverHill));
  EXPECT_TRUE(cast(other, kOverHill));
}

}  // namespace
}  // namespace scarp
