// SPDX-License-Identifier: MIT
#include "scarp/render/film/middles.h"

#include <memory>

namespace scarp {
namespace {

class MiddlesTile final : public TileWork {
 public:
  MiddlesTile(const Camera& camera, const PixelTile& tile, const CameraSights* sights, int width, bool count,
              const TakeMiddle& take, const TraceMiddles& trace)
      : camera_(camera), tile_(tile), sights_(sights), width_(width), count_(count), take_(take), trace_(trace) {}

  bool next(RayRound& round) override {
    if (!asked_) {
      asked_ = true;
      round.question = count_ ? RayRound::Question::closest_cost : RayRound::Question::closest;
      round.rays = rays_through_middles(camera_, tile_);
      if (sights_ && !count_) sights_->of(tile_, round.sights);
      round.from.clear();
      if (!trace_) return true;
      trace_(round);
    }
    std::size_t i = 0;
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      for (int x = tile_.x0; x < tile_.x1; ++x, ++i) {
        const auto pixel = static_cast<std::size_t>(std::int64_t{y} * width_ + x);
        take_(pixel, round.rays[i], round.hits[i], count_ ? round.steps[i] : 0);
      }
    }
    return false;
  }

 private:
  const Camera& camera_;
  PixelTile tile_;
  const CameraSights* sights_;
  int width_;
  bool count_, asked_ = false;
  const TakeMiddle& take_;
  const TraceMiddles& trace_;
};

}  // namespace

std::vector<Ray> rays_through_middles(const Camera& camera, const PixelTile& tile) {
  std::vector<Ray> rays;
  rays.reserve(tile.pixels());
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) rays.push_back(camera.ray(x + 0.5, y + 0.5));
  }
  return rays;
}

void look_through_middles(const Scene& scene, const Camera& camera, ImageSize size, bool count,
                          const Progress& progress, const TakeMiddle& take, const TraceMiddles& trace) {
  const std::size_t most_rays = PixelTiles(size.width, size.height, 1)[0].pixels();
  const auto make = [&](const PixelTile& tile, const CameraSights* sights) {
    return std::make_unique<MiddlesTile>(camera, tile, sights, size.width, count, take, trace);
  };
  if (count || trace) {
    return work_on_tiles(
        scene, PixelTiles(size.width, size.height, 1), most_rays,
        [&](const PixelTile& tile) { return make(tile, nullptr); }, progress);
  }
  work_on_camera_tiles(scene, camera, size.width, size.height, 1, most_rays, make, progress);
}

}  // namespace scarp
