// SPDX-License-Identifier: MIT
#include "scarp/render/frame/scene_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/light/lighting.h"
#include "scarp/render/light/sky.h"
#include "scarp/render/look/height_look.h"
#include "scarp/render/look/step_look.h"
#include "scarp/render/surface/surface_colour.h"

namespace scarp {
namespace {

// Of one batch to the light; and points of the picture, and rays of them to the light, when a device answers: each call
// takes as long for one ray as for thousands.
constexpr std::size_t kLightRaysAtOnce = 8192;
constexpr std::size_t kPointsAtOnce = 1 << 17, kDeviceLightRaysAtOnce = 1 << 18;
constexpr std::int64_t kSurfacesPerPiece = 2048;

class SceneShader {
 public:
  SceneShader(const Scene& scene, const SceneLook& look, const Camera& camera, const PictureSettings& settings)
      : scene_(scene),
        camera_(camera),
        colours_(look.materials),
        lighting_(settings, 0, settings.ao_distance),
        haze_per_metre_(1 / look.haze_distance) {}

  /// Of points of a picture, in linear light.
  std::vector<vec3> colours(const std::vector<PicturePoint>& points) const {
    std::vector<SceneRay> rays;
    for (const PicturePoint& point : points) rays.push_back({camera_.ray(point.x, point.y)});
    std::vector<SceneHit> hits(rays.size());
    scene_.closest_hits(rays, hits);
    std::vector<vec3> colours(rays.size());
    std::vector<SceneSurface> surfaces(rays.size());
    parallel_for(static_cast<std::int64_t>(rays.size()), kSurfacesPerPiece, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        if (hits[i]) surfaces[i] = scene_.surface(rays[i].ray, hits[i]);
      }
    });
    const std::size_t rays_at_once = scene_.on_device() ? kDeviceLightRaysAtOnce : kLightRaysAtOnce;
    Open open;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i]) {
        colours[i] = sky_colour(rays[i].ray.direction.z);
        continue;
      }
      const SceneSurface& surface = surfaces[i];
      colours[i] = colours_(surface);
      // The camera is inside: its colour is all there is to see.
      if (surface.normal == dvec3(0.0)) continue;
      const GroundPoint ground{surface.position, {}, surface.normal, surface.shading_normal, surface.openness};
      open.points.push_back({i, ground, lighting_.ask(ground, points[i], open.rays)});
      for (std::size_t ray_of_light = open.from.size(); ray_of_light < open.rays.size(); ++ray_of_light)
        open.from.push_back(&hits[i]);
      if (open.rays.size() + lighting_.most_rays() > rays_at_once) light(rays, hits, open, colours);
    }
    light(rays, hits, open, colours);
    return colours;
  }

 private:
  // Points whose light has been asked for.
  struct Open {
    struct Point {
      std::size_t index;
      GroundPoint ground;
      LightRays asked;
    };
    std::vector<Point> points;
    std::vector<Ray> rays;
    std::vector<const SceneHit*> from;
  };

  void light(std::span<const SceneRay> seen, std::span<const SceneHit> hits, Open& open,
             std::vector<vec3>& colours) const {
    std::vector<SceneRay> rays;
    for (std::size_t i = 0; i < open.rays.size(); ++i) rays.push_back({open.rays[i], open.from[i]});
    std::vector<std::uint8_t> blocked(rays.size());
    scene_.occluded(rays, blocked);
    for (const auto& [index, ground, asked] : open.points) {
      const vec3 lit = colours[index] * lighting_.on(ground, asked, open.rays, blocked);
      colours[index] = in_haze(lit, seen[index].ray, hits[index].t());
    }
    open = {};
  }

  // Haze has the colour that the sky has behind it, near the horizon.
  vec3 in_haze(vec3 colour, const Ray& ray, double t) const {
    const auto clear = static_cast<float>(std::exp(-haze_per_metre_ * t));
    return colour * clear + sky_colour(std::max(0.0, ray.direction.z)) * (1 - clear);
  }

  const Scene& scene_;
  const Camera& camera_;
  SurfaceColours colours_;
  Lighting lighting_;
  double haze_per_metre_;
};

void require(const SceneLook& look, const PictureSettings& settings) {
  validate(settings);
  if (!(look.haze_distance > 0)) {
    throw Error(fmt::format("picture: the distance of haze is {}; it must be above 0 metres", look.haze_distance));
  }
}

// body(points, aa x aa for each pixel): tile by tile on all threads, or many tiles at once when a device answers.
template <class Body>
void for_each_tile(const Scene& scene, const PictureSettings& settings, int aa, const Progress& progress,
                   const Body& body) {
  const PixelTiles tiles(settings.width, settings.height, aa);
  if (scene.on_device()) {
    std::vector<PicturePoint> points;
    for (std::int64_t tile = 0; tile < tiles.count(); ++tile) {
      const std::vector<PicturePoint> of_tile = points_of(tiles[tile], aa);
      points.insert(points.end(), of_tile.begin(), of_tile.end());
      if (points.size() < kPointsAtOnce && tile + 1 < tiles.count()) continue;
      body(points);
      points.clear();
      if (progress && !progress(static_cast<double>(tile + 1) / static_cast<double>(tiles.count())))
        throw Interrupted();
    }
    return;
  }
  parallel_for(
      tiles.count(), 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t tile = begin; tile < end; ++tile) body(points_of(tiles[tile], aa));
      },
      progress);
}

