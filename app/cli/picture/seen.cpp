// SPDX-License-Identifier: MIT
#include "app/cli/picture/seen.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "app/options/numbers.h"

namespace scarp::cli {
namespace {

constexpr double kLeastSeen = 0.005;     // fraction of the pixels
constexpr double kLeastContrast = 0.02;  // smallest contrast that is visible through fog; see fog.h
constexpr double kMostRays = 8192;       // kLeastSeen is about 40 of them, with a relative error of a few tenths

// The relief of natural ground is a small fraction of its extent; even a single cliff is rarely four times as high as
// wide.
constexpr double kTooSteep = 4;
constexpr double kNearlyAll = 0.99;  // fraction of samples that are holes

double longer_side(const HeightField& field) { return std::max(field.width(), field.depth()); }

double exaggeration_of(const Scene& scene) { return scene.terrain() ? scene.terrain()->settings().exaggeration : 1; }

bool is_on_scene(const Scene& scene, const Hit& hit) { return hit && !scene.field_of(hit.object).is_backdrop(); }

// Distance in metres from a point to a box; 0 inside.
double way_to(const WorldBox& box, const dvec3& p) {
  return length(glm::max(glm::max(box.low - p, p - box.high), dvec3(0.0)));
}

// A box in the picture.
struct Projected {
  int in_front = 0;  // corners
  dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

Projected project(const WorldBox& box, const Camera& camera) {
  Projected seen;
  for (int i = 0; i < 8; ++i) {
    const auto at = camera.pixel(box.corner(i));
    if (!at) continue;
    ++seen.in_front;
    seen.low = glm::min(seen.low, *at), seen.high = glm::max(seen.high, *at);
  }
  return seen;
}

// Whether a sample of these pixels shows the object.
bool shows(const Scene& scene, std::uint32_t object, const Camera& camera, const PixelTile& pixels, int aa) {
  std::vector<Ray> rays;
  for (PixelTile row = pixels; row.y0 < pixels.y1; ++row.y0) {
    row.y1 = row.y0 + 1;
    rays.clear();
    for (const PicturePoint& point : points_of(row, aa)) rays.push_back(camera.ray(point.x, point.y));
    std::vector<Hit> hits(rays.size());
    scene.closest_hits(rays, hits);
    if (std::any_of(hits.begin(), hits.end(), [object](const Hit& hit) { return hit && hit.object == object; }))
      return true;
  }
  return false;
}

std::string of_eye_below(const Scene& scene, const Camera& camera) {
  const auto ground = scene.height(camera.eye().x, camera.eye().y);
  if (!ground || camera.eye().z >= *ground) return {};
  return fmt::format("the eye is {} m below the ground (raise --eye)", metres_text(*ground - camera.eye().z));
}

std::string of_water(const Scene& scene, const PictureSettings& picture, const BlankFacts& facts,
                     const SeenShares& seen) {
  if (!picture.water || seen.under_water == 0) return {};
  const double level = picture.water->level, highest = facts.heights.high / exaggeration_of(scene);
  if (level > highest)
    return fmt::format("--water {:.6g} is above all ground, whose highest is {:.6g} m", level, highest);
  return fmt::format("water at {:.6g} m covers the ground in view (lower --water, or move the camera)", level);
}

std::string of_fog(const PictureSettings& picture, const SeenShares& seen) {
  if (seen.in_fog == 0) return {};
  return fmt::format(
      "fog with a visibility of {} m hides the surfaces, of which the nearest is {} m away "
      "(--visibility)",
      metres_text(picture.fog.visibility), metres_text(seen.nearest));
}

std::string of_holes(const Scene& scene) {
  const HeightField* field = scene.terrain();
  if (!field) return {};
  const double share =
      static_cast<double>(field->nodata_count()) / (static_cast<double>(field->cols()) * field->rows());
  if (share < kNearlyAll) return {};
  return fmt::format("{:.6g} % of the samples are holes (see 'scarp info --statistics', --nodata)", 100 * share);
}

std::string of_steepness(const Scene& scene) {
  const HeightField* field = scene.terrain();
  if (!field || field->wraps()) return {};
  const double relief = field->max_height() - field->min_height(), side = longer_side(*field);
  if (!(relief > kTooSteep * side)) return {};
  return fmt::format(
      "heights span {:.6g} m ({:.6g} to {:.6g}) over {:.6g} m of ground (see 'scarp info --statistics'; --nodata if "
      "one of these marks holes, --height-range or --scale for the heights, --bounds and --crs for the ground, "
      "--exaggeration)",
      relief, field->min_height(), field->max_height(), side);
}

std::string of_reach(const Scene& scene, const Camera& camera, const BlankFacts& facts) {
  const double reach = facts.function_reach > 0 ? std::min(camera.reach(), facts.function_reach) : camera.reach();
  if (!std::isfinite(reach)) return {};
  double way = scene.box().empty() || scene.wraps() ? 0 : way_to(scene.box(), camera.eye());
  if (const auto ground = scene.height(camera.eye().x, camera.eye().y); ground && way == 0)
    way = camera.eye().z - *ground;
  if (way <= reach) return {};
  return fmt::format("rays end after {} m ({}), but the scene is {} m away", metres_text(reach),
                     facts.function_reach > 0 ? "--function-reach" : "--reach", metres_text(way));
}

// Where the scene is in the picture.
std::string of_view(const Scene& scene, const Camera& camera, int width, int height, bool area) {
  if (scene.endless() || scene.wraps()) {
    return camera.forward().z >= 0 ? "the camera looks at the sky (lower --target)" : "";
  }
  const Projected box = project(scene.box(), camera);
  if (box.in_front == 0) return "the scene is behind the eye (--target)";
  const dvec2 size(width, height);
  if (box.high.x < 0 || box.high.y < 0 || box.low.x > size.x || box.low.y > size.y)
    return area ? "--area is beside the scene" : "the camera looks past the scene (--target)";
  const dvec2 extent = glm::min(box.high, size) - glm::max(box.low, dvec2(0.0));
  // If the box covers few pixels, a surface in it covers even fewer.
  constexpr double kSmall = 4 * kLeastSeen;
  if (box.in_front == 8 && extent.x * extent.y < kSmall * size.x * size.y) {
    if (area) return "--area has little of the scene in it";
    const dvec3 sides = scene.box().high - scene.box().low;
    return fmt::format("the scene is {} m away and {} m wide (move the eye closer, or use a smaller --fov)",
                       metres_text(way_to(scene.box(), camera.eye())),
                       metres_text(std::max({sides.x, sides.y, sides.z})));
  }
  return {};
}

std::string of_one_colour(const Scene& scene, const SeenShares& seen) {
  if (seen.inside > 0) return "the eye is inside a solid (move --eye)";
  if (const HeightField* field = scene.terrain(); field && field->min_height() == field->max_height())
    return fmt::format("the terrain is flat, all heights are {:.6g} m", field->min_height());
  return "level ground, or one plain surface";
}

}  // namespace

SeenShares seen_shares(const Scene& scene, const Camera& camera, const PictureSettings& picture) {
  const int width = picture.width, height = picture.height;
  const double water_level =
      picture.water ? picture.water->level * exaggeration_of(scene) : -std::numeric_limits<double>::infinity();
  const double step = std::max(1.0, std::sqrt(static_cast<double>(width) * height / kMostRays));
  const int cols = std::max(1, static_cast<int>(width / step)), rows = std::max(1, static_cast<int>(height / step));
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  const auto middle = [](int i, int of, int pixels) { return std::floor((i + 0.5) * pixels / of) + 0.5; };
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col)
      rays.push_back(camera.ray(middle(col, cols, width), middle(row, rows, height)));
  }
  std::vector<Hit> hits(rays.size());
  scene.closest_hits(rays, hits);
  int surfaces = 0, under_water = 0, in_fog = 0, inside = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!is_on_scene(scene, hits[i])) continue;
    const double t = hits[i].t;
    if (rays[i].at(t).z < water_level) {
      ++under_water;
    } else if (transmittance(picture.fog, rays[i], t) < kLeastContrast) {
      ++in_fog;
    } else {
      ++surfaces;
    }
    if (t == 0) ++inside;
    nearest = std::min(nearest, t);
  }
  const auto all = static_cast<double>(hits.size());
  return {surfaces / all, under_water / all, in_fog / all, inside / all, std::isfinite(nearest) ? nearest : 0};
}

