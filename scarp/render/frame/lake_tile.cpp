// SPDX-License-Identifier: MIT
#include "scarp/render/frame/lake_tile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/surface/water.glsl.h"

namespace scarp {

Lake::Lake(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth, const PictureSettings& settings)
    : shader_(scene.field(), camera, grid_north_azimuth, settings), plinth_(plinth_of(scene.field(), settings)) {
  const HeightField& field = scene.field();
  if (settings.water) {
    water_.emplace(*settings.water, field);
    if (camera.eye().z <= water_->level()) {
      throw Error(fmt::format("water: its level, {} m, is not below the eye, at {} m; pictures are made from above it",
                              water_->level(), camera.eye().z));
    }
  }
  const bool comanche = settings.look == Look::comanche;
  if (comanche && scene.march().name == "fixed-step") {
    const double reach = std::isfinite(camera.reach()) ? camera.reach() : default_reach(field);
    march_.emplace(field, settings.comanche, reach, camera.forward());
  }
  view_.emplace(LakeView{camera, plinth_, shader_, water_ ? &*water_ : nullptr, march_ ? &*march_ : nullptr,
                         comanche && settings.comanche.iterations, settings.aa});
}

std::size_t Lake::most_rays() const {
  return std::min(kMostRaysOfRound, kMostPointsOfTile * std::max<std::size_t>(2, shader_.lighting().most_rays()));
}

LakeTile::LakeTile(const LakeView& view, const PixelTile& tile)
    : view_(view), points_(points_of(tile, view.aa)), looking_(view.plinth) {
  seen_.reserve(points_.size());
  for (const PicturePoint& point : points_) seen_.push_back({seen_.size(), view.camera.ray(point.x, point.y), {}});
  meetings_.resize(points_.size());
}

bool LakeTile::next(RayRound& round) {
  if (stage_ == Stage::look) {
    if (!asked_ && !view_.march) {
      asked_ = true;
      ask_camera(round);
      return true;
    }
    if (view_.march) {
      for (std::size_t i = 0; i < seen_.size(); ++i) {
        const StepMarch::Answer answer = view_.march->march(seen_[i].ray, view_.water);
        seen_[i].sight.hit = answer.hit;
        seen_[i].sight.steps = answer.steps;
        if (answer.water) meetings_[i] = Water::Meeting{answer.t, {0, 0, 1}};
      }
    } else {
      std::vector<Sight> sights = looking_.answers(round);
      for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i].sight = sights[i];
    }
    if (view_.iterations) return false;
    find_water();
    stage_ = Stage::water;
    if (ask_water(round)) return true;
  }
  if (stage_ == Stage::water) {
    if (!view_.march) {
      for (std::size_t i = 0; i < water_rays_.size(); ++i) water_rays_[i].sight.hit = round.hits[i];
    }
    stage_ = Stage::light;
    return ask_light(round);
  }
  take_light(round);
  return ask_light(round);
}

void LakeTile::ask_camera(RayRound& round) {
  std::vector<Ray> rays;
  rays.reserve(seen_.size());
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    rays.push_back(seen_[i].ray);
    // Above the highest ground there is nothing more to meet.
    Ray& ray = rays.back();
    if (ray.direction.z > 0) {
      const double leaves = (view_.shader.field().max_height() - ray.origin.z) / ray.direction.z;
      ray.t_max = std::max(ray.t_min, std::min(ray.t_max, leaves));
    }
    if (!view_.water) continue;
    meetings_[i] = view_.water->meets(rays.back());
    if (meetings_[i]) rays.back().t_max = meetings_[i]->t;
  }
  looking_.ask(rays, view_.iterations || view_.shader.fog().kind() == FogKind::iterations, round);
}

bool LakeTile::is_sea(const Hit& hit) const {
  // Most ground is far above the water. Heights of hits are good to a thousandth of a cell.
  const HeightFieldSettings& field = view_.shader.field().settings();
  if (!hit || hit.wall || hit.height > view_.water->level() + std::min(field.cell_x, field.cell_y)) return false;
  return view_.water->is_sea(hit.cell);
}

std::optional<Water::Meeting> LakeTile::water_of(const Ray& ray, const Sight& sight) const {
  if (is_sea(sight.hit)) {
    return Water::Meeting{sight.hit.t, {0, 0, 1}, sight.hit.cell};
  }
  const auto meeting = view_.water->meets(ray);
  if (!meeting) return {};
  const double t = sight.hit ? sight.hit.t : sight.wall ? sight.wall->t : std::numeric_limits<double>::infinity();
  return meeting->t < t ? meeting : std::nullopt;
}

void LakeTile::find_water() {
  if (!view_.water) return;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Sight& sight = seen_[i].sight;
    if (is_sea(sight.hit)) {
      add_water(i, {sight.hit.t, {0, 0, 1}, sight.hit.cell});
    } else if (meetings_[i] && !sight.hit && !(sight.wall && sight.wall->t <= meetings_[i]->t)) {
      add_water(i, *meetings_[i]);
    }
  }
}