// take(x, y, mean colour)
template <class Take>
void shade(const Scene& scene, const SceneLook& look, const Camera& camera, const PictureSettings& settings,
           const Progress& progress, const Take& take) {
  const SceneShader shader(scene, look, camera, settings);
  const auto per_pixel = static_cast<std::size_t>(settings.aa) * static_cast<std::size_t>(settings.aa);
  for_each_tile(scene, settings, settings.aa, progress, [&](const std::vector<PicturePoint>& points) {
    const std::vector<vec3> colours = shader.colours(points);
    for (std::size_t i = 0; i < points.size(); i += per_pixel)
      take(points[i].pixel_x, points[i].pixel_y, mean_colour(std::span(colours).subspan(i, per_pixel)));
  });
}

std::size_t place_of(const PictureSettings& settings, const PicturePoint& point) {
  return static_cast<std::size_t>(point.pixel_y) * static_cast<std::size_t>(settings.width) +
         static_cast<std::size_t>(point.pixel_x);
}

// take(index of the pixel, ray through its middle, hit, steps)
template <class Take>
void look_through_middles(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                          const Progress& progress, const Take& take) {
  for_each_tile(scene, settings, 1, progress, [&](const std::vector<PicturePoint>& points) {
    std::vector<SceneRay> rays;
    for (const PicturePoint& point : points) rays.push_back({camera.ray(point.x, point.y)});
    std::vector<SceneHit> hits(rays.size());
    std::vector<std::uint32_t> steps(rays.size());
    scene.closest_hits(rays, hits, steps);
    for (std::size_t i = 0; i < rays.size(); ++i) take(place_of(settings, points[i]), rays[i].ray, hits[i], steps[i]);
  });
}

}  // namespace

Box picture_box(const Scene& scene) {
  const WorldBox& box = scene.box();
  if (!(box.low.x <= box.high.x)) {
    throw Error(scene.endless() ? "picture: nothing in the scene has an end that a camera could be framed by; give the "
                                  "camera an eye and a target"
                                : "picture: nothing in the scene can be seen");
  }
  return {box.low, box.high};
}

Picture render_scene(const Scene& scene, const SceneLook& look, const Camera& camera, const PictureSettings& settings,
                     const Progress& progress) {
  require(look, settings);
  if (settings.look == Look::steps) {
    std::vector<std::uint32_t> steps(static_cast<std::size_t>(settings.width) *
                                     static_cast<std::size_t>(settings.height));
    look_through_middles(scene, camera, settings, progress,
                         [&](std::size_t i, const Ray&, const SceneHit&, std::uint32_t cost) { steps[i] = cost; });
    return picture_of_steps(settings, steps);
  }
  if (settings.look == Look::height) {
    std::vector<double> heights(static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height),
                                std::numeric_limits<double>::quiet_NaN());
    look_through_middles(scene, camera, settings, progress,
                         [&](std::size_t i, const Ray& ray, const SceneHit& hit, std::uint32_t) {
                           if (hit) heights[i] = ray.at(hit.t()).z;
                         });
    return picture_of_heights(settings, heights);
  }
  if (settings.look != Look::shaded) {
    throw Error(fmt::format("look '{}': scenes and voxels have none; there are: shaded, height, steps",
                            name_of(settings.look)));
  }
  Image image(settings.width, settings.height);
  shade(scene, look, camera, settings, progress, [&](int x, int y, vec3 colour) { set_pixel(image, x, y, colour); });
  return {std::move(image), {}, {}};
}

PictureLayers render_scene_layers(const Scene& scene, const SceneLook& look, const Camera& camera,
                                  const PictureSettings& settings, const Progress& progress) {
  require(look, settings);
  PictureLayers layers = empty_layers(settings);
  // The middles are a small part of the work.
  look_through_middles(scene, camera, settings, {},
                       [&](std::size_t i, const Ray& ray, const SceneHit& hit, std::uint32_t cost) {
                         layers.steps[i] = cost;
                         if (!hit) return;
                         const SceneSurface surface = scene.surface(ray, hit);
                         layers.depth[i] = static_cast<float>(dot(surface.position - camera.eye(), camera.forward()));
                         layers.normal[i] = surface.normal;
                         layers.position[i] = surface.position;
                       });
  const auto width = static_cast<std::size_t>(settings.width);
  shade(scene, look, camera, settings, progress, [&](int x, int y, vec3 colour) {
    layers.colour[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = colour;
  });
  return layers;
}

}  // namespace scarp
