// SPDX-License-Identifier: MIT
#include "scarp/render/frame/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/setting.h"
#include "scarp/render/film/middles.h"
#include "scarp/render/film/tile_work.h"
#include "scarp/render/frame/frame_tile.h"
#include "scarp/render/light/light.h"
#include "scarp/render/look/cost_look.h"
#include "scarp/render/look/height_look.h"
#include "scarp/render/look/hillshade_look.h"
#include "scarp/render/look/level_look.h"
#include "scarp/render/look/relief_look.h"
#include "scarp/render/look/step_look.h"
#ifdef SCARP_VULKAN
#include "scarp/render/frame/terrain_frame_vk.h"
#endif

namespace scarp {
namespace {

constexpr int kMaxSide = 65536;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
constexpr int kMaxSamples = 4096;

ImageSize size_of(const PictureSettings& settings) { return {settings.width, settings.height}; }

class ImageTile final : public TileWork {
 public:
  ImageTile(const FrameView& view, const PixelTile& tile, const CameraSights* sights, Image& image)
      : tile_(tile),
        frame_(view, tile, view.settings().aa, sights),
        tones_(uses_tone_curve(view.settings())),
        image_(image) {}

  bool next(RayRound& round) override {
    if (frame_.next(round)) return true;
    const std::vector<vec3> colours = image_.alpha.empty() ? frame_.pixels() : means_of_shown();
    std::size_t i = 0;
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      for (int x = tile_.x0; x < tile_.x1; ++x, ++i) set_pixel(image_, x, y, tones_ ? toned(colours[i]) : colours[i]);
    }
    return false;
  }

 private:
  // Mean colours of pixels over the points that show something; sets the opacity.
  std::vector<vec3> means_of_shown() {
    const std::vector<vec3> colours = frame_.colours();
    const std::vector<bool> shown = frame_.shown();
    const std::size_t per_pixel = colours.size() / tile_.pixels();
    std::vector<vec3> means;
    std::vector<vec3> points;
    for (std::size_t first = 0; first < colours.size(); first += per_pixel) {
      points.clear();
      for (std::size_t i = first; i < first + per_pixel; ++i) {
        if (shown[i]) points.push_back(colours[i]);
      }
      const std::size_t pixel = means.size(), across = static_cast<std::size_t>(tile_.x1 - tile_.x0);
      image_.opacity(tile_.x0 + static_cast<int>(pixel % across), tile_.y0 + static_cast<int>(pixel / across)) =
          opacity_byte(points.size(), per_pixel);
      means.push_back(points.empty() ? vec3(0.0f) : mean_colour(points));
    }
    return means;
  }

  PixelTile tile_;
  FrameTile frame_;
  bool tones_;
  Image& image_;
};

// On a device, only whole frames support the stepped rays of `comanche`.
void require_steps(const Scene& scene) {
  if (scene.on_device() && scene.sampling() == Sampling::fixed_step) {
    throw Error(
        "comanche: on a device the eye must be within 2^22 cells of the field for fixed-step (use max-mip, or the "
        "CPU)");
  }
}

Picture render_lit(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                   const Progress& progress) {
#ifdef SCARP_VULKAN
  if (makes_whole_frames(scene, camera, settings)) return {render_whole_frame(scene, camera, settings, progress)};
#endif
  if (settings.look == Look::comanche) require_steps(scene);
  const FrameView view(scene, camera, settings);
  Image image(settings.width, settings.height);
  if (settings.alpha) image.make_transparent();
  const auto make = [&](const PixelTile& tile, const CameraSights* sights) {
    return std::make_unique<ImageTile>(view, tile, sights, image);
  };
  const PixelTiles tiles(settings.width, settings.height, settings.aa);
  if (counts_steps(view)) {
    work_on_tiles(
        scene, tiles, most_rays_of(view), [&](const PixelTile& tile) { return make(tile, nullptr); }, progress);
  } else {
    work_on_camera_tiles(scene, camera, settings.width, settings.height, settings.aa, most_rays_of(view), make,
                         progress);
  }
  return {std::move(image)};
}

Picture render_hillshade(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                         const Progress& progress) {
  Picture picture{Image(settings.width, settings.height)};
  const dvec3 to_sun = Light(settings.sun, settings.grid_north_azimuth).to_sun();
  look_through_middles(scene, camera, size_of(settings), false, progress,
                       [&](std::size_t i, const Ray& ray, const Hit& hit, std::uint32_t) {
                         if (!hit || scene.field_of(hit.object).is_backdrop()) return;
                         const auto width = static_cast<std::size_t>(settings.width);
                         std::fill_n(picture.image.pixel(static_cast<int>(i % width), static_cast<int>(i / width)), 3,
                                     grey_of_normal(scene.surface(ray, hit).shading_normal, to_sun));
                       });
  return picture;
}

// One NaN per pixel.
std::vector<double> no_heights(const PictureSettings& settings) {
  return std::vector<double>(static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height),
                             std::numeric_limits<double>::quiet_NaN());
}

