// SPDX-License-Identifier: MIT
#include "scarp/render/frame/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/render/frame/shaded_tile.h"
#include "scarp/render/frame/shader.h"
#include "scarp/render/frame/sight.h"
#include "scarp/render/frame/tile_work.h"
#include "scarp/render/look/height_look.h"
#include "scarp/render/look/step_look.h"
#include "scarp/render/surface/ramp.h"
#ifdef SCARP_VULKAN
#include "scarp/render/frame/terrain_frame_vk.h"
#endif

namespace scarp {
namespace {

constexpr std::array<std::string_view, 5> kLookNames = {"shaded", "height", "steps", "error", "comanche"};

constexpr int kMaxSide = 65536;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
constexpr int kMaxSamples = 4096;

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("picture: {} is {}; it must be {}", what, value, range));
}

// Calls take(x, y, ray's sight) for each pixel of a tile.
template <class Take>
class LookingTile final : public TileWork {
 public:
  LookingTile(const Camera& camera, const std::optional<Plinth>& plinth, const PixelTile& tile, bool steps,
              const Take& take)
      : camera_(camera), tile_(tile), looking_(plinth), steps_(steps), take_(take) {}

  bool next(RayRound& round) override {
    if (!asked_) {
      asked_ = true;
      looking_.ask(rays_through_middles(camera_, tile_), steps_, round);
      return true;
    }
    const std::vector<Sight> sights = looking_.answers(round);
    std::size_t i = 0;
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      for (int x = tile_.x0; x < tile_.x1; ++x) take_(x, y, sights[i++]);
    }
    return false;
  }

 private:
  const Camera& camera_;
  PixelTile tile_;
  SightRound looking_;
  bool steps_, asked_ = false;
  const Take& take_;
};

template <class Take>
void look_through_middles(const TerrainScene& scene, const Camera& camera, const PictureSettings& settings, bool steps,
                          const Progress& progress, const Take& take) {
  const std::optional<Plinth> plinth = plinth_of(scene.field(), settings);
  const PixelTiles tiles(settings.width, settings.height, 1);
  const auto make = [&](const PixelTile& tile) {
    return std::make_unique<LookingTile<Take>>(camera, plinth, tile, steps, take);
  };
  work_on_tiles(scene, tiles, tiles[0].pixels(), make, progress);
}

Image render_height(const TerrainScene& scene, const Camera& camera, const PictureSettings& settings,
                    const Progress& progress) {
  Image image(settings.width, settings.height);
  const double low = scene.field().min_height(), high = scene.field().max_height();
  look_through_middles(scene, camera, settings, false, progress, [&](int x, int y, const Sight& sight) {
    if (sight.hit) std::fill_n(image.pixel(x, y), 3, grey_of_height(sight.hit.height, low, high));
  });
  return image;
}

Picture render_steps(const TerrainScene& scene, const Camera& camera, const PictureSettings& settings,
                     const Progress& progress) {
  const auto width = static_cast<std::size_t>(settings.width);
  std::vector<std::uint32_t> steps(width * static_cast<std::size_t>(settings.height));
  look_through_middles(scene, camera, settings, true, progress, [&](int x, int y, const Sight& sight) {
    steps[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = sight.steps;
  });
  return picture_of_steps(settings, steps);
}

class ImageTile final : public TileWork {
 public:
  ImageTile(const ShadedView& view, const PixelTile& tile, Image& image)
      : tile_(tile), shaded_(view, tile), image_(image) {}

  bool next(RayRound& round) override {
    if (shaded_.next(round)) return true;
    const std::vector<vec3> colours = shaded_.pixels();
    std::size_t i = 0;
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      for (int x = tile_.x0; x < tile_.x1; ++x) set_pixel(image_, x, y, colours[i++]);
    }
    return false;
  }

 private:
  PixelTile tile_;
  ShadedTile shaded_;
  Image& image_;
};

Image render_shaded(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                    const PictureSettings& settings, const Progress& progress) {
#ifdef SCARP_VULKAN
  if (makes_whole_frames(scene, camera, settings)) {
    return render_whole_frame(scene, camera, grid_north_azimuth, settings, progress);
  }
#endif
  const Shader shader(scene.field(), camera, grid_north_azimuth, settings);
  const std::optional<Plinth> plinth = plinth_of(scene.field(), settings);
  const ShadedView view{camera, plinth, shader, settings.aa};
  Image image(settings.width, settings.height);
  work_on_tiles(
      scene, PixelTiles(settings.width, settings.height, settings.aa), most_rays_of(shader),
      [&](const PixelTile& tile) { return std::make_unique<ImageTile>(view, tile, image); }, progress);
  return image;
}

}  // namespace

std::string_view name_of(Look look) { return kLookNames[static_cast<std::size_t>(look)]; }

Look find_look(std::string_view name) {
  for (std::size_t i = 0; i < kLookNames.size(); ++i) {
    if (kLookNames[i] == name) return static_cast<Look>(i);
  }
  throw Error(fmt::format("look '{}': unknown; there are: {}", name, fmt::join(kLookNames, ", ")));
}

std::string_view ramp_of(const PictureSettings& settings) {
  if (!settings.ramp.empty()) return settings.ramp;
  return settings.look == Look::steps ? "viridis" : "hypsometric";
}

Ramp ramp_over(const PictureSettings& settings, double low, double high, double scale) {
  if (settings.ramp_stops) return {*settings.ramp_stops, low, high, scale};
  return {ramp_of(settings), low, high};
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
  if (settings.water) validate(*settings.water);
  validate(settings.ground);
  validate(settings.fog);
  validate(settings.comanche);
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
    case Look::comanche:
      return render_comanche(scene, camera, grid_north_azimuth, settings, progress);
    case Look::shaded:
      break;
  }
  if (settings.water) return render_lake(scene, camera, grid_north_azimuth, settings, progress);
  return {render_shaded(scene, camera, grid_north_azimuth, settings, progress), {}, {}};
}

}  // namespace scarp
