// SPDX-License-Identifier: MIT
// Work in rounds, against a scene on a fake device, which derives its answer from the ray itself.
#include "scarp/render/film/tile_work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "render/terrain.h"
#include "scarp/base/error.h"
#include "scarp/scene/scene_back_end.h"

namespace scarp {
namespace {

// A hit has the ray's t_max as t, and twice as many steps; rays with an odd t_max are blocked.
class Echo final : public SceneBackEnd {
 public:
  void closest_hits(std::uint32_t, std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const>) override {
    most = std::max(most, rays.size());
    ++batches;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      hits[i].t = rays[i].t_max;
      if (!steps.empty()) steps[i] = static_cast<std::uint32_t>(2 * rays[i].t_max);
    }
  }
  void occluded(std::uint32_t, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const>) override {
    most = std::max(most, rays.size());
    ++batches;
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = std::fmod(rays[i].t_max, 2) == 1;
  }

  std::size_t most = 0;
  int batches = 0;
};

// The tile's column and row determine the number of rounds. The rounds alternate between the three queries, with
// different numbers of rays; counts correct answers.
class Curious final : public TileWork {
 public:
  Curious(const PixelTile& tile, std::size_t most_rays, std::atomic<std::int64_t>& right)
      : left_(1 + (tile.x0 + tile.y0) / 16 % 5), seed_(tile.x0 * 7 + tile.y0), most_(most_rays), right_(right) {}

  bool next(RayRound& round) override {
    if (asked_) check(round);
    if (left_-- == 0) return false;
    asked_ = true;
    round.question = static_cast<RayRound::Question>((left_ + seed_) % 3);
    round.rays.assign(1 + static_cast<std::size_t>(seed_ * (left_ + 1)) % most_, {});
    for (std::size_t i = 0; i < round.rays.size(); ++i) round.rays[i].t_max = seed_ + static_cast<double>(i);
    return true;
  }

 private:
  void check(const RayRound& round) {
    for (std::size_t i = 0; i < round.rays.size(); ++i) {
      const double t = round.rays[i].t_max;
      bool good = true;
      if (round.question == RayRound::Question::any) {
        good = round.blocked.at(i) == (std::fmod(t, 2) == 1);
      } else {
        good = round.hits.at(i).t == t;
        if (round.question == RayRound::Question::closest_cost) good &= round.steps.at(i) == 2 * t;
      }
      right_ += good ? 1 : -1'000'000'000;
    }
  }

  int left_, seed_;
  std::size_t most_;
  std::atomic<std::int64_t>& right_;
  bool asked_ = false;
};

Scene echo_scene(const std::shared_ptr<Echo>& echo) {
  return test::terrain(HeightField::own(std::vector<float>(4), 2, 2)).answered_by(echo);
}

TEST(TileWork, TilesShareDeviceBatches) {
  const auto echo = std::make_shared<Echo>();
  const PixelTiles tiles(700, 500, 2);
  std::atomic<std::int64_t> right{0};
  std::vector<double> shares;
  work_on_tiles(
      echo_scene(echo), tiles, kMostRaysOfRound,
      [&](const PixelTile& tile) { return std::make_unique<Curious>(tile, kMostRaysOfRound, right); },
      [&](double share) {
        shares.push_back(share);
        return true;
      });
  EXPECT_GT(right, 1'000'000);
  EXPECT_GT(echo->most, kMostRaysOfRound);
  EXPECT_LE(echo->most, std::size_t{1} << 18);
  EXPECT_LT(echo->batches, tiles.count());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
}

TEST(TileWork, StopsOnRequest) {
  const Scene on_cpu = test::terrain(HeightField::own(std::vector<float>(4), 2, 2), "max-mip");
  const auto echo = std::make_shared<Echo>();
  for (const Scene& scene : {on_cpu, echo_scene(echo)}) {
    std::atomic<int> made{0};
    std::atomic<std::int64_t> right{0};
    const PixelTiles tiles(1600, 1600, 1);
    EXPECT_THROW(work_on_tiles(
                     scene, tiles, 256,
                     [&](const PixelTile& tile) {
                       ++made;
                       return std::make_unique<Curious>(tile, 1, right);
                     },
                     [](double) { return false; }),
                 Interrupted);
    EXPECT_LT(made, tiles.count());
  }
}

}  // namespace
}  // namespace scarp
