// SPDX-License-Identifier: MIT
#include "scarp/render/frame/sight.h"

#include <utility>

namespace scarp {

std::optional<Plinth> plinth_of(const HeightField& field, const PictureSettings& settings) {
  if (!settings.plinth || field.wraps()) return {};
  return Plinth(field, plinth_base(field));
}

std::vector<Ray> rays_through_middles(const Camera& camera, const PixelTile& tile) {
  std::vector<Ray> rays;
  rays.reserve(tile.pixels());
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) rays.push_back(camera.ray(x + 0.5, y + 0.5));
  }
  return rays;
}

void SightRound::ask(std::span<const Ray> rays, bool steps, RayRound& round) {
  round.question = steps ? RayRound::Question::closest_cost : RayRound::Question::closest;
  round.rays.clear();
  round.rays.reserve(rays.size());
  sights_.assign(rays.size(), {});
  marched_.clear();
  marched_.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Sight& sight = sights_[i];
    if (plinth_) {
      if (plinth_->passes_below(rays[i])) continue;
      sight.wall = plinth_->intersect(rays[i]);
      if (sight.wall && sight.wall->outermost) continue;
    }
    round.rays.push_back(rays[i]);
    if (sight.wall) round.rays.back().t_max = sight.wall->t;
    marched_.push_back(i);
  }
}

std::vector<Sight> SightRound::answers(const RayRound& round) {
  for (std::size_t i = 0; i < marched_.size(); ++i) {
    sights_[marched_[i]].hit = round.hits[i];
    if (round.question == RayRound::Question::closest_cost) sights_[marched_[i]].steps = round.steps[i];
  }
  return std::move(sights_);
}

}  // namespace scarp
