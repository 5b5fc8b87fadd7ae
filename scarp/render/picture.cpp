// SPDX-License-Identifier: MIT
#include "scarp/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/render/ramp.h"
#include "scarp/render/shader.h"
#include "scarp/render/step_look.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 4> kLookNames = {"shaded", "height", "steps", "error"};

constexpr int kMaxSide = 65536;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
constexpr int kMaxSamples = 4096;

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("picture: {} is {}; it must be {}", what, value, range));
}

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
  const std::optional<Plinth> plinth = plinth_of(scene.field(), settings);
  const auto steps_of = [&](int x, int y) {
    MarchStats stats;
    look(scene, plinth, camera.ray(x + 0.5, y + 0.5), &stats);
    return stats.steps;
  };
  return picture_of_steps(settings, steps_of, progress);
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
  require(settings.samples >= 0 && settings.samples <= kMaxSamples, "the number of rays (samples)", settings.samples,
          "0 to 4096");
  require(settings.ao_distance >= 0, "the distance of ambient occlusion", settings.ao_distance, "0 or more metres");
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
  require_ground(scene.field());
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
              [&](const PicturePoint& point) { return shader.colour(point); }, progress),
          {},
          {}};
}

}  // namespace scarp
