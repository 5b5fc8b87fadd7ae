// SPDX-License-Identifier: MIT
#include "scarp/scene/terrain_scene.h"

#include <utility>

#include "scarp/accel/slope_bound.h"

namespace scarp {

TerrainScene::TerrainScene(HeightField field, const MarchEntry& march, const MarchSettings& settings)
    : field_(std::move(field)), march_(&march), settings_(settings) {
  validate(settings_);
  if (march.needs_pyramid) pyramid_.emplace(field_);
  if (march.needs_slope) slope_ = slope_bound(field_);
}

Hit TerrainScene::closest_hit(const Ray& ray, MarchStats* stats) const {
  return march_->cpu(target(), ray, settings_, stats);
}

bool TerrainScene::occluded(const Ray& ray) const {
  if (march_->cpu_occluded) return march_->cpu_occluded(target(), ray);
  return static_cast<bool>(closest_hit(ray));
}

}  // namespace scarp
