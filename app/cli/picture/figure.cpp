// SPDX-License-Identifier: MIT
#include "app/cli/picture/figure.h"

#include <fmt/format.h>

#include "scarp/base/error.h"

#ifdef SCARP_CAIRO
#include <algorithm>
#include <cmath>
#include <variant>

#include "app/cli/options/vox_input.h"
#include "app/cli/picture/contour_labels.h"
#include "app/cli/picture/drawn_shapes.h"
#include "app/cli/picture/graticule.h"
#include "scarp/render/camera/compass.h"
#include "scarp/render/surface/ramp.h"
#endif

namespace scarp::cli {

#ifdef SCARP_CAIRO

namespace {

constexpr int kNumbers = 6, kColours = 256;
constexpr double kBarShare = 0.25;  // maximum fraction of the picture's width

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

}  // namespace

FigureLegend legend_of(std::string title, double low, double high, const Ramp& ramp, double per_colour,
                       double least_step) {
  FigureLegend legend{std::move(title), {}, ticks_of(low, high, least_step)};
  for (int i = 0; i < kColours; ++i) {
    legend.colours.push_back(bytes(ramp((low + (high - low) * (i + 0.5) / kColours) * per_colour)));
  }
  return legend;
}

namespace {

// The legend of the only height ramp in the scene: of a material, or of ground without a material.
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
  if (!picture.legend) {
    // Only hillshades have colours without unit.
    if (entry_of(settings.look).lit)
      figure.legend = numbers ? legend_of_numbers(*numbers, settings.ramp)
                              : legend_of_heights(settings, scene, paint_extent(scene, settings));
    return;
  }
  const PictureLegend& legend = *picture.legend;
  if (!legend.colours.empty()) {
    figure.legend = FigureLegend{legend.title, legend.colours, ticks_of(legend.low, legend.high, legend.least_step)};
    return;
  }
  figure.key = FigureKey{legend.title, {}};
  for (const PictureLegend::Class& one : legend.classes) figure.key->entries.push_back({one.colour, one.name});
}

// The point in the centre of the picture, or else the centre of the scene. Throws Error if neither is in front of the
// camera.
dvec3 middle_of(const FigureSubject& subject, std::string_view option) {
  const dvec2 size = subject.camera.size();
  const Ray ray = subject.camera.ray(0.5 * size.x, 0.5 * size.y);
  const Hit hit = subject.scene.closest_hit(ray);
  const dvec3 there = hit ? ray.at(hit.t) : picture_box(subject.scene).middle();
  if (dot(there - subject.camera.eye(), subject.camera.forward()) > 0) return there;
  throw Error(fmt::format("{}: the middle of the picture shows no ground to measure", option));
}

// Radians clockwise from up.
double north_in_picture(const FigureSubject& subject, double grid_north_azimuth) {
  constexpr double kAhead = 1e-3;  // fraction of the distance: short enough to be straight in perspective
  const Camera& camera = subject.camera;
  const dvec3 there = middle_of(subject, "--north-arrow");
  const double metres = kAhead * dot(there - camera.eye(), camera.forward());
  const auto from = camera.pixel(there), to = camera.pixel(there + metres * towards(0, 0, grid_north_azimuth));
  if (!from || !to) throw Error("--north-arrow: north has no direction in this picture");
  return std::atan2(to->x - from->x, from->y - to->y);
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

void check_figure(const FigureOptions& options, const PictureSettings& settings, const PictureFormat& format) {
  if (options.any().empty()) return;
  if (format.layers) {
    throw Error(fmt::format("{} is not drawn into {}, which holds numbers for further work (name the output *.png)",
                            options.any(), format.name));
  }
  if (options.layout == "beside" && !format.margins) {
    throw Error(
        fmt::format("--layout beside: {} holds the map alone, margins have no place on Earth (name the output "
                    "*.png or *.pdf)",
                    format.name));
  }
  if (!is_figure_text(options.title)) throw Error("--title: the text is not valid UTF-8");
  if (options.legend && settings.comanche.iterations) {
    throw Error("--legend is not available with --iterations (use --look steps)");
  }
  const bool ramp = entry_of(settings.look).lit;
  if (options.legend && ramp && settings.ground.natural) {
    throw Error("--legend has no colour scale to show with --ground natural (leave one of them out)");
  }
}

std::optional<Figure> figure_of(const FigureOptions& options, const PictureSettings& settings,
                                const FigureSubject& subject) {
  if (options.any().empty() && subject.strips.empty()) return {};
  const Scene& scene = subject.scene;
  const Camera& camera = subject.camera;
  const double per_pixel = pixel_side(settings);
  const double width = per_pixel * settings.width, height = per_pixel * settings.height;
  Figure figure{.title = options.title, .strips = subject.strips};
  if (options.layout == "beside") figure.layout = FigureLayout::beside;
  if (options.scale_bar) {
    const double depth = dot(middle_of(subject, "--scale-bar") - camera.eye(), camera.forward());
    figure.scale = scale_of(width, camera.pixel_width(depth) / per_pixel, subject.map);
  }
  if (options.north_arrow) figure.north = north_in_picture(subject, settings.grid_north_azimuth);
  if (options.graticule) {
    figure.graticule =
        graticule_of(subject.georeference, subject.cols, subject.rows, camera, per_pixel, options.graticule->degrees);
  }
  if (const HeightField* field = scene.terrain(); options.contour_labels && field && settings.ground.contours > 0) {
    ContourLabelSettings labels{settings.ground.contours * lines_per_heavy_contour()};
    if (settings.water) labels.above = settings.water->level;
    labels.text = figure_label_height(static_cast<int>(width), static_cast<int>(height));
    labels.per_pixel = per_pixel;
    figure.labels = contour_labels_of(*field, camera, labels);
  }
  if (!options.draw.files.empty())
    figure.shapes = drawn_shapes(options.draw, {subject.georeference, subject.cols, subject.rows, camera, per_pixel});
  // Checked before the work: everything except the legend is known.
  require_room(figure, static_cast<int>(width), static_cast<int>(height));
  return figure;
}

void add_legend(const FigureOptions& options, const PictureSettings& settings, const FigureSubject& subject,
                const Picture& picture, std::optional<Figure>& figure) {
  if (options.legend && figure) add_meaning(settings, subject.scene, subject.numbers, picture, *figure);
}

#else

void check_figure(const FigureOptions& options, const PictureSettings&, const PictureFormat&) {
  if (!options.any().empty())
    throw Error(fmt::format("{}: this scarp was built without Cairo (SCARP_CAIRO=OFF)", options.any()));
}

std::optional<Figure> figure_of(const FigureOptions&, const PictureSettings&, const FigureSubject&) { return {}; }

void add_legend(const FigureOptions&, const PictureSettings&, const FigureSubject&, const Picture&,
                std::optional<Figure>&) {}

#endif

}  // namespace scarp::cli