bool has_one_colour(const Image& image) {
  return image.rgb.size() >= 3 && std::equal(image.rgb.begin() + 3, image.rgb.end(), image.rgb.begin());
}

bool has_one_colour(const PictureLayers& layers) {
  return std::all_of(layers.colour.begin(), layers.colour.end(),
                     [&](const vec3& colour) { return colour == layers.colour.front(); });
}

std::string why_blank(const Scene& scene, const Camera& camera, const PictureSettings& picture,
                      const BlankFacts& facts) {
  const SeenShares seen = seen_shares(scene, camera, picture);
  if (seen.surfaces >= kLeastSeen) {
    return facts.one_colour ? fmt::format("all pixels have one colour: {}", of_one_colour(scene, seen)) : "";
  }
  std::string why = of_eye_below(scene, camera);
  if (why.empty()) why = of_water(scene, picture, facts, seen);
  if (why.empty()) why = of_fog(picture, seen);
  if (why.empty()) why = of_holes(scene);
  if (why.empty()) why = of_reach(scene, camera, facts);
  if (why.empty()) why = of_steepness(scene);
  if (why.empty()) why = of_view(scene, camera, picture.width, picture.height, facts.area);
  if (why.empty() && facts.area) why = "--area has hardly any surfaces in it";
  if (why.empty()) why = "the camera looks past all surfaces, or along them (--view, --eye, --target)";
  return fmt::format("{:.2g} % of the pixels show a surface of the scene: {}", 100 * seen.surfaces, why);
}