#ifdef SCARP_VULKAN
// Heights that the rays of a whole frame hit; the frame is rendered without light, water and fog.
std::vector<double> heights_of_whole_frame(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                                           const Progress& progress) {
  PictureSettings bare;
  bare.look = settings.look;
  bare.width = settings.width, bare.height = settings.height;
  bare.aa = 1;
  bare.unlit = true;
  bare.comanche = settings.comanche;
  FrameReport report{.tells_sightings = true};
  render_whole_frame(scene, camera, bare, progress, &report);
  std::vector<double> heights = no_heights(settings);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const FrameSighting& seen = report.sightings[i];
    if (seen.kind != FrameSighting::Kind::ground) continue;
    const auto width = static_cast<std::size_t>(settings.width);
    heights[i] = camera.ray(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5).at(seen.t).z;
  }
  return heights;
}
#endif

// Pictures of one terrain can be compared: they share its range. Nullopt: the range of the heights in the picture.
std::optional<ReliefRange> range_of_grey(const Scene& scene, const PictureSettings& settings) {
  if (settings.ramp_range) return ramp_heights(scene, settings);
  const HeightField* field = scene.terrain();
  return field ? std::optional(ReliefRange{field->min_height(), field->max_height()}) : std::nullopt;
}

// Heights without exaggeration.
PictureLegend legend_of_grey(const ReliefRange& range, double exaggeration) {
  PictureLegend legend{.title = "height, m", .low = range.low / exaggeration, .high = range.high / exaggeration};
  for (int grey = 1; grey <= 255; ++grey) {
    const auto byte = static_cast<std::uint8_t>(grey);
    legend.colours.push_back({byte, byte, byte});
  }
  return legend;
}

Picture picture_of_heights(std::span<const double> heights, const Scene& scene, const PictureSettings& settings) {
  const std::optional<ReliefRange> given = range_of_grey(scene, settings);
  const std::optional<ReliefRange> range = given ? given : range_of_heights(heights);
  Picture picture{range ? image_of_heights(size_of(settings), heights, *range)
                        : Image(settings.width, settings.height)};
  if (!given) picture.heights = range;
  picture.legend =
      legend_of_grey(range.value_or(ramp_heights(scene, settings)), paint_extent(scene, settings).exaggeration);
  return picture;
}

