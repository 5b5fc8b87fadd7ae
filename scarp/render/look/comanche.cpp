// SPDX-License-Identifier: MIT
#include "scarp/render/look/comanche.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/setting.h"
#include "scarp/march/height/height_sampling.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/camera/compass.h"
#include "scarp/render/film/film.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where a ray enters the field: fixed-step places its samples from there.
double entry(const HeightField& field, const Ray& ray) {
  if (field.wraps()) return ray.t_min;
  const auto from = [](double o, double d, double high) {
    return d == 0 ? -kInfinity : std::min(-o / d, (high - o) / d);
  };
  return std::max({ray.t_min, from(ray.origin.x, ray.direction.x, field.width()),
                   from(ray.origin.y, ray.direction.y, field.depth())});
}

}  // namespace

void validate(const ComancheSettings& settings) {
  require_setting("comanche", settings.scale >= 1 && settings.scale <= 64, "the scale", settings.scale, "1 to 64");
  require_setting("comanche", settings.steps >= 1 && settings.steps <= 65536, "the number of steps", settings.steps,
                  "1 to 65536");
}

double default_reach(const HeightField& field) { return std::max(field.width(), field.depth()); }

Camera flight_camera(const HeightField& field, double grid_north_azimuth, double fov_deg, int width, int height) {
  constexpr double kAbove = 1.0, kDown = 0.2;  // fractions of the relief and of the distance ahead
  const double low = field.min_height(), relief = field.max_height() - low;
  const double x = 0.3 * field.width(), y = 0.1 * field.depth();
  dvec3 eye(x, y, low + kAbove * relief);
  const double clear = field.height(x, y).value_or(low) + 0.1 * relief;
  eye.z = std::max(eye.z, clear);
  return Camera::look_at(eye, eye + towards(0, -std::atan(kDown), grid_north_azimuth), fov_deg, width, height);
}

StepMarch::StepMarch(const HeightField& field, const ComancheSettings& settings, double reach, const dvec3& forward)
    : field_(field), settings_(settings), step_(reach / settings.steps), forward_(forward) {}

double StepMarch::by_view(double step, const dvec3& direction) const {
  return settings_.step_by_view ? step / std::max(length(dvec2(direction)), 1 / kLongestStep) : step;
}

StepMarch::Answer StepMarch::march(const Ray& ray, const Water* water) const {
  // No ray of a picture is 90 degrees or more off its axis.
  const double step = settings_.shells ? step_ : step_ / dot(ray.direction, forward_);
  return march(ray, water, by_view(step, ray.direction));
}

Hit StepMarch::march(const Ray& ray) const { return march(ray, nullptr, by_view(step_, ray.direction)).hit; }

StepMarch::Answer StepMarch::march(const Ray& ray, const Water* water, double step) const {
  Answer answer;
  const double highest = field_.max_height();
  Ray marched = ray;
  marched.t_max = std::min(ray.t_max, ray.t_min + step * settings_.steps);
  if (ray.direction.z > 0) {
    const double leaves = (highest - ray.origin.z) / ray.direction.z;
    if (leaves < ray.t_min) {
      answer.steps = 1;
      return answer;
    }
    marched.t_max = std::min(marched.t_max, leaves + step);
  }
  double plane = kInfinity, stop = kInfinity;  // where the ray reaches the water, and where the march detects it
  if (water) {
    if (const auto meeting = water->meets(ray)) {
      plane = meeting->t;
      const double first = entry(field_, ray);
      stop = first + std::ceil((plane - first) / step) * step;
      marched.t_max = std::min(marched.t_max, stop);
    }
  }
  MarchSettings settings;
  settings.fixed_step = {step / std::min(field_.settings().cell_x, field_.settings().cell_y), settings_.interpolate,
                         settings_.steps + 1};
  MarchStats stats;
  answer.hit = march_fixed_step({&field_}, marched, settings, &stats);
  answer.steps = std::min(stats.steps, static_cast<std::uint32_t>(settings_.steps));
  // As in the founding text, each sample tests ground before water; between samples, the nearer of the two counts.
  const bool ended_at_water = stop <= marched.t_max;
  answer.t = settings_.interpolate ? plane : stop;
  answer.water = ended_at_water && (!answer.hit || (settings_.interpolate && plane < answer.hit.t));
  if (answer.water) answer.hit = {};
  return answer;
}

Image scaled_up(const Image& image, int factor) {
  Image large(image.width * factor, image.height * factor);
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) std::copy_n(image.pixel(x / factor, y / factor), 3, large.pixel(x, y));
  }
  if (image.alpha.empty()) return large;
  large.alpha.reserve(large.rgb.size() / 3);
  for (std::size_t i = 0; i < large.rgb.size() / 3; ++i) {
    const std::size_t width = static_cast<std::size_t>(large.width), side = static_cast<std::size_t>(factor);
    large.alpha.push_back(image.alpha[i / width / side * static_cast<std::size_t>(image.width) + i % width / side]);
  }
  return large;
}

}  // namespace scarp
