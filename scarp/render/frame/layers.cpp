// SPDX-License-Identifier: MIT
#include "scarp/render/frame/layers.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "scarp/base/error.h"
#include "scarp/march/height/wall.h"
#include "scarp/render/frame/lake_tile.h"
#include "scarp/render/frame/shaded_tile.h"
#include "scarp/render/frame/sight.h"
#include "scarp/render/frame/tile_work.h"

namespace scarp {

namespace {

class LayersTile final : public TileWork {
 public:
  // `lake`: null where there is no water.
  LayersTile(const ShadedView& view, const LakeView* lake, const PixelTile& tile, PictureLayers& layers)
      : view_(view),
        tile_(tile),
        middles_(rays_through_middles(view.camera, tile)),
        looking_(view.plinth),
        shaded_(view, tile),
        layers_(layers) {
    if (lake) lake_.emplace(*lake, tile);
  }

  bool next(RayRound& round) override {
    if (!asked_) {
      asked_ = true;
      looking_.ask(middles_, true, round);
      return true;
    }
    if (!seen_) {
      seen_ = true;
      take_sights(round);
    }
    if (lake_ ? lake_->next(round) : shaded_.next(round)) return true;
    const std::vector<vec3> colours = lake_ ? lake_->pixels() : shaded_.pixels();
    for (std::size_t i = 0; i < colours.size(); ++i) layers_.colour[pixel(i)] = colours[i];
    return false;
  }

 private:
  // Of pixel i of the tile, in the layers.
  std::size_t pixel(std::size_t i) const {
    const auto across = static_cast<std::size_t>(tile_.x1 - tile_.x0);
    return (static_cast<std::size_t>(tile_.y0) + i / across) * static_cast<std::size_t>(layers_.width) +
           static_cast<std::size_t>(tile_.x0) + i % across;
  }

  void take_sights(const RayRound& round) {
    const Camera& camera = view_.camera;
    const std::vector<Sight> sights = looking_.answers(round);
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const Sight& sight = sights[i];
      const Ray& ray = middles_[i];
      const std::size_t to = pixel(i);
      layers_.steps[to] = sight.steps;
      if (const auto water = lake_ ? lake_->water_of(ray, sight) : std::nullopt) {
        layers_.depth[to] = static_cast<float>(dot(ray.at(water->t) - camera.eye(), camera.forward()));
        layers_.normal[to] = water->normal;
        layers_.position[to] = ray.at(water->t);
        continue;
      }
      if (!sight.hit && !sight.wall) continue;
      const dvec3 position = ray.at(sight.hit ? sight.hit.t : sight.wall->t);
      layers_.depth[to] = static_cast<float>(dot(position - camera.eye(), camera.forward()));
      layers_.normal[to] = !sight.hit       ? sight.wall->normal
                           : sight.hit.wall ? wall_normal(ray, sight.hit)
                                            : view_.shader.field().normal(sight.hit.cell, sight.hit.u, sight.hit.v);
      layers_.position[to] = position;
    }
  }

  const ShadedView& view_;
  PixelTile tile_;
  std::vector<Ray> middles_;
  SightRound looking_;
  ShadedTile shaded_;
  std::optional<LakeTile> lake_;
  PictureLayers& layers_;
  bool asked_ = false, seen_ = false;
};

}  // namespace

PictureLayers empty_layers(const PictureSettings& settings) {
  validate(settings);
  if (settings.look != Look::shaded) {
    throw Error(
        fmt::format("picture: layers go with the look 'shaded', not with '{}'; depth, position and steps are "
                    "layers themselves",
                    name_of(settings.look)));
  }
  const std::size_t pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
  return {settings.width,
          settings.height,
          std::vector<vec3>(pixels),
          std::vector<float>(pixels, std::numeric_limits<float>::infinity()),
          std::vector<vec3>(pixels, vec3(0.0f)),
          std::vector<vec3>(pixels, vec3(0.0f)),
          std::vector<std::uint32_t>(pixels)};
}

PictureLayers render_layers(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                            const PictureSettings& settings, const Progress& progress) {
  PictureLayers layers = empty_layers(settings);
  const HeightField& field = scene.field();
  require_ground(field);
  const Shader shader(field, camera, grid_north_azimuth, settings);
  const std::optional<Plinth> plinth = plinth_of(field, settings);
  const ShadedView view{camera, plinth, shader, settings.aa};
  std::optional<Lake> lake;
  if (settings.water) lake.emplace(scene, camera, grid_north_azimuth, settings);
  const LakeView* lake_view = lake ? &lake->view() : nullptr;
  work_on_tiles(
      scene, PixelTiles(settings.width, settings.height, settings.aa), lake ? lake->most_rays() : most_rays_of(shader),
      [&](const PixelTile& tile) { return std::make_unique<LayersTile>(view, lake_view, tile, layers); }, progress);
  return layers;
}

}  // namespace scarp