void LakeTile::add_water(std::size_t point, const Water::Meeting& meeting) {
  const Water& water = *view_.water;
  const Ray& ray = seen_[point].ray;
  const dvec3 position = ray.at(meeting.t);
  dvec3 normal = meeting.normal;
  if (normal.z > 0) {
    // A pixel is longer on the water than it is wide, seen at a grazing angle.
    const double cosine = -ray.direction.z, wide = view_.camera.pixel_width(meeting.t);
    normal = water.normal_at(position, wide / std::sqrt(std::max(cosine, 0.01)));
    if (dot(normal, ray.direction) >= 0) normal = {0, 0, 1};
  }
  WaterPoint found{point, meeting.t, schlick(-dot(normal, ray.direction)), {}, {}};
  const auto send = [&](const dvec3& direction, double t_max) {
    Ray sent;
    sent.origin = position;
    sent.direction = direction;
    sent.t_max = t_max;
    if (meeting.sea) {
      sent.start = RayStart::on_surface;
      sent.start_cell = *meeting.sea;
    }
    water_rays_.push_back({point, sent, {}});
    return water_rays_.size() - 1;
  };
  dvec3 mirrored = reflected(ray.direction, normal);
  if (meeting.normal.z > 0) mirrored = glsl::scarp_kept_above(mirrored);
  found.mirror = send(mirrored, water.settings().reflection ? view_.camera.reach() : 0);
  if (water.settings().refraction && !meeting.sea) {
    const dvec3 down = refracted(ray.direction, normal);
    found.bottom = send(down, view_.camera.reach());
    Ray& sent = water_rays_.back().ray;
    sent.t_max = std::min(sent.t_max, water.leaves(sent));
  }
  water_.push_back(found);
}

bool LakeTile::ask_water(RayRound& round) {
  if (water_rays_.empty()) return false;
  if (view_.march) {
    for (Seen& seen : water_rays_) {
      if (seen.ray.t_max > 0) seen.sight.hit = view_.march->march(seen.ray);
    }
    return false;
  }
  round.question = RayRound::Question::closest;
  round.rays.clear();
  for (const Seen& seen : water_rays_) round.rays.push_back(seen.ray);
  return true;
}

LakeTile::Seen* LakeTile::ground(std::size_t i) {
  Seen& seen = i < seen_.size() ? seen_[i] : water_rays_[i - seen_.size()];
  return seen.sight.hit && !seen.sight.hit.wall ? &seen : nullptr;
}

bool LakeTile::ask_light(RayRound& round) {
  const Shader& shader = view_.shader;
  round.question = RayRound::Question::any;
  round.rays.clear();
  for (; asked_points_ < seen_.size() + water_rays_.size(); ++asked_points_) {
    if (round.rays.size() + shader.lighting().most_rays() > kMostRaysOfRound) return true;
    Seen* seen = ground(asked_points_);
    if (!seen) continue;
    const GroundPoint point = ground_point(shader.field(), seen->ray, seen->sight.hit);
    open_.push_back({seen, point, shader.lighting().ask(point, points_[seen->point], round.rays)});
  }
  if (!round.rays.empty()) return true;
  take_light(round);
  return false;
}

void LakeTile::take_light(const RayRound& round) {
  for (const Open& open : open_) {
    open.seen->light = view_.shader.lit_ground(open.seen->ray, open.seen->sight.hit, open.ground, open.asked,
                                               round.rays, round.blocked);
  }
  open_.clear();
}

vec3 LakeTile::colour_of(const Seen& seen) const {
  if (seen.sight.hit && !seen.sight.hit.wall) return view_.shader.in_air(seen.light, seen.ray, seen.sight.hit.t);
  return view_.shader.colour_beside_ground(seen.ray, seen.sight);
}

vec3 LakeTile::water_colour(const WaterPoint& found) const {
  const Water& water = *view_.water;
  vec3 body = water.deep();
  if (found.bottom) {
    const Seen& bottom = water_rays_[*found.bottom];
    if (const Hit& hit = bottom.sight.hit) {
      body = water.through(bottom.light * water.sunlight(water.level() - hit.height, view_.shader.to_sun()), hit.t);
    } else if (std::isfinite(bottom.ray.t_max)) {
      body = water.through(view_.shader.colour_beside_ground(bottom.ray, {}), bottom.ray.t_max);
    }
  }
  const auto mirror = static_cast<float>(found.reflectance);
  return colour_of(water_rays_[*found.mirror]) * mirror + body * (1 - mirror);
}

std::vector<vec3> LakeTile::pixels() const {
  const auto most = view_.march ? static_cast<double>(view_.march->most_steps()) : 256.0;
  std::vector<vec3> colours(seen_.size());
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    colours[i] =
        view_.iterations ? vec3(static_cast<float>(std::min(1.0, seen_[i].sight.steps / most))) : colour_of(seen_[i]);
  }
  if (!view_.iterations) {
    for (const WaterPoint& found : water_) {
      colours[found.point] = view_.shader.in_air(water_colour(found), seen_[found.point].ray, found.t);
    }
    if (view_.shader.fog().kind() == FogKind::iterations) {
      for (std::size_t i = 0; i < seen_.size(); ++i) {
        colours[i] = view_.shader.fog().by_share(seen_[i].ray, seen_[i].sight.steps / most, colours[i]);
      }
    }
  }
  const auto per_pixel = static_cast<std::size_t>(view_.aa * view_.aa);
  std::vector<vec3> means(colours.size() / per_pixel);
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] = mean_colour(std::span(colours).subspan(i * per_pixel, per_pixel));
  }
  return means;
}

}  // namespace scarp
