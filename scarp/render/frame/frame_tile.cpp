// SPDX-License-Identifier: MIT
#include "scarp/render/frame/frame_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "scarp/base/kept_memory.h"
#include "scarp/render/surface/water.glsl.h"

namespace scarp {
namespace {

// Maximum steps assumed by fog and pictures of iterations if the march has no limit.
constexpr double kMostSteps = 256;
// Number of points whose surfaces are prefetched.
constexpr std::size_t kPointsAhead = 8;

// Surfaces of voxels, shapes and meshes in the plane of the water: rounding decides which of the two a ray hits first.
// Relative to the distance, or to the diagonal of the scene if that is longer. Rays through voxels are rounded most, by
// 2^-20 of a voxel (and 2^-28 of the direction), and no voxel is longer than the diagonal. For terrain, the samples
// themselves determine where the ground is level with the water.
constexpr double kCoincident = 0x1p-20;

}  // namespace

std::size_t most_rays_of(const FrameView& view) {
  // A point is either water, which sends two further rays, or a surface, which sends at most one.
  const std::size_t per_point = std::max<std::size_t>(view.water() ? 2 : 1, view.lighting().most_rays());
  return std::min(kMostRaysOfRound, kMostPointsOfTile * per_point);
}

bool counts_steps(const FrameView& view) {
  const PictureSettings& settings = view.settings();
  return (settings.look == Look::comanche && settings.comanche.iterations) || view.fog().kind() == FogKind::iterations;
}

FrameTile::FrameTile(const FrameView& view, const PixelTile& tile, int aa, const CameraSights* sights)
    : view_(view), tile_(tile), aa_(aa), sights_(sights), points_(points_of(tile, aa)) {
  borrow(seen_), borrow(sent_), borrow(open_);
  seen_.reserve(points_.size());
  for (const PicturePoint& point : points_) add(seen_, seen_.size(), view.camera().ray(point.x, point.y));
  if (view.water()) meetings_.resize(points_.size());
}

FrameTile::~FrameTile() { keep(seen_), keep(sent_), keep(open_); }

void FrameTile::add(std::vector<Seen>& all, std::size_t point, const Ray& ray) {
  Seen& seen = all.emplace_back();
  seen.ray = ray;
  seen.point = static_cast<std::uint32_t>(point);
}

bool FrameTile::next(RayRound& round) {
  if (round_ == RoundKind::look) {
    if (!asked_ && look(round)) return true;
    take_look(round);
    round_ = RoundKind::sent;
    if (ask_sent(round)) return true;
  }
  if (round_ == RoundKind::sent) {
    take_sent(round);
    round_ = RoundKind::light;
    return ask_light(round);
  }
  take_light(round);
  return ask_light(round);
}

bool FrameTile::shows_steps() const {
  return view_.settings().look == Look::comanche && view_.settings().comanche.iterations;
}

// Returns false if the round is resolved here, without the scene.
bool FrameTile::look(RayRound& round) {
  asked_ = true;
  if (const StepMarch* march = view_.step_march()) {
    for (Seen& seen : seen_) {
      const StepMarch::Answer answer = march->march(seen.ray, view_.water());
      seen.hit = answer.hit;
      seen.steps = answer.steps;
      if (answer.water) meetings_[seen.point] = Water::Meeting{answer.t, {0, 0, 1}};
    }
    return false;
  }
  const bool count = counts_steps(view_);
  round.question = count ? RayRound::Question::closest_cost : RayRound::Question::closest;
  if (sights_ && !count) sights_->of(tile_, round.sights);
  round.rays.clear();
  round.from.clear();
  round.rays.reserve(seen_.size());
  for (const Seen& seen : seen_) {
    round.rays.push_back(seen.ray);
    Ray& ray = round.rays.back();
    if (view_.ceiling() && ray.direction.z > 0) {
      const double leaves = (*view_.ceiling() - ray.origin.z) / ray.direction.z;
      ray.t_max = std::max(ray.t_min, std::min(ray.t_max, leaves));
    }
    if (!view_.water()) continue;
    meetings_[seen.point] = view_.water()->meets(ray);
    if (meetings_[seen.point]) ray.t_max = meetings_[seen.point]->t + coincidence(meetings_[seen.point]->t);
  }
  return true;
}

void FrameTile::take_look(const RayRound& round) {
  if (!view_.step_march()) {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      seen_[i].hit = round.hits[i];
      if (round.question == RayRound::Question::closest_cost) seen_[i].steps = round.steps[i];
    }
  }
  if (view_.water() && !shows_steps()) find_water();
  if (view_.mirrors() && !shows_steps()) find_mirrors();
}