std::vector<double> heights_seen(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                                 const Progress& progress) {
  const std::optional<StepMarch> stepped = step_march_of(scene, camera, settings);
  if (stepped && scene.on_device()) {
#ifdef SCARP_VULKAN
    if (makes_whole_frames(scene, camera, settings)) return heights_of_whole_frame(scene, camera, settings, progress);
#endif
    require_steps(scene);
  }
  TraceMiddles trace;
  if (stepped) {
    trace = [&stepped](RayRound& round) {
      round.hits.clear();
      for (const Ray& ray : round.rays) {
        round.hits.push_back(stepped->march(ray, nullptr).hit);
      }
    };
  }
  std::vector<double> heights = no_heights(settings);
  look_through_middles(
      scene, camera, size_of(settings), false, progress,
      [&](std::size_t i, const Ray& ray, const Hit& hit, std::uint32_t) {
        if (hit && !scene.field_of(hit.object).is_backdrop()) heights[i] = ray.at(hit.t).z;
      },
      trace);
  return heights;
}

Picture render_height(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                      const Progress& progress) {
  const std::vector<double> heights = heights_seen(scene, camera, settings, progress);
  return picture_of_heights(heights, scene, settings);
}

Picture render_level(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                     const Progress& progress) {
  const LevelBoxes boxes(scene, settings.level);
  std::vector<double> heights = no_heights(settings);
  std::vector<float> shades(heights.size(), 1.f);
  look_through_middles(
      scene, camera, size_of(settings), false, progress,
      [&](std::size_t i, const Ray& ray, const Hit&, std::uint32_t) {
        if (const auto hit = boxes.hit(ray)) heights[i] = hit->height, shades[i] = hit->shade;
      },
      [](RayRound& round) { round.hits.assign(round.rays.size(), Hit{}); });
  Picture picture = picture_of_heights(heights, scene, settings);
  for (std::size_t i = 0; i < shades.size(); ++i) {
    std::uint8_t* grey = picture.image.rgb.data() + 3 * i;
    std::fill_n(grey, 3, static_cast<std::uint8_t>(std::lround(shades[i] * static_cast<float>(*grey))));
  }
  if (settings.alpha) {
    // Boxes cover more than the ground: holes, and sky above it. Where there is none, the image is black.
    picture.image.make_transparent();
    for (std::size_t i = 0; i < heights.size(); ++i) picture.image.alpha[i] = std::isnan(heights[i]) ? 0 : 255;
  }
  return picture;
}

std::vector<std::uint32_t> steps_seen(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                                      const Progress& progress) {
  std::vector<std::uint32_t> steps(static_cast<std::size_t>(settings.width) *
                                   static_cast<std::size_t>(settings.height));
  look_through_middles(scene, camera, size_of(settings), true, progress,
                       [&](std::size_t i, const Ray&, const Hit&, std::uint32_t count) { steps[i] = count; });
  return steps;
}

Picture picture_of_counts(std::span<const std::uint32_t> counts, const StepRange& range, std::string title,
                          const PictureSettings& settings) {
  constexpr int kColours = 256;
  const auto [low, high] = range.scale;
  const Ramp ramp = ramp_over(settings, low, high);
  Picture picture{image_of_steps(size_of(settings), counts, ramp)};
  picture.legend = PictureLegend{.title = std::move(title), .low = low, .high = high, .least_step = 1};
  for (int i = 0; i < kColours; ++i) {
    const vec3 colour = ramp(low + (high - low) * (i + 0.5) / kColours);
    picture.legend->colours.push_back({srgb_byte(colour.x), srgb_byte(colour.y), srgb_byte(colour.z)});
  }
  return picture;
}

Picture render_steps(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                     const Progress& progress) {
  const std::vector<std::uint32_t> steps = steps_seen(scene, camera, settings, progress);
  const StepRange range = range_of_steps(steps, settings.step_scale, steps_of(scene));
  Picture picture = picture_of_counts(steps, range, "steps per ray: " + range.of, settings);
  picture.steps = range;
  return picture;
}

Picture render_cost(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                    const Progress& progress) {
  const std::vector<std::uint32_t> reads = steps_seen(counting_reads(scene), camera, settings, progress);
  const StepRange range = range_of_steps(reads, settings.step_scale, reads_of(scene));
  Picture picture = picture_of_counts(reads, range, "reads per ray: " + range.of, settings);
  picture.cost = range;
  return picture;
}

