// SPDX-License-Identifier: MIT
#include "scarp/render/frame/shaded_tile.h"

#include <algorithm>

namespace scarp {

std::size_t most_rays_of(const Shader& shader) {
  return std::min(kMostRaysOfRound, kMostPointsOfTile * shader.lighting().most_rays());
}

ShadedTile::ShadedTile(const ShadedView& view, const PixelTile& tile)
    : view_(view), points_(points_of(tile, view.aa)), looking_(view.plinth), colours_(points_.size()) {
  rays_.reserve(points_.size());
  for (const PicturePoint& point : points_) rays_.push_back(view.camera.ray(point.x, point.y));
}

bool ShadedTile::next(RayRound& round) {
  if (!looks_) {
    looks_ = true;
    looking_.ask(rays_, false, round);
    return true;
  }
  if (sights_.empty()) {
    sights_ = looking_.answers(round);
  } else {
    take_light(round);
  }
  return ask_light(round);
}

bool ShadedTile::ask_light(RayRound& round) {
  const Shader& shader = view_.shader;
  round.question = RayRound::Question::any;
  round.rays.clear();
  for (; asked_points_ < points_.size(); ++asked_points_) {
    if (round.rays.size() + shader.lighting().most_rays() > kMostRaysOfRound) return true;
    const std::size_t i = asked_points_;
    const Hit& hit = sights_[i].hit;
    if (hit && !hit.wall) {
      const GroundPoint ground = ground_point(shader.field(), rays_[i], hit);
      open_.push_back({i, ground, shader.lighting().ask(ground, points_[i], round.rays)});
    } else {
      colours_[i] = shader.colour_beside_ground(rays_[i], sights_[i]);
    }
  }
  if (!round.rays.empty()) return true;
  take_light(round);
  return false;
}

void ShadedTile::take_light(const RayRound& round) {
  for (const Open& open : open_) {
    colours_[open.point] = view_.shader.ground_colour(rays_[open.point], sights_[open.point].hit, open.ground,
                                                      open.asked, round.rays, round.blocked);
  }
  open_.clear();
}

std::vector<vec3> ShadedTile::pixels() const {
  const auto per_pixel = static_cast<std::size_t>(view_.aa * view_.aa);
  std::vector<vec3> means(colours_.size() / per_pixel);
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] = mean_colour(std::span(colours_).subspan(i * per_pixel, per_pixel));
  }
  return means;
}

}  // namespace scarp