std::optional<Water::Meeting> FrameTile::water_of(const Ray& ray, const Hit& hit) const {
  const Water* water = view_.water();
  if (!water) return {};
  if (water->is_sea(hit)) return Water::Meeting{hit.t, {0, 0, 1}, hit};
  const auto meeting = water->meets(ray);
  if (!meeting) return {};
  return !hit || is_before(*meeting, hit) ? meeting : std::nullopt;
}

double FrameTile::coincidence(double t) const {
  if (view_.scene().only_heights()) return 0;
  const WorldBox& box = view_.scene().box();
  return kCoincident * std::max(t, box.empty() ? 1.0 : length(box.high - box.low));
}

// Water is in front of surfaces in its plane; the sides of the basin are behind them.
bool FrameTile::is_before(const Water::Meeting& meeting, const Hit& hit) const {
  const double margin = coincidence(meeting.t);
  return meeting.t < (meeting.normal.z > 0 ? hit.t + margin : hit.t - margin);
}

void FrameTile::find_water() {
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Hit& hit = seen_[i].hit;
    if (view_.water()->is_sea(hit)) {
      add_water(i, {hit.t, {0, 0, 1}, hit});
    } else if (meetings_[i] && (!hit || is_before(*meetings_[i], hit))) {
      add_water(i, *meetings_[i], !hit);
    }
  }
}

void FrameTile::find_mirrors() {
  std::vector<bool> under_water(seen_.size());
  for (const WaterPoint& found : water_) under_water[found.point] = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Seen& seen = seen_[i];
    if (!seen.hit || under_water[i]) continue;
    const SceneSurface surface = view_.scene().surface(seen.ray, seen.hit);
    if (surface.light.mirror <= 0 || !FrameView::is_lit(surface)) continue;
    // Smooth normals could mirror the ray into the surface.
    dvec3 direction = reflected(seen.ray.direction, surface.shading_normal);
    if (dot(direction, surface.normal) <= 0) direction = reflected(seen.ray.direction, surface.normal);
    Ray ray;
    ray.origin = seen.ray.at(seen.hit.t);
    ray.direction = direction;
    ray.t_max = view_.camera().reach();
    mirrors_.push_back({i, surface.light.mirror, view_.surface_colour(seen.ray, seen.hit, surface), sent_.size()});
    add(sent_, i, ray);
    sent_from_.resize(sent_.size(), nullptr);
    sent_from_.back() = &seen.hit;
  }
}

std::size_t FrameTile::send(std::size_t point, const Water::Meeting& meeting, const dvec3& direction, double t_max) {
  Ray ray;
  ray.origin = seen_[point].ray.at(meeting.t);
  ray.direction = direction;
  ray.t_max = t_max;
  if (meeting.sea) {
    ray.start = RayStart::on_surface;
    ray.start_cell = meeting.sea->cell;
    ray.start_object = meeting.sea->object;
  }
  add(sent_, point, ray);
  return sent_.size() - 1;
}

