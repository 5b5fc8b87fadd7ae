// SPDX-License-Identifier: MIT
#include "scarp/render/frame/layers.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/render/film/middles.h"
#include "scarp/render/film/tile_work.h"
#include "scarp/render/frame/frame_tile.h"

namespace scarp {
namespace {

class LayersTile final : public TileWork {
 public:
  LayersTile(const FrameView& view, const PixelTile& tile, PictureLayers& layers)
      : view_(view),
        tile_(tile),
        middles_(rays_through_middles(view.camera(), tile)),
        frame_(view, tile, view.settings().aa),
        layers_(layers) {}

  bool next(RayRound& round) override {
    if (const StepMarch* march = view_.step_march(); march && !seen_) {
      asked_ = seen_ = true;
      for (std::size_t i = 0; i < middles_.size(); ++i) take_stepped(i, march->march(middles_[i], view_.water()));
    }
    if (!asked_) {
      asked_ = true;
      round.question = RayRound::Question::closest_cost;
      round.rays = middles_;
      round.from.clear();
      return true;
    }
    if (!seen_) {
      seen_ = true;
      for (std::size_t i = 0; i < middles_.size(); ++i)
        take(i, round.hits[i], round.steps[i], frame_.water_of(middles_[i], round.hits[i]));
    }
    if (frame_.next(round)) return true;
    const std::vector<vec3> colours = frame_.pixels();
    for (std::size_t i = 0; i < colours.size(); ++i) layers_.colour[pixel(i)] = colours[i];
    return false;
  }

 private:
  // Index in the layers of pixel i of the tile.
  std::size_t pixel(std::size_t i) const {
    const auto across = static_cast<std::size_t>(tile_.x1 - tile_.x0);
    return (static_cast<std::size_t>(tile_.y0) + i / across) * static_cast<std::size_t>(layers_.width) +
           static_cast<std::size_t>(tile_.x0) + i % across;
  }

  void take_stepped(std::size_t i, const StepMarch::Answer& answer) {
    std::optional<Water::Meeting> water;
    if (answer.water) {
      water = {answer.t, {0, 0, 1}, {}};
    } else if (view_.water() && view_.water()->is_sea(answer.hit)) {
      water = {answer.hit.t, {0, 0, 1}, answer.hit};
    }
    take(i, answer.hit, answer.steps, water);
  }

  void take(std::size_t i, const Hit& hit, std::uint32_t steps, const std::optional<Water::Meeting>& water) {
    const Ray& ray = middles_[i];
    const std::size_t to = pixel(i);
    layers_.steps[to] = steps;
    if (!hit && !water) return;
    const dvec3 position = ray.at(water ? water->t : hit.t);
    layers_.depth[to] = static_cast<float>(dot(position - view_.camera().eye(), view_.camera().forward()));
    layers_.normal[to] = water ? water->normal : view_.scene().surface(ray, hit).normal;
    layers_.position[to] = position;
  }

  const FrameView& view_;
  PixelTile tile_;
  std::vector<Ray> middles_;
  FrameTile frame_;
  PictureLayers& layers_;
  bool asked_ = false, seen_ = false;
};

}  // namespace

PictureLayers empty_layers(const PictureSettings& settings) {
  validate(settings);
  if (!entry_of(settings.look).lit || (settings.look == Look::comanche && settings.comanche.heights)) {
    throw Error(fmt::format(
        "picture: look '{}': only 'shaded' and 'comanche' have layers; depth, position and steps are layers themselves",
        name_of(settings.comanche.heights ? Look::height : settings.look)));
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

PictureLayers render_layers(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                            const Progress& progress) {
  PictureLayers layers = empty_layers(settings);
  require_visible(scene);
  const FrameView view(scene, camera, settings);
  work_on_tiles(
      scene, PixelTiles(settings.width, settings.height, settings.aa), most_rays_of(view),
      [&](const PixelTile& tile) { return std::make_unique<LayersTile>(view, tile, layers); }, progress);
  const int side = pixel_side(settings);
  if (side == 1) return layers;
  const auto scaled = [&]<class Value>(std::vector<Value>& values) {
    std::vector<Value> large;
    large.reserve(values.size() * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int y = 0; y < layers.height * side; ++y) {
      for (int x = 0; x < layers.width * side; ++x)
        large.push_back(values[static_cast<std::size_t>(y / side) * static_cast<std::size_t>(layers.width) +
                               static_cast<std::size_t>(x / side)]);
    }
    values = std::move(large);
  };
  scaled(layers.colour), scaled(layers.depth), scaled(layers.normal), scaled(layers.position), scaled(layers.steps);
  layers.width *= side, layers.height *= side;
  return layers;
}

}  // namespace scarp
