// SPDX-License-Identifier: MIT
#include "scarp/scene/terrain_scene.h"

#include <fmt/format.h>

#include <utility>

#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/queries.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerPiece = 256;

}  // namespace

TerrainScene::TerrainScene(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings)
    : field_(std::move(field)), march_(&march), settings_(settings) {
  validate(settings_);
  if (march.needs_pyramid) pyramid_.emplace(field_);
  if (march.needs_slope) slope_ = slope_bound(field_);
}

TerrainScene::TerrainScene(HeightField field, const HeightMarchEntry& march, std::shared_ptr<BatchQueries> device)
    : field_(std::move(field)), march_(&march), device_(std::move(device)) {}

void TerrainScene::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps) const {
  if (device_) return device_->closest_hits(rays, hits, steps);
  if (steps.empty()) return scarp::closest_hits(target(), rays, hits, *march_, settings_);
  if (hits.size() != rays.size() || steps.size() != rays.size()) {
    throw Error(fmt::format("batch: {} rays, room for {} answers and {} counts of steps", rays.size(), hits.size(),
                            steps.size()));
  }
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      MarchStats stats;
      hits[i] = march_->cpu(target(), rays[i], settings_, &stats);
      steps[i] = stats.steps;
    }
  });
}

void TerrainScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  if (device_) return device_->occluded(rays, blocked);
  scarp::occluded(target(), rays, blocked, *march_, settings_);
}

Hit TerrainScene::closest_hit(const Ray& ray, MarchStats* stats) const {
  if (!device_) return march_->cpu(target(), ray, settings_, stats);
  Hit hit;
  std::uint32_t steps = 0;
  device_->closest_hits({&ray, 1}, {&hit, 1}, stats ? std::span(&steps, 1) : std::span<std::uint32_t>());
  if (stats) *stats = {.steps = steps};
  return hit;
}

bool TerrainScene::occluded(const Ray& ray) const {
  if (!device_) return march_->occluded(target(), ray, settings_);
  std::uint8_t blocked = 0;
  device_->occluded({&ray, 1}, {&blocked, 1});
  return blocked != 0;
}

}  // namespace scarp