Picture render_errors(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                      const Progress& progress) {
  ErrorPicture error = render_error(scene, camera, settings.width, settings.height, settings.error, progress);
  Picture picture{std::move(error.image)};
  picture.legend = PictureLegend{.title = "the march is"};
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    if (error.counts[verdict] == 0) continue;
    const vec3 colour = 255.f * srgb_of(verdict);
    const auto byte = [](float v) { return static_cast<std::uint8_t>(std::lround(v)); };
    picture.legend->classes.push_back(
        {{byte(colour.x), byte(colour.y), byte(colour.z)}, std::string(name_of(verdict))});
  }
  picture.errors = std::move(error.counts);
  picture.error_map = std::move(error.map);
  return picture;
}

Picture render_comanche(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                        const Progress& progress) {
  return settings.comanche.heights ? render_height(scene, camera, settings, progress)
                                   : render_lit(scene, camera, settings, progress);
}

// Colours of azimuths: yellow to the north, red to the east, blue to the south, green to the west.
Srgb colour_of_azimuth(double degrees) {
  constexpr std::array<std::array<double, 3>, 4> kColours = {
      {{245, 215, 70}, {215, 70, 60}, {60, 80, 190}, {60, 165, 90}}};
  const double quarter = degrees / 90;
  const auto first = static_cast<std::size_t>(quarter) % 4;
  Srgb colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = static_cast<std::uint8_t>(
        std::lround(std::lerp(kColours[first][k], kColours[(first + 1) % 4][k], quarter - std::floor(quarter))));
  return colour;
}

Picture render_relief(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                      const Progress& progress) {
  Picture picture{Image(settings.width, settings.height)};
  picture.numbers = relief_numbers(scene, camera, size_of(settings), settings.look, progress);
  double steepest = 0;
  for (const float number : picture.numbers) steepest = std::fmax(steepest, static_cast<double>(number));
  const Ramp ramp = ramp_over(settings, 0, std::max(steepest, 1.0));
  const auto colour_of = [&](double number) -> Srgb {
    if (settings.look == Look::aspect) return colour_of_azimuth(number);
    if (settings.look == Look::slope) {
      const vec3 colour = ramp(number);
      return {srgb_byte(colour.x), srgb_byte(colour.y), srgb_byte(colour.z)};
    }
    const auto grey = static_cast<std::uint8_t>(std::lround(number));
    return {grey, grey, grey};
  };
  if (settings.alpha) picture.image.make_transparent();
  for (std::size_t i = 0; i < picture.numbers.size(); ++i) {
    if (std::isnan(picture.numbers[i])) continue;
    const Srgb colour = colour_of(static_cast<double>(picture.numbers[i]));
    std::copy(colour.begin(), colour.end(), picture.image.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(i));
    if (settings.alpha) picture.image.alpha[i] = 255;
  }
  if (settings.look == Look::multidirectional) return picture;
  constexpr int kColours = 256;
  const bool aspect = settings.look == Look::aspect;
  picture.legend = PictureLegend{
      .title = aspect ? "aspect, degrees" : "slope, degrees", .low = 0, .high = aspect ? 360 : std::max(steepest, 1.0)};
  for (int i = 0; i < kColours; ++i)
    picture.legend->colours.push_back(colour_of(picture.legend->high * (i + 0.5) / kColours));
  return picture;
}

using RenderLook = Picture (*)(const Scene&, const Camera&, const PictureSettings&, const Progress&);

// The renderer of each look, in the order of the enumeration.
constexpr std::array kRenderers = std::to_array<std::pair<Look, RenderLook>>({
    {Look::shaded, render_lit},
    {Look::hillshade, render_hillshade},
    {Look::height, render_height},
    {Look::steps, render_steps},
    {Look::cost, render_cost},
    {Look::error, render_errors},
    {Look::comanche, render_comanche},
    {Look::level, render_level},
    {Look::slope, render_relief},
    {Look::aspect, render_relief},
    {Look::multidirectional, render_relief},
});

