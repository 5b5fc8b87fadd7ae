// SPDX-License-Identifier: MIT
#include "scarp/render/frame/mesh_picture_vk.h"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/frame/shaded_tile.h"
#include "scarp/render/frame/shader.h"
#include "scarp/render/frame/sight.h"
#include "scarp/render/frame/tile_work.h"

namespace scarp {
namespace {

constexpr std::int64_t kRowsPerPiece = 16;

void require_drawable(const PictureSettings& settings) {
  validate(settings);
  if (settings.look != Look::shaded)
    throw Error(fmt::format("mesh: goes with the look 'shaded', not with '{}'", name_of(settings.look)));
  if (settings.water) throw Error("mesh: is not reflected by water; leave one of both out");
}

// The terrain at all points of a picture, aa x aa for each pixel.
class PointsTile final : public TileWork {
 public:
  PointsTile(const ShadedView& view, const PixelTile& tile, DrawnPoints& points)
      : view_(view), shaded_(view, tile), points_(points) {}

  bool next(RayRound& round) override {
    if (shaded_.next(round)) return true;
    for (std::size_t i = 0; i < shaded_.points().size(); ++i) {
      const PicturePoint& point = shaded_.points()[i];
      const auto x = static_cast<std::size_t>(point.pixel_x * view_.aa + point.index % view_.aa),
                 y = static_cast<std::size_t>(point.pixel_y * view_.aa + point.index / view_.aa);
      const std::size_t to = y * static_cast<std::size_t>(points_.width) + x;
      points_.colour[to] = shaded_.colours()[i];
      const Sight& sight = shaded_.sights()[i];
      if (!sight.hit && !sight.wall) continue;
      const dvec3 met = shaded_.rays()[i].at(sight.hit ? sight.hit.t : sight.wall->t);
      points_.depth[to] = static_cast<float>(dot(met - view_.camera.eye(), view_.camera.forward()));
    }
    return false;
  }

 private:
  const ShadedView& view_;
  ShadedTile shaded_;
  DrawnPoints& points_;
};

DrawnPoints empty_points(int width, int height) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, std::vector<vec3>(count), std::vector<float>(count, std::numeric_limits<float>::infinity()),
          {},    {}};
}

// Colours of pixels, the means of their points, with the mesh.
class MeshPicture {
 public:
  MeshPicture(const TerrainScene& scene, MeshRaster& mesh, const Camera& camera, double grid_north_azimuth,
              const PictureSettings& settings)
      : scene_(scene),
        mesh_(mesh),
        camera_(camera),
        settings_(settings),
        shader_(scene.field(), camera, grid_north_azimuth, settings_) {
    mesh.require_drawable(settings.width * settings.aa, settings.height * settings.aa);
    if (settings.shadows) settings_.sun_shadow = mesh.cast_shadow(shader_.to_sun());
  }

  const PictureSettings& settings() const { return settings_; }

  std::vector<vec3> colours(const Progress& progress) const {
    const int aa = settings_.aa;
    DrawnPoints terrain = empty_points(settings_.width * aa, settings_.height * aa);
    const std::optional<Plinth> plinth = plinth_of(scene_.field(), settings_);
    const ShadedView view{camera_, plinth, shader_, aa};
    work_on_tiles(
        scene_, PixelTiles(settings_.width, settings_.height, aa), most_rays_of(shader_),
        [&](const PixelTile& tile) { return std::make_unique<PointsTile>(view, tile, terrain); }, progress);
    const DrawnPoints drawn = draw(terrain);
    std::vector<vec3> pixels(static_cast<std::size_t>(settings_.width) * static_cast<std::size_t>(settings_.height));
    parallel_for(settings_.height, kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
      std::vector<vec3> points(static_cast<std::size_t>(aa * aa));
      for (auto y = static_cast<int>(begin); y < end; ++y) {
        for (int x = 0; x < settings_.width; ++x) {
          for (int j = 0; j < aa; ++j) {
            for (int i = 0; i < aa; ++i)
              points[static_cast<std::size_t>(j * aa + i)] = colour(drawn, x * aa + i, y * aa + j);
          }
          pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(settings_.width) +
                 static_cast<std::size_t>(x)] = mean_colour(points);
        }
      }
    });
    return pixels;
  }

  DrawnPoints draw(const DrawnPoints& terrain) const {
    return mesh_.draw(camera_, terrain, shader_.lighting().light(), settings_.shadows);
  }
  // Through a point of so many across the picture.
  Ray ray(const DrawnPoints& of, int x, int y) const {
    const double across = static_cast<double>(settings_.width) / of.width;
    return camera_.ray((x + 0.5) * across, (y + 0.5) * across);
  }
  // Where along the ray a view depth is.
  double time(const Ray& ray, float depth) const {
    return (static_cast<double>(depth) - dot(ray.origin - camera_.eye(), camera_.forward())) /
           dot(ray.direction, camera_.forward());
  }

 private:
  vec3 colour(const DrawnPoints& drawn, int x, int y) const {
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(drawn.width) + static_cast<std::size_t>(x);
    if (!drawn.mesh[at]) return drawn.colour[at];
    const Ray through = ray(drawn, x, y);
    return shader_.in_air(drawn.colour[at], through, time(through, drawn.depth[at]));
  }

  const TerrainScene& scene_;
  MeshRaster& mesh_;
  const Camera& camera_;
  PictureSettings settings_;
  Shader shader_;
};

}  // namespace

Picture render_with_mesh(const TerrainScene& scene, MeshRaster& mesh, const Camera& camera, double grid_north_azimuth,
                         const PictureSettings& settings, const Progress& progress) {
  require_drawable(settings);
  require_ground(scene.field());
  const std::vector<vec3> colours = MeshPicture(scene, mesh, camera, grid_north_azimuth, settings).colours(progress);
  Image image(settings.width, settings.height);
  std::size_t i = 0;
  for (int y = 0; y < settings.height; ++y) {
    for (int x = 0; x < settings.width; ++x) set_pixel(image, x, y, colours[i++]);
  }
  return {std::move(image), {}, {}};
}

PictureLayers render_layers_with_mesh(const TerrainScene& scene, MeshRaster& mesh, const Camera& camera,
                                      double grid_north_azimuth, const PictureSettings& settings,
                                      const Progress& progress) {
  require_drawable(settings);
  const MeshPicture picture(scene, mesh, camera, grid_north_azimuth, settings);
  PictureSettings middles = picture.settings();
  middles.aa = 1;
  PictureLayers layers = render_layers(scene, camera, grid_north_azimuth, middles);
  const DrawnPoints drawn = picture.draw({layers.width, layers.height, layers.colour, layers.depth, {}, {}});
  for (int y = 0; y < layers.height; ++y) {
    for (int x = 0; x < layers.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(layers.width) + static_cast<std::size_t>(x);
      if (!drawn.mesh[i]) continue;
      const Ray ray = picture.ray(drawn, x, y);
      layers.depth[i] = drawn.depth[i];
      layers.normal[i] = drawn.normal[i];
      layers.position[i] = vec3(ray.at(picture.time(ray, drawn.depth[i])));
    }
  }
  layers.colour = picture.colours(progress);
  return layers;
}

}  // namespace scarp
