// SPDX-License-Identifier: MIT
// Camera rays of pictures, answered by fans: the hits of single rays, to the bit.
#include "scarp/render/film/camera_fan.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "render/terrain.h"
#include "scarp/render/film/tile_work.h"

namespace scarp {
namespace {

HeightField hills(bool hole) {
  const int cols = 240, rows = 200;
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const bool none = hole && std::hypot(col - 120, row - 90) < 20;
      samples.push_back(none ? std::numeric_limits<float>::quiet_NaN()
                             : static_cast<float>(9 * std::sin(0.1 * col) * std::cos(0.13 * row) + 0.05 * col));
    }
  }
  return HeightField::own(std::move(samples), cols, rows);
}

// Queries the rays of a tile and compares the hits with those of single rays.
class Compared final : public TileWork {
 public:
  Compared(const Scene& scene, const Camera& camera, const PixelTile& tile, int aa, const CameraSights* sights,
           std::atomic<int>& seen, std::atomic<int>& wrong)
      : scene_(scene), sights_(sights), tile_(tile), seen_(seen), wrong_(wrong) {
    for (const PicturePoint& point : points_of(tile, aa)) rays_.push_back(camera.ray(point.x, point.y));
  }
  bool next(RayRound& round) override {
    if (!asked_) {
      asked_ = true;
      round.rays = rays_;
      if (sights_) sights_->of(tile_, round.sights);
      return true;
    }
    for (std::size_t i = 0; i < rays_.size(); ++i) wrong_ += round.hits[i] != scene_.closest_hit(rays_[i]);
    if (sights_) seen_ += static_cast<int>(rays_.size());
    return false;
  }

 private:
  const Scene& scene_;
  const CameraSights* sights_;
  PixelTile tile_;
  std::atomic<int>&seen_, &wrong_;
  std::vector<Ray> rays_;
  bool asked_ = false;
};

TEST(CameraFan, HitsMatchSingleRays) {
  for (const bool hole : {false, true}) {
    const HeightField field = hills(hole);
    for (const bool plinth : {false, true}) {
      const Scene scene = plinth ? test::terrain_on_plinth(field) : test::terrain(field);
      for (const dvec3 target : {dvec3(150, 160, 0), dvec3(60, 30.5, -40), dvec3(30, 30.01, -9)}) {
        for (const int aa : {1, 3}) {
          const int width = 75, height = 61;
          Camera camera = Camera::look_at({30, 30, 45}, target, 60, width, height);
          if (aa == 3) camera.set_reach(80);
          std::atomic<int> seen = 0, wrong = 0;
          work_on_camera_tiles(scene, camera, width, height, aa, 1024,
                               [&](const PixelTile& tile, const CameraSights* sights) {
                                 return std::make_unique<Compared>(scene, camera, tile, aa, sights, seen, wrong);
                               },
                               {});
          EXPECT_EQ(wrong, 0) << "hole " << hole << ", plinth " << plinth << ", aa " << aa;
          EXPECT_EQ(seen, width * height * aa * aa);
        }
      }
    }
  }
}

TEST(CameraFan, PaysOnlyInPerspectiveAboveHeightsWithMaxMip) {
  const HeightField field = hills(false);
  const Scene scene = test::terrain(field);
  const Camera camera = Camera::look_at({30, 30, 45}, {90, 90, 0}, 60, 64, 64);
  EXPECT_TRUE(CameraFan(scene, camera, 64, 1).pays());
  EXPECT_FALSE(CameraFan(scene, camera, 8, 1).pays());
  EXPECT_FALSE(CameraFan(scene, Camera::top(scene.box(), 64, 64), 64, 1).pays());
  EXPECT_FALSE(CameraFan(scene, Camera::look_at({30, 30, -45}, {90, 90, 0}, 60, 64, 64), 64, 1).pays());
  const Scene other = test::terrain(field, "exhaustive");
  EXPECT_FALSE(CameraFan(other, camera, 64, 1).pays());
}

}  // namespace
}  // namespace scarp
