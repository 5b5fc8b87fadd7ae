// SPDX-License-Identifier: MIT
#include "scarp/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/render/plinth.h"
#include "scarp/render/ramp.h"
#include "scarp/render/sky.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 4> kLookNames = {"shaded", "height", "steps", "error"};

constexpr int kMaxSide = 65536;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

// The cut earth of the plinth, sRGB: flat, and darker on walls that the sun does not see.
constexpr vec3 kEarth(0.64f, 0.58f, 0.53f);
constexpr float kUnlitWall = 0.55f;

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("picture: {} is {}; it must be {}", what, value, range));
}

std::string_view ramp_of(const PictureSettings& settings) {
  if (!settings.ramp.empty()) return settings.ramp;
  return settings.look == Look::steps ? "viridis" : "hypsometric";
}

// What a ray of the camera meets: ground, or else perhaps a wall.
struct Sight {
  Hit hit;
  std::optional<Plinth::Wall> wall;
};

std::optional<Plinth> plinth_of(const HeightField& field, const PictureSettings& settings) {
  if (!settings.plinth) return {};
  return Plinth(field, plinth_base(field));
}

// Rays are not marched where the block hides the field: below its base and behind its outer walls.
Sight look(const TerrainScene& scene, const std::optional<Plinth>& plinth, Ray ray, MarchStats* stats = nullptr) {
  Sight sight;
  if (plinth) {
    if (plinth->passes_below(ray)) return sight;
    sight.wall = plinth->intersect(ray);
    if (sight.wall) {
      if (sight.wall->outermost) return sight;
      ray.t_max = sight.wall->t;
    }
  }
  sight.hit = scene.closest_hit(ray, stats);
  return sight;
}

// Everything that one ray of the look `shaded` needs; colours are in linear light.
class Shader {
 public:
  Shader(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth, const PictureSettings& settings)
      : scene_(scene),
        field_(scene.field()),
        ramp_(ramp_of(settings), field_.min_height(), field_.max_height()),
        light_(settings.sun, grid_north_azimuth),
        shadows_(settings.shadows),
        earth_(linear_from_srgb(kEarth)),
        plinth_(plinth_of(field_, settings)) {
    // Haze lies over the field, not between it and a camera that stands back.
    const Box box = picture_box(field_, settings.plinth);
    const dvec3 nearest = glm::clamp(camera.eye(), box.low, box.high);
    clear_distance_ = length(nearest - camera.eye());
    haze_per_metre_ = -std::log(1 - settings.haze) / length(box.high - box.low);
  }

  vec3 colour(const Ray& ray) const {
    const Sight sight = look(scene_, plinth_, ray);
    if (const Hit& hit = sight.hit) {
      const dvec3 normal = field_.shading_normal(hit.cell, hit.u, hit.v);
      return in_haze(ramp_(ground_height(hit)) * light_.on(normal, in_sun(ray, hit, normal)), hit.t);
    }
    if (!sight.wall) return sky_colour(ray.direction.z);
    const auto lit = static_cast<float>(std::max(0.0, dot(sight.wall->normal, light_.to_sun())));
    return in_haze(earth_ * (kUnlitWall + (1 - kUnlitWall) * lit), sight.wall->t);
  }

 private:
  // Of the surface, where hit.height is that of the ray: they differ by rounding, and a sea at 0 must not be speckled.
  double ground_height(const Hit& hit) const {
    const CellHeights h = field_.cell_heights(hit.cell).value();
    const double north = h.h00 + hit.u * (h.h10 - h.h00), south = h.h01 + hit.u * (h.h11 - h.h01);
    return field_.height_from_sample(north + hit.v * (south - north));
  }

  bool in_sun(const Ray& ray, const Hit& hit, const dvec3& normal) const {
    if (dot(normal, light_.to_sun()) <= 0) return false;
    if (!shadows_) return true;
    Ray to_sun;
    to_sun.origin = ray.at(hit.t);
    to_sun.direction = light_.to_sun();
    to_sun.start = RayStart::on_surface;
    to_sun.start_cell = hit.cell;
    return !scene_.occluded(to_sun);
  }

  vec3 in_haze(vec3 colour, double t) const {
    const auto clear = static_cast<float>(std::exp(-haze_per_metre_ * std::max(0.0, t - clear_distance_)));
    return colour * clear + haze_colour() * (1 - clear);
  }

  const TerrainScene& scene_;
  const HeightField& field_;
  Ramp ramp_;
  Light light_;
  bool shadows_;
  vec3 earth_;
  std::optional<Plinth> plinth_;
  double clear_distance_ = 0;
  double haze_per_metre_ = 0;
};