void FrameTile::add_water(std::size_t point, const Water::Meeting& meeting, bool deep) {
  const Water& water = *view_.water();
  const Ray& ray = seen_[point].ray;
  dvec3 normal = meeting.normal;
  double roughness = 0;
  if (normal.z > 0) {
    // At a grazing angle, the footprint of a pixel on the water is longer than wide.
    const double cosine = -ray.direction.z, wide = view_.camera().pixel_width(meeting.t);
    const double footprint = wide / std::sqrt(std::max(cosine, 0.01));
    normal = water.normal_at(ray.at(meeting.t), footprint);
    roughness = water.roughness_at(footprint);
    if (dot(normal, ray.direction) >= 0) normal = {0, 0, 1};
  }
  dvec3 mirrored = reflected(ray.direction, normal);
  if (meeting.normal.z > 0) mirrored = glsl::scarp_kept_above(mirrored);
  const double reach = view_.camera().reach();
  WaterPoint found{point, meeting.t, schlick(-dot(normal, ray.direction)), vec3(0.0f), 0, {}};
  if (meeting.normal.z > 0) {
    found.glitter = glsl::scarp_glitter(view_.sky().numbers(), view_.sky().sunlight(), ray.direction, normal, roughness,
                                        found.reflectance);
  }
  found.mirror = send(point, meeting, mirrored, water.settings().reflection ? reach : 0);
  // Starts above surfaces in the plane of the water as well.
  if (const double margin = coincidence(meeting.t); meeting.normal.z > 0 && margin > 0)
    sent_.back().ray.origin.z = water.level() + margin;
  if (deep && water.settings().refraction && !meeting.sea) {
    found.bottom = send(point, meeting, refracted(ray.direction, normal), reach);
    Ray& sent = sent_.back().ray;
    sent.t_max = std::min(sent.t_max, water.leaves(sent));
  }
  water_.push_back(found);
}

bool FrameTile::ask_sent(RayRound& round) {
  if (sent_.empty()) return false;
  if (const StepMarch* march = view_.step_march()) {
    for (Seen& seen : sent_) {
      if (seen.ray.t_max > 0) seen.hit = march->march(seen.ray);
    }
    return false;
  }
  round.question = RayRound::Question::closest;
  round.rays.clear();
  round.from.clear();
  for (const Seen& seen : sent_) round.rays.push_back(seen.ray);
  round.from = sent_from_;
  return true;
}

void FrameTile::take_sent(const RayRound& round) {
  for (std::size_t i = 0; i < sent_.size(); ++i) {
    if (!view_.step_march()) sent_[i].hit = round.hits[i];
  }
}

FrameTile::Seen* FrameTile::seen_or_sent(std::size_t i) {
  if (i < seen_.size()) return &seen_[i];
  return i - seen_.size() < sent_.size() ? &sent_[i - seen_.size()] : nullptr;
}

bool FrameTile::ask_light(RayRound& round) {
  if (shows_steps()) return false;
  const Lighting& lighting = view_.lighting();
  // Ray::start suffices for rays from a height field; other fields need their hits.
  const bool by_hit = !view_.scene().only_heights();
  round.question = RayRound::Question::any;
  round.rays.clear();
  round.from.clear();
  for (; asked_points_ < seen_.size() + sent_.size(); ++asked_points_) {
    if (round.rays.size() + lighting.most_rays() > kMostRaysOfRound) return true;
    Seen& seen = *seen_or_sent(asked_points_);
    if (const Seen* soon = seen_or_sent(asked_points_ + kPointsAhead); soon && soon->hit)
      view_.scene().prefetch_surface(soon->hit);
    const SceneSurface surface = seen.hit ? view_.scene().surface(seen.ray, seen.hit) : SceneSurface{};
    seen.lit = seen.hit && FrameView::is_lit(surface);
    if (!seen.lit) {
      seen.colour = view_.unlit(seen.ray, seen.hit, surface);
      // Water reflects the sun as glitter.
      if (!seen.hit && asked_points_ < seen_.size())
        seen.colour += view_.from_beyond(view_.sky().disc(seen.ray.direction), seen.ray);
      continue;
    }
    const LightRays asked = lighting.ask(light_point(surface, seen.hit), points_[seen.point], round.rays);
    if (asked.sun == asked.end) {
      light({&seen, surface, {}}, round);
      continue;
    }
    open_.push_back({&seen, surface, asked});
    if (by_hit) round.from.resize(round.rays.size(), &seen.hit);
  }
  if (!round.rays.empty()) return true;
  take_light(round);
  return false;
}

