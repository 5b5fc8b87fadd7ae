// SPDX-License-Identifier: MIT
// render() of scarp.h: the pictures of its parts, and errors.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "output/read_png.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp {
namespace {

using test::refusal;

const std::string kPath = testing::TempDir() + "render_test.png";
const PictureSettings kSmall{.width = 60, .height = 40};

Terrain waves(Wrap wrap = Wrap::none) {
  std::vector<float> samples;
  for (int i = 0; i < 400; ++i)
    samples.push_back(static_cast<float>(2 * std::sin(0.4 * (i % 20)) * std::cos(0.3 * (i / 20))));
  return Terrain::own(std::move(samples), 20, 20, {.wrap = wrap});
}

TEST(Render, DrawsTerrainOnItsPlinth) {
  const Terrain terrain = waves();
  render(terrain, kPath, kSmall, {.azimuth_deg = 120});
  const Scene scene = with_plinth(terrain);
  const Camera camera =
      view_of_field(terrain.field(), picture_box(scene), {.azimuth_deg = 120}, 0, kSmall.width, kSmall.height).camera;
  EXPECT_EQ(test::read_png(kPath).bytes, render_picture(scene, camera, kSmall).image.rgb);
  // The plinth is not added twice.
  render(scene, kPath, kSmall, {.azimuth_deg = 120});
  EXPECT_EQ(test::read_png(kPath).bytes, render_picture(scene, camera, kSmall).image.rgb);
}

TEST(Render, FramesAnyScene) {
  VoxelGrid grid({4, 4, 4});
  grid.fill(grid.box(), 1);
  const Scene scene = combine({{waves()}, {Voxels(std::move(grid)), {.origin = {8, 8, 1}}}});
  render(scene, kPath, kSmall, {});
  const Camera camera = Camera::framed(picture_box(scene), {}, 0, kSmall.width, kSmall.height);
  EXPECT_EQ(test::read_png(kPath).bytes, render_picture(scene, camera, kSmall).image.rgb);
}

TEST(Render, RejectsInvalidScenesAndFiles) {
  const Terrain terrain = waves();
  std::filesystem::remove(kPath);
  EXPECT_NE(refusal([&] { render(waves(Wrap::periodic), kPath); }), "");
  const float sample = 1;
  EXPECT_EQ(refusal([&] { render(Terrain::view(&sample, 1, 1), kPath); }),
            "picture: the field has 1 x 1 samples and so no cells (at least 2 x 2 are needed)");
  EXPECT_NE(refusal([&] { render(terrain, kPath, {.width = 0}, {}); }), "");
  EXPECT_NE(refusal([&] { render(terrain, kPath, {}, {.fov_deg = NAN}); }), "");
  EXPECT_FALSE(std::filesystem::exists(kPath));
  for (const std::string& path : {testing::TempDir(), testing::TempDir() + "missing/a.png", std::string()}) {
    const std::string message = refusal([&] { render(terrain, path); });
    EXPECT_NE(message, "");
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace scarp