static_assert([] {
  for (std::size_t i = 0; i < kRenderers.size(); ++i) {
    if (static_cast<std::size_t>(kRenderers[i].first) != i) return false;
  }
  return kRenderers.size() == kLookCount;
}());

}  // namespace

bool uses_tone_curve(const PictureSettings& settings) {
  const bool counts = settings.look == Look::comanche && settings.comanche.iterations;
  return settings.tone_curve && !settings.unlit && !counts;
}

int pixel_side(const PictureSettings& settings) {
  return settings.large_pixels || entry_of(settings.look).large_pixels ? settings.comanche.scale : 1;
}

std::string_view ramp_of(const PictureSettings& settings) {
  if (!settings.ramp.empty()) return settings.ramp;
  return settings.look == Look::steps || settings.look == Look::cost || settings.look == Look::slope ? "viridis"
                                                                                                     : "hypsometric";
}

Ramp ramp_over(const PictureSettings& settings, double low, double high, double scale) {
  if (settings.ramp_stops) return {*settings.ramp_stops, low, high, scale};
  return {ramp_of(settings), low, high};
}

PaintExtent paint_extent(const Scene& scene, const PictureSettings& settings) {
  PaintExtent extent;
  if (const double side = scene.cell_side(); side > 0) extent.cell = side;
  if (const HeightField* field = scene.terrain()) {
    extent.low = field->min_height(), extent.high = field->max_height();
    extent.exaggeration = field->settings().exaggeration;
    extent.size = {field->width(), field->depth()};
  } else if (!scene.box().empty()) {
    extent.low = scene.box().low.z, extent.high = scene.box().high.z;
    extent.origin = dvec2(scene.box().low);
    extent.size = dvec2(scene.box().high - scene.box().low);
  }
  if (const auto& box = settings.ground_box) {
    extent.low = box->low.z, extent.high = box->high.z;
    extent.origin = dvec2(box->low), extent.size = dvec2(box->high - box->low);
  }
  extent.repeats = scene.endless();
  return extent;
}

ReliefRange ramp_heights(const Scene& scene, const PictureSettings& settings) {
  const PaintExtent extent = paint_extent(scene, settings);
  const auto& range = settings.ramp_range;
  return range ? ReliefRange{range->low * extent.exaggeration, range->high * extent.exaggeration}
               : ReliefRange{extent.low, extent.high};
}

Ramp ground_ramp(const Scene& scene, const PictureSettings& settings) {
  const ReliefRange heights = ramp_heights(scene, settings);
  return ramp_over(settings, heights.low, heights.high, paint_extent(scene, settings).exaggeration);
}

bool is_ramped(const SceneField& field, const PictureSettings& settings) {
  const bool named = settings.ramp_stops || !settings.ramp.empty();
  return height_field_of(field) || (named && field.kind() == "function");
}