void FrameTile::light(const Open& open, const RayRound& round) const {
  open.seen->colour = view_.lit(open.seen->ray, open.seen->hit, open.surface, open.asked, round.rays, round.blocked);
}

void FrameTile::take_light(const RayRound& round) {
  for (const Open& open : open_) light(open, round);
  open_.clear();
}

vec3 FrameTile::colour_of(const Seen& seen) const {
  return seen.lit ? view_.in_air(seen.colour, seen.ray, seen.hit.t) : seen.colour;
}

vec3 FrameTile::water_colour(const WaterPoint& found) const {
  const Water& water = *view_.water();
  vec3 body = water.deep();
  if (found.bottom) {
    const Seen& bottom = sent_[*found.bottom];
    if (bottom.hit) {
      // Walls under water are dark.
      const vec3 ground = bottom.lit ? bottom.colour : vec3(0.0f);
      const double depth = water.level() - bottom.ray.at(bottom.hit.t).z;
      body = water.through(ground * water.sunlight(depth, view_.lighting().to_sun()), bottom.hit.t);
    } else if (std::isfinite(bottom.ray.t_max)) {
      body = water.through(bottom.colour, bottom.ray.t_max);
    }
  }
  const auto reflectance = static_cast<float>(found.reflectance);
  const Seen& mirror = sent_[found.mirror];
  vec3 colour = colour_of(mirror) * reflectance + body * (1 - reflectance);
  if (!mirror.hit) colour += view_.from_beyond(found.glitter, mirror.ray);
  return colour;
}

float FrameTile::share_of_steps(std::size_t point, double most) const {
  const Seen& seen = seen_[point];
  const bool meets = seen.hit || (view_.water() && meetings_[point]);
  // A stepped ray that hits nothing takes all its steps, sampled or not.
  if (!meets && (view_.step_march() || view_.scene().sampling() == Sampling::fixed_step)) return 1;
  return static_cast<float>(std::min(1.0, seen.steps / most));
}

std::vector<vec3> FrameTile::colours() const {
  const StepMarch* march = view_.step_march();
  const double most = march ? static_cast<double>(march->most_steps()) : kMostSteps;
  std::vector<vec3> colours(seen_.size());
  if (shows_steps()) {
    for (std::size_t i = 0; i < seen_.size(); ++i) colours[i] = vec3(share_of_steps(i, most));
    return colours;
  }
  for (std::size_t i = 0; i < seen_.size(); ++i) colours[i] = colour_of(seen_[i]);
  for (const MirrorPoint& found : mirrors_) {
    const Seen& seen = seen_[found.point];
    const vec3 mixed = seen.colour * (1 - found.share) + colour_of(sent_[found.mirror]) * found.tint * found.share;
    colours[found.point] = view_.in_air(mixed, seen.ray, seen.hit.t);
  }
  for (const WaterPoint& found : water_)
    colours[found.point] = view_.in_air(water_colour(found), seen_[found.point].ray, found.t);
  if (view_.fog().kind() == FogKind::iterations) {
    for (std::size_t i = 0; i < seen_.size(); ++i)
      colours[i] = view_.fog().by_share(seen_[i].ray, seen_[i].steps / most, colours[i]);
  }
  return colours;
}

std::vector<bool> FrameTile::shown() const {
  std::vector<bool> shown(seen_.size());
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Hit& hit = seen_[i].hit;
    shown[i] = hit && !view_.scene().field_of(hit.object).is_backdrop();
  }
  for (const WaterPoint& found : water_) shown[found.point] = true;
  return shown;
}

std::vector<vec3> FrameTile::pixels() const {
  const std::vector<vec3> of_points = colours();
  const auto per_pixel = static_cast<std::size_t>(aa_ * aa_);
  std::vector<vec3> means(of_points.size() / per_pixel);
  for (std::size_t i = 0; i < means.size(); ++i)
    means[i] = mean_colour(std::span(of_points).subspan(i * per_pixel, per_pixel));
  return means;
}

}  // namespace scarp
