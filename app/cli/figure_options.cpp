// SPDX-License-Identifier: MIT
#include "app/cli/figure_options.h"

#include <fmt/format.h>

#include "app/cli/vox_input.h"
#include "scarp/base/error.h"

#ifdef SCARP_CAIRO
#include <algorithm>
#include <cmath>
#include <variant>

#include "scarp/output/figure.h"
#include "scarp/render/surface/ramp.h"
#endif

namespace scarp::cli {

void add_figure_options(Command& command, FigureOptions& options) {
  command.add(&options.legend, {.names = "--legend",
                                .help = "legend of the colours in the lower right corner",
                                .topic = Topic::figure,
                                .common = true,
                                .looks = {"shaded height steps error comanche level", "its greys have no unit"}});
  command.add(&options.scale_bar, {.names = "--scale-bar",
                                   .help = "scale bar in the lower left corner",
                                   .note = "in perspective it holds in the middle",
                                   .topic = Topic::figure,
                                   .common = true});
}

#ifdef SCARP_CAIRO

namespace {

constexpr int kNumbers = 6, kColours = 256;
constexpr double kBarShare = 0.25;  // of the picture's width, at most

std::array<std::uint8_t, 3> bytes(vec3 linear) {
  return {srgb_byte(linear.x), srgb_byte(linear.y), srgb_byte(linear.z)};
}

std::vector<FigureTick> ticks_of(double low, double high, double least_step = 0) {
  if (!(high > low)) return {{0.5, fmt::format("{:.6g}", low)}};  // ground without relief
  std::vector<FigureTick> ticks;
  for (const double number : round_numbers(low, high, kNumbers, least_step)) {
    ticks.push_back({(number - low) / (high - low), fmt::format("{:.6g}", number)});
  }
  return ticks;
}

// Numbers from low to high; the ramp knows them multiplied.
FigureLegend legend_of(std::string title, double low, double high, const Ramp& ramp, double per_colour = 1) {
  FigureLegend legend{std::move(title), {}, ticks_of(low, high)};
  for (int i = 0; i < kColours; ++i) {
    legend.colours.push_back(bytes(ramp((low + (high - low) * (i + 0.5) / kColours) * per_colour)));
  }
  return legend;
}

// The legend of the only height ramp in the scene: that of a material, or that of ground without a material.
FigureLegend legend_of_heights(const PictureSettings& settings, const Scene& scene, const PaintExtent& extent) {
  const HeightRamp* ramp = nullptr;
  int ramps = 0;
  for (const Material& material : settings.materials) {
    const auto* other = std::get_if<HeightRamp>(&material);
    if (!other) continue;
    ramp = other;
    ++ramps;
  }
  const bool painted = std::any_of(scene.objects().begin(), scene.objects().end(), [&](const SceneObject& object) {
    return object.material >= settings.materials.size() && is_ramped(*scene.fields()[object.field], settings);
  });
  if (painted) ++ramps;
  if (ramps != 1) {
    throw Error(fmt::format("--legend: {} (use --look height, steps or error)",
                            ramps == 0 ? "the colours of this picture do not depend on height"
                                       : "several scales of heights colour this picture"));
  }
  const double exaggeration = extent.exaggeration;
  const ReliefRange heights = ramp_heights(scene, settings);
  return ramp ? legend_of("height, m", ramp->low, ramp->high, Ramp(ramp->ramp, ramp->low, ramp->high))
              : legend_of("height, m", heights.low / exaggeration, heights.high / exaggeration,
                          ground_ramp(scene, settings), exaggeration);
}

// The legend of a volume: its numbers are spread evenly over the ramp.
FigureLegend legend_of_numbers(const SolidRange& numbers, const std::string& ramp) {
  FigureLegend legend{"number", {}, ticks_of(numbers.low, numbers.high)};
  for (const VoxelColour& colour : colours_of(ramp)) legend.colours.push_back({colour[0], colour[1], colour[2]});
  return legend;
}

void add_meaning(const PictureSettings& settings, const Scene& scene, const std::optional<SolidRange>& numbers,
                 const Picture& picture, Figure& figure) {
  const PaintExtent extent = paint_extent(scene, settings);
  const ReliefRange grey = picture.heights.value_or(ramp_heights(scene, settings));
  // The legend shows heights without exaggeration.
  const double exaggeration = extent.exaggeration;
  switch (settings.comanche.heights ? Look::height : settings.look) {
    case Look::steps:
      figure.legend = legend_of("steps per ray", picture.steps->scale.low, picture.steps->scale.high,
                                ramp_over(settings, picture.steps->scale.low, picture.steps->scale.high));
      figure.legend->ticks = ticks_of(picture.steps->scale.low, picture.steps->scale.high, 1);
      break;
    case Look::error: {
      FigureKey key{"the march is", {}};
      for (int i = 0; i < kVerdicts; ++i) {
        const auto verdict = static_cast<Verdict>(i);
        if ((*picture.errors)[verdict] == 0) continue;
        const vec3 colour = 255.f * srgb_of(verdict);
        const auto byte = [](float v) { return static_cast<std::uint8_t>(std::lround(v)); };
        key.entries.push_back({{byte(colour.x), byte(colour.y), byte(colour.z)}, std::string(name_of(verdict))});
      }
      figure.key = std::move(key);
      break;
    }
    case Look::height:
    case Look::level: {
      FigureLegend scale{"height, m", {}, ticks_of(grey.low / exaggeration, grey.high / exaggeration)};
      for (int i = 0; i < 255; ++i) {
        const auto byte = static_cast<std::uint8_t>(1 + i);
        scale.colours.push_back({byte, byte, byte});
      }
      figure.legend = std::move(scale);
      break;
    }
    case Look::hillshade:
      break;  // cosines have no unit
    case Look::shaded:
    case Look::comanche:
      figure.legend = numbers ? legend_of_numbers(*numbers, settings.ramp) : legend_of_heights(settings, scene, extent);
      break;
  }
}

// What the picture's middle shows, else the middle of the scene.
double depth_in_the_middle(const PictureSettings& settings, const Scene& scene, const Camera& camera) {
  const Ray ray = camera.ray(0.5 * settings.width, 0.5 * settings.height);
  const Hit hit = scene.closest_hit(ray);
  const dvec3 there = hit ? ray.at(hit.t) : picture_box(scene).middle();
  return dot(there - camera.eye(), camera.forward());
}

FigureScale scale_of(double pixels_wide, double metres_per_pixel, bool map) {
  const double most = kBarShare * pixels_wide * metres_per_pixel;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  const double length = most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
  const bool km = length >= 1000;
  const double per_unit = km ? 1e-3 : 1;
  return {length / metres_per_pixel,
          map ? "" : "in the picture's middle",
          {{0, "0"},
           {0.5, fmt::format("{:.6g}", 0.5 * length * per_unit)},
           {1, fmt::format("{:.6g} {}", length * per_unit, km ? "km" : "m")}}};
}

}  // namespace

void settle_figure(const FigureOptions& options, const PictureSettings& settings, bool exr) {
  if (!options.any()) return;
  const std::string_view option = options.legend ? "--legend" : "--scale-bar";
  if (exr) throw Error(fmt::format("{} is drawn into PNG pictures only (name the output *.png)", option));
  if (options.legend && settings.comanche.iterations) {
    throw Error("--legend is not available with --iterations (use --look steps)");
  }
  const bool ramp = settings.look == Look::shaded || settings.look == Look::comanche;
  if (options.legend && ramp && settings.ground.natural) {
    throw Error("--legend has no colour scale to show with --ground natural (leave one of them out)");
  }
}

void draw_figure_of(const FigureOptions& options, const PictureSettings& settings, const Scene& scene,
                    const Camera& camera, bool map, const std::optional<SolidRange>& numbers, Picture& picture) {
  if (!options.any()) return;
  Figure figure;
  if (options.legend) add_meaning(settings, scene, numbers, picture, figure);
  if (options.scale_bar) {
    const double depth = depth_in_the_middle(settings, scene, camera);
    if (!(depth > 0)) throw Error("--scale-bar: the middle of the picture shows no ground to measure");
    figure.scale = scale_of(picture.image.width, camera.pixel_width(depth) * settings.width / picture.image.width, map);
  }
  draw_figure(picture.image.rgb.data(), picture.image.width, picture.image.height, figure);
}

#else

void settle_figure(const FigureOptions& options, const PictureSettings&, bool) {
  if (options.any()) {
    throw Error("--legend, --scale-bar: this scarp was built without Cairo (SCARP_CAIRO=OFF)");
  }
}

void draw_figure_of(const FigureOptions&, const PictureSettings&, const Scene&, const Camera&, bool,
                    const std::optional<SolidRange>&, Picture&) {}

#endif

}  // namespace scarp::cli