void validate(const PictureSettings& settings) {
  require_setting("picture", settings.width >= 1 && settings.width <= kMaxSide, "the width", settings.width,
                  "1 to 65536 pixels");
  require_setting("picture", settings.height >= 1 && settings.height <= kMaxSide, "the height", settings.height,
                  "1 to 65536 pixels");
  const std::int64_t pixels = std::int64_t{settings.width} * settings.height;
  if (pixels > kMaxPixels) {
    throw Error(fmt::format("picture: {} x {} are {} pixels; at most {} are made at once", settings.width,
                            settings.height, pixels, kMaxPixels));
  }
  require_setting("picture", settings.aa >= 1 && settings.aa <= 16, "the number of samples per side (aa)", settings.aa,
                  "1 to 16");
  require_setting("picture", settings.samples >= 0 && settings.samples <= kMaxSamples, "the number of rays (samples)",
                  settings.samples, "0 to 4096");
  require_setting("picture", settings.ao_distance >= 0, "the distance of ambient occlusion", settings.ao_distance,
                  "0 or more metres");
  require_setting("picture", settings.haze >= 0 && settings.haze <= 0.95, "the haze", settings.haze, "0 to 0.95");
  require_setting("picture", settings.haze_distance > 0, "the haze distance", settings.haze_distance, "above 0 metres");
  if (const auto& scale = settings.step_scale) {
    require_setting("picture", scale->low >= 0 && scale->low < kUnlimited, "the first number of steps", scale->low,
                    "0 or more");
    require_setting("picture", scale->high > scale->low && scale->high < kUnlimited, "the last number of steps",
                    scale->high, "above the first");
  }
  if (const auto& range = settings.ramp_range) {
    require_setting("picture", std::isfinite(range->low), "the height of the first colour", range->low, "finite");
    require_setting("picture", std::isfinite(range->high) && range->high > range->low, "the height of the last colour",
                    range->high, "above the first");
  }
  require_setting("picture", settings.level >= 0, "the level", settings.level, "0 or more");
  validate(settings.error);
  validate(settings.sun);
  if (settings.sky.kind == SkyKind::plain && settings.sun.altitude_deg <= 0) {
    throw Error(
        fmt::format("sun: the altitude is {} (must be above 0 and at most 90 degrees; a scattering sky has "
                    "twilight, from {} degrees)",
                    settings.sun.altitude_deg, kLowestSun));
  }
  validate(settings.sky);
  if (settings.water) validate(*settings.water);
  validate(settings.ground);
  validate(settings.fog);
  validate(settings.comanche);
  Ramp(ramp_of(settings), 0, 1);
}

void require_visible(const Scene& scene) {
  if (const HeightField* field = scene.only_heights()) {
    if (!field->has_cells()) {
      throw Error(fmt::format("picture: the field has {} x {} samples and so no cells (at least 2 x 2 are needed)",
                              field->cols(), field->rows()));
    }
    if (field->all_nodata()) throw Error("picture: all samples of the field are nodata (nothing to see)");
    if (!field->has_ground())
      throw Error("picture: every cell of the field has a nodata sample at a corner (nothing to see)");
  }
  if (!scene.endless() && scene.box().empty()) throw Error("picture: nothing in the scene can be seen");
}

WorldBox picture_box(const Scene& scene) {
  WorldBox box = scene.box();
  // One copy of wrapped ground.
  if (const HeightField* field = scene.terrain(); field && field->wraps())
    box = around(box, {{0, 0, field->min_height()}, {field->width(), field->depth(), field->max_height()}});
  if (box.empty()) {
    throw Error(scene.endless() ? "picture: everything in the scene is endless, so the camera cannot be framed (set an "
                                  "eye and a target)"
                                : "picture: nothing in the scene can be seen");
  }
  return box;
}

namespace {

// For looks with one ray per pixel.
void find_alpha(const Scene& scene, const Camera& camera, const PictureSettings& settings, Image& image) {
  image.make_transparent();
  look_through_middles(scene, camera, size_of(settings), false, {},
                       [&](std::size_t i, const Ray&, const Hit& hit, std::uint32_t) {
                         if (hit && !scene.field_of(hit.object).is_backdrop()) {
                           image.alpha[i] = 255;
                         } else {
                           std::fill_n(image.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(i), 3, std::uint8_t{0});
                         }
                       });
}

}  // namespace

Picture render_picture(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                       const Progress& progress) {
  validate(settings);
  require_visible(scene);
  Picture picture = kRenderers[static_cast<std::size_t>(settings.look)].second(scene, camera, settings, progress);
  Image& image = picture.image;
  if (settings.alpha && image.alpha.empty()) find_alpha(scene, camera, settings, image);
  if (const int side = pixel_side(settings); side > 1) image = scaled_up(image, side);
  return picture;
}

}  // namespace scarp