Image render_height(const TerrainScene& scene, const Camera& camera, const PictureSettings& settings,
                    const Progress& progress) {
  Image image(settings.width, settings.height);
  const std::optional<Plinth> plinth = plinth_of(scene.field(), settings);
  const double low = scene.field().min_height(), relief = scene.field().max_height() - low;
  for_each_pixel(
      settings.width, settings.height,
      [&](int x, int y) {
        const Hit hit = look(scene, plinth, camera.ray(x + 0.5, y + 0.5)).hit;
        if (!hit) return;
        const double share = relief > 0 ? std::clamp((hit.height - low) / relief, 0.0, 1.0) : 1.0;
        std::fill_n(image.pixel(x, y), 3, static_cast<std::uint8_t>(std::lround(1 + 254 * share)));
      },
      progress);
  return image;
}

Picture render_steps(const TerrainScene& scene, const Camera& camera, const PictureSettings& settings,
                     const Progress& progress) {
  const auto width = static_cast<std::size_t>(settings.width);
  std::vector<std::uint32_t> steps(width * static_cast<std::size_t>(settings.height));
  const std::optional<Plinth> plinth = plinth_of(scene.field(), settings);
  for_each_pixel(
      settings.width, settings.height,
      [&](int x, int y) {
        MarchStats stats;
        look(scene, plinth, camera.ray(x + 0.5, y + 0.5), &stats);
        steps[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = stats.steps;
      },
      progress);
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
  Picture picture{
      Image(settings.width, settings.height), StepRange{*least, *most, sum / static_cast<double>(steps.size())}, {}};
  const Ramp ramp(ramp_of(settings), *least, *most);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    set_pixel(picture.image, static_cast<int>(i % width), static_cast<int>(i / width), ramp(steps[i]));
  }
  return picture;
}

}  // namespace

std::string_view name_of(Look look) { return kLookNames[static_cast<std::size_t>(look)]; }

Look find_look(std::string_view name) {
  for (std::size_t i = 0; i < kLookNames.size(); ++i) {
    if (kLookNames[i] == name) return static_cast<Look>(i);
  }
  throw Error(fmt::format("look '{}': unknown; there are: {}", name, fmt::join(kLookNames, ", ")));
}

void validate(const PictureSettings& settings) {
  require(settings.width >= 1 && settings.width <= kMaxSide, "the width", settings.width, "1 to 65536 pixels");
  require(settings.height >= 1 && settings.height <= kMaxSide, "the height", settings.height, "1 to 65536 pixels");
  const std::int64_t pixels = std::int64_t{settings.width} * settings.height;
  if (pixels > kMaxPixels) {
    throw Error(fmt::format("picture: {} x {} are {} pixels; at most {} are made at once", settings.width,
                            settings.height, pixels, kMaxPixels));
  }
  require(settings.aa >= 1 && settings.aa <= 16, "the number of samples per side (aa)", settings.aa, "1 to 16");
  require(settings.haze >= 0 && settings.haze <= 0.95, "the haze", settings.haze, "0 to 0.95");
  require(std::isfinite(settings.error_tolerance) && settings.error_tolerance >= 0, "the error tolerance",
          settings.error_tolerance, "0 or more sides of a cell");
  validate(settings.sun);
  Ramp(ramp_of(settings), 0, 1);
}

Box picture_box(const HeightField& field, bool plinth) {
  return {{0, 0, plinth ? plinth_base(field) : field.min_height()}, {field.width(), field.depth(), field.max_height()}};
}

Picture render_picture(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                       const PictureSettings& settings, const Progress& progress) {
  validate(settings);
  const HeightField& field = scene.field();
  if (!field.has_cells()) {
    throw Error(fmt::format("picture: the field has {} x {} samples and so no cells; at least 2 x 2 samples are needed",
                            field.cols(), field.rows()));
  }
  if (field.all_nodata()) throw Error("picture: all samples of the field are nodata; there is nothing to see");
  switch (settings.look) {
    case Look::height:
      return {render_height(scene, camera, settings, progress), {}, {}};
    case Look::steps:
      return render_steps(scene, camera, settings, progress);
    case Look::error: {
      ErrorPicture error =
          render_error(scene, camera, settings.width, settings.height, settings.error_tolerance, progress);
      return {std::move(error.image), {}, error.counts};
    }
    case Look::shaded:
      break;
  }
  const Shader shader(scene, camera, grid_north_azimuth, settings);
  return {develop(
              settings.width, settings.height, settings.aa,
              [&](double x, double y) { return shader.colour(camera.ray(x, y)); }, progress),
          {},
          {}};
}

}  // namespace scarp
