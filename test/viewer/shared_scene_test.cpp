// SPDX-License-Identifier: MIT
// One scene for two threads, as in the window: the worker renders it, with coarser voxels, and the window's thread
// queries the point under the cursor. Also run under the thread sanitizer.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <thread>
#include <vector>

#include "app/viewer/picture_worker.h"
#include "scarp/base/error.h"
#include "scarp/scarp.h"

namespace scarp::viewer {
namespace {

using namespace std::chrono_literals;

// Waves of 64 x 64 m, a block of voxels on them.
Scene ground_and_voxels() {
  constexpr int kSide = 65;
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col)
      samples.push_back(static_cast<float>(4 * std::sin(0.2 * col) * std::cos(0.3 * row)));
  }
  const Terrain terrain = Terrain::own(std::move(samples), kSide, kSide);
  VoxelGrid grid(ivec3(16), 8);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return (v.x + v.y + v.z) % 3 != 0 ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  const Scene ground(terrain);
  std::vector<SceneFieldPtr> fields = ground.fields();
  std::vector<SceneObject> objects = ground.objects();
  const auto add = [&](SceneFieldPtr field, const dvec3& at, double scale) {
    fields.push_back(std::move(field));
    objects.push_back({static_cast<std::uint32_t>(fields.size() - 1), 0, {glm::dmat3(1.0), scale, at}});
  };
  const auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  VoxelShading smooth;
  smooth.normals = VoxelNormals::smooth;
  add(scene_voxels({{model}, {VoxelPlace{}}}, smooth), {20, 20, 3}, 0.5);
  return {fields, objects};
}

Picture render(const Scene& given, const Camera& camera, const PictureSettings& settings, const Progress& progress) {
  const Scene seen = given.coarser(
      {camera.eye(), camera.forward(), [&](double depth) { return camera.pixel_width(depth) / settings.aa; }});
  return render_picture(seen, camera, settings, progress);
}

ViewRequest request_from(const Scene& scene, double turn, bool moving) {
  PictureSettings settings;
  settings.width = 96, settings.height = 64;
  settings.aa = 2, settings.samples = 2;
  return {[turn](int width, int height) {
            return Camera::look_at({32 + 60 * std::cos(turn), 32 + 60 * std::sin(turn), 30}, {28, 28, 4}, 40, width,
                                   height);
          },
          {{settings, [&scene](const Camera& camera, const PictureSettings& asked,
                               const Progress& progress) { return render(scene, camera, asked, progress); }}},
          moving};
}

TEST(SharedScene, CanBeQueriedWhileRendering) {
  const Scene scene = ground_and_voxels();
  PictureWorker worker([] {});
  constexpr int kRequests = 60;
  int pictures = 0, read = 0;
  for (int i = 0; i < kRequests; ++i) {
    const ViewRequest request = request_from(scene, 0.05 * i, i % 4 != 3);
    const Camera camera = request.camera(96, 64);
    worker.request(request);
    // Reads until there is a picture, so that the threads run concurrently.
    for (int k = 0; k < 1000; ++k) {
      const Ray ray = camera.ray((17 * k) % 96, (29 * k) % 64);
      const Hit hit = scene.closest_hit(ray);
      if (hit) {
        const SceneSurface surface = scene.surface(ray, hit);
        Ray up;
        up.origin = surface.position + dvec3(0, 0, 2);
        up.direction = {0.3, 0.2, 1};
        read += !scene.occluded(up) && scene.height(surface.position.x, surface.position.y).has_value();
      }
      if (const auto worked = worker.take()) {
        EXPECT_EQ(worked->error, "");
        ++pictures;
        break;
      }
    }
  }
  EXPECT_GT(pictures, 0);
  EXPECT_GT(read, 0);
  // The last picture equals that of a separate rendering.
  const ViewRequest last = request_from(scene, 1, false);
  const std::uint64_t generation = worker.request(last);
  std::optional<WorkedPicture> worked;
  for (int i = 0; i < 60'000; ++i) {
    worked = worker.take();
    if (worked && worked->generation == generation && worked->pass == PicturePass::converged) break;
    std::this_thread::sleep_for(1ms);
  }
  ASSERT_TRUE(worked);
  const Picture alone = render(scene, last.camera(96, 64), last.sides.front().settings, [](double) { return true; });
  EXPECT_TRUE(worked->sides.front().image.rgb == alone.image.rgb);
}

}  // namespace
}  // namespace scarp::viewer