std::string why_unseen(const Scene& scene, std::uint32_t object, const Camera& camera, const PictureSettings& picture) {
  SceneObject alone = scene.objects()[object];
  const SceneFieldPtr field = scene.fields()[alone.field];
  alone.field = 0;
  const WorldBox box = Scene({field}, {alone}).box();
  const dvec2 size(picture.width, picture.height);
  const Projected seen = project(box, camera);
  if (seen.in_front == 0) return "is behind the eye (--target, --mesh-at)";
  PixelTile pixels{0, 0, picture.width, picture.height};
  if (seen.in_front == 8) {
    if (seen.high.x <= 0 || seen.high.y <= 0 || seen.low.x >= size.x || seen.low.y >= size.y)
      return "is outside the picture (--target, --mesh-at)";
    const dvec2 extent = seen.high - seen.low;
    if (std::max(extent.x, extent.y) < 1) {
      const dvec3 sides = box.high - box.low;
      return fmt::format(
          "is smaller than a pixel: {} m wide, {} m away (move the eye closer, or use a smaller --fov or a larger "
          "--mesh-scale)",
          metres_text(std::max({sides.x, sides.y, sides.z})), metres_text(way_to(box, camera.eye())));
    }
    const dvec2 low = glm::max(glm::floor(seen.low), dvec2(0.0)), high = glm::min(glm::ceil(seen.high), size);
    pixels = {static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x), static_cast<int>(high.y)};
  }
  if (shows(scene, object, camera, pixels, entry_of(picture.look).antialiased ? picture.aa : 1)) return {};
  return "is hidden: other surfaces are in front of it, or it is thinner than a pixel (--eye, --mesh-at)";
}

void BlankPictures::add(const std::string& name, const std::string& why) {
  ++pictures_;
  if (why.empty()) return;
  if (++blank_ == 1) first_ = name, why_ = why;
}

bool BlankPictures::tell() const {
  if (blank_ == 0) return false;
  const std::string which =
      pictures_ == 1 ? first_ : fmt::format("{} of {} frames are blank, first {}", blank_, pictures_, first_);
  fmt::print(stderr, "warning: {}: {}\n", which, why_);
  return true;
}

std::string note_on_low_water(const Scene& scene, const PictureSettings& picture, const BlankFacts& facts) {
  const double lowest = facts.heights.low / exaggeration_of(scene);
  if (!picture.water || !(picture.water->level < lowest)) return {};
  return fmt::format("--water {:.6g} is below all ground, whose lowest is {:.6g} m", picture.water->level, lowest);
}

}  // namespace scarp::cli
