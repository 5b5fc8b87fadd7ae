// SPDX-License-Identifier: MIT
#include "app/cli/look_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/source/colour_image.h"
#include "scarp/source/colour_relief_file.h"
#include "scarp/source/ramp_file.h"

namespace scarp::cli {
namespace {

// Factor of the distance to a field that covers its far corners: these are farther away than the field's longer side
// plus the distance to it by less than half of that side, and a camera that sees all of a field is farther away.
constexpr double kFarthestCorner = 2;

constexpr int kLowresWidth = 320, kLowresHeight = 240;

// Metres from the camera to the nearest point of a box.
double way_to(const WorldBox& box, const Camera& camera) {
  return length(glm::clamp(camera.eye(), box.low, box.high) - camera.eye());
}

vec3 colour_from(const std::string& text, std::string_view option) {
  const auto wrong = [&] {
    return Error(
        fmt::format("{} '{}': expected RRGGBB, two hexadecimal digits each, for example 1a4055", option, text));
  };
  if (text.size() != 6 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) throw wrong();
  const auto rgb = std::stoul(text, nullptr, 16);
  return vec3((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255) / 255.0f;
}

// "1a4054".
std::string colour_text(vec3 srgb) {
  const auto byte = [](float v) { return std::lround(255 * v); };
  return fmt::format("{:02x}{:02x}{:02x}", byte(srgb.x), byte(srgb.y), byte(srgb.z));
}

std::shared_ptr<const DetailTexture> read_detail_texture(const std::string& path) {
  const ColourImage image = read_colour_image(path, DetailTexture::kMostSide);
  try {
    return std::make_shared<DetailTexture>(image.width, image.height, image.rgba);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

int pixels(double number, const std::string& text) {
  if (number != std::floor(number) || !(std::abs(number) <= 1e9)) {
    throw Error(fmt::format("--lowres '{}': expected WIDTHxHEIGHT in pixels, for example 320x240", text));
  }
  return static_cast<int>(number);
}

}  // namespace

void add_look_options(Command& command, LookOptions& o) {
  static constexpr Looks kLit{"shaded comanche", "the others show numbers"};
  constexpr Looks kLarge{"comanche"};
  const auto names_of_fog = [] {
    std::vector<std::string> names;
    for (const FogKind kind : {FogKind::none, FogKind::distance, FogKind::height, FogKind::iterations})
      names.emplace_back(name_of(kind));
    return names;
  };
  const auto lit = [&command](Topic topic) {
    return [&command, topic](Binding to, Option option) {
      option.topic = topic;
      option.looks = kLit;
      command.add(std::move(to), std::move(option));
    };
  };
  const auto ground = lit(Topic::ground), water = lit(Topic::water), fog = lit(Topic::fog);
  command.add(&o.ramp,
              {.names = "--ramp",
               .value = "RAMP",
               .help = "colours by height",
               .choices = {ramp_names().begin(), ramp_names().end()},
               .files = "cpt txt clr png",
               .note = "or a file: .cpt, .txt or .clr of gdaldem, .png of 1 x N colours",
               .fallback = "hypsometric; viridis for the look steps",
               .topic = Topic::ground,
               .common = true,
               .looks = {"shaded steps comanche", "the others have their own colours"},
               .rules = {{"has no effect without --volume or --look steps (voxels and meshes have their own colours)",
                          [&command] { return command.given("--volume") || command.value("--look") == "steps"; },
                          kVoxels | kMesh}}});
  command.add(&o.ramp_range,
              {.names = "--ramp-range",
               .value = "LOW,HIGH",
               .help = "heights of the first and last colour of the ramp, or of the look height",
               .unit = "metres",
               .fallback = "lowest and highest ground",
               .topic = Topic::ground,
               .looks = {"shaded height comanche level", "the others show no heights"},
               .rules = {{"has no effect with --ground natural", [&o] { return o.ground_colours != "natural"; }},
                         {"has no effect without --look height (voxels and meshes have their own colours)",
                          [&command] { return command.value("--look") == "height"; }, kVoxels | kMesh}}});
  ground(&o.ground_colours, {.names = "--ground",
                             .value = "KIND",
                             .help = "ground colours",
                             .choices = {"ramp", "natural"},
                             .closed = true,
                             .note = "natural: rock, grass and snow",
                             .fallback = "ramp",
                             .common = true});
  ground(&o.snow_line, {.names = "--snow-line",
                        .help = "snow line of natural ground",
                        .unit = "metres",
                        .fallback = fmt::format("{} of the relief", o.ground.snow_share),
                        .rules = {needs("--ground natural", [&o] { return o.ground_colours == "natural"; })}});
  const Rule detailed = needs("--detail F", [&o] { return o.ground.detail > 0; });
  ground(&o.ground.detail,
         {.names = "--detail", .help = "strength of noise patches or of --detail-texture", .range = {0, 1}});
  ground(&o.ground.detail_size, {.names = "--detail-size",
                                 .help = "size of the largest patches or width of --detail-texture",
                                 .unit = "metres",
                                 .range = kZeroOrMore,
                                 .fallback = "16 cells",
                                 .rules = {detailed}});
  ground(&o.detail_texture, {.names = "--detail-texture",
                             .value = "FILE",
                             .help = "image, repeated over the ground, whose grey levels replace the noise",
                             .files = "*",
                             .rules = {detailed}});
  ground(&o.ground.contours, {.names = "--contours",
                              .help = "contour interval",
                              .unit = "metres",
                              .range = kZeroOrMore,
                              .fallback = "none",
                              .common = true});
  ground(&o.overlay,
         {.names = "--overlay",
          .value = "FILE",
          .help = "image projected onto everything from above: placed by its georeference if the terrain has one too, "
                  "else stretched over the scene (functions: over --extent)",
          .files = "*",
          .common = true});

  // A scene file may have water and fog of its own.
  const Rule wet = needs(
      "--water M", [&o] { return o.water.has_value(); }, kEveryInput & ~kScene);
  water(&o.water, {.names = "--water",
                   .help = "water level",
                   .unit = "metres",
                   .note = "water covers all ground below it",
                   .common = true});
  water(&o.water_colour, {.names = "--water-colour",
                          .value = "RRGGBB",
                          .help = "colour of deep water",
                          .fallback = colour_text(o.water_settings.srgb),
                          .rules = {wet}});
  water(&o.water_settings.turbidity, {.names = "--turbidity",
                                      .help = "light lost beyond that of pure water, per metre",
                                      .range = kZeroOrMore,
                                      .rules = {wet}});
  water(&o.water_settings.waves, {.names = "--waves",
                                  .help = "mean slope of the waves",
                                  .range = {0, 0.5},
                                  .note = "0: a mirror",
                                  .rules = {wet}});
  water(&o.water_settings.wavelength, {.names = "--wavelength",
                                       .help = "length of the longest wave",
                                       .unit = "metres",
                                       .range = kZeroOrMore,
                                       .fallback = "two cells",
                                       .rules = {wet}});
  water(&o.no_reflection,
        {.names = "--no-reflection", .help = "reflection of the sky only, not of the terrain", .rules = {wet}});
  water(&o.no_refraction,
        {.names = "--no-refraction", .help = "opaque water of one colour, whatever its depth", .rules = {wet}});

  const Rule foggy = needs(
      "--fog KIND", [&o] { return !o.fog.empty() && o.fog != "none"; }, kEveryInput & ~kScene);
  const Rule high = needs(
      "--fog height", [&o] { return o.fog == "height"; }, kEveryInput & ~kScene);
  fog(&o.fog,
      {.names = "--fog",
       .value = "KIND",
       .help = "fog",
       .choices = names_of_fog(),
       .closed = true,
       .note = "iterations: by marching steps",
       .fallback = "none",
       .common = true,
       .rules = {{"iterations needs --look comanche --march fixed-step (use distance or height)", [&command, &o] {
                    return o.fog != name_of(FogKind::iterations) ||
                           (command.value("--look") == "comanche" && command.value("--march") == "fixed-step");
                  }}}});
  fog(&o.visibility, {.names = "--visibility",
                      .help = "visibility in fog",
                      .unit = "metres",
                      .range = kAboveZero,
                      .note = "contrast falls to 2 % there",
                      .fallback = "--reach, else the longer side of the field; more if the eye is outside",
                      .common = true,
                      .rules = {foggy}});
  fog(&o.fog_base, {.names = "--fog-base",
                    .help = "reference height of --visibility",
                    .unit = "metres",
                    .fallback = "the water, or the lowest ground",
                    .rules = {high}});
  fog(&o.fog_falloff, {.names = "--fog-falloff",
                       .help = "scale height of the fog",
                       .unit = "metres",
                       .range = kAboveZero,
                       .note = "the fog thins by the factor e over it",
                       .fallback = "a quarter of the relief",
                       .rules = {high}});
  fog(&o.fog_settings.sun_tint,
      {.names = "--sun-tint",
       .help = "warmth of the fog towards the sun",
       .range = {0, 1},
       .rules = {foggy, {"has no effect with --sky scattering, which sets the colour of fog", [&command] {
                           return command.value("--sky") != "scattering";
                         }}}});

  constexpr Looks kPixels{"height comanche"};
  const Rule stepped = needs("--march fixed-step", [&command] { return command.value("--march") == "fixed-step"; });
  const Rule alone{"has no effect with --mesh, among which rays step by --fixed-step",
                   [&command] { return !command.given("--mesh"); }};
  constexpr Inputs kStepped{kTerrain, "rays over functions step by --function-step M", "its rays do not step"};
  const Rule large_pixels{"needs --lowres WIDTHxHEIGHT with --look height",
                          [&command, &o] { return command.value("--look") != "height" || !o.lowres.empty(); }};
  const auto large = [&](Binding to, Option option) {
    option.topic = Topic::comanche;
    command.add(std::move(to), std::move(option));
  };
  large(&o.lowres, {.names = "--lowres",
                    .value = "WIDTHxHEIGHT",
                    .help = "size of the picture in large pixels",
                    .note = "the look height then uses the rays and camera of comanche",
                    .fallback = fmt::format("{}x{}", kLowresWidth, kLowresHeight),
                    .looks = {"height comanche", "other looks have --size"},
                    .excludes = {"--size", "--refine"}});
  large(&o.comanche.scale, {.names = "--pixel-size",
                            .value = "PX",
                            .help = "side of a large pixel in pixels of the image",
                            .range = {1, 64},
                            .looks = kPixels,
                            .rules = {large_pixels}});
  large(&o.comanche.steps, {.names = "--steps",
                            .help = "number of steps of fixed-step over the reach",
                            .range = {1, 65536},
                            .inputs = kStepped,
                            .looks = kPixels,
                            .rules = {stepped, large_pixels, alone}});
  large(&o.comanche.shells, {.names = "--shells",
                             .help = "fixed-step samples on spheres round the eye instead of planes",
                             .inputs = kStepped,
                             .looks = kPixels,
                             .rules = {stepped, large_pixels, alone}});
  large(&o.comanche.step_by_view, {.names = "--step-by-view",
                                   .help = "longer steps of fixed-step for rays that look down",
                                   .inputs = kStepped,
                                   .looks = kPixels,
                                   .rules = {stepped, large_pixels, alone}});
  large(&o.comanche.iterations,
        {.names = "--iterations",
         .help = "picture of the number of steps, from black (0) to white (the maximum)",
         .note = "with fixed-step the sky is white",
         .looks = kLarge,
         .excludes = {"--sun", "--sky", "--no-tone-curve", "--unlit", "--samples", "--ramp", "--ramp-range", "--ground",
                      "--detail", "--contours", "--overlay", "--fog"}});
  large(&o.reach, {.names = "--reach",
                   .help = "maximum length of camera rays",
                   .unit = "metres",
                   .range = kAboveZero,
                   .fallback = "unlimited; fields that wrap: the longer side, more if the eye is outside"});
}

void settle_look(const LookOptions& o, const MarchSettings& march_settings, PictureSettings& picture) {
  picture.comanche = o.comanche;
  if (picture.look == Look::height && !o.lowres.empty()) {
    picture.look = Look::comanche;
    picture.comanche.heights = true;
  }
  const bool comanche = picture.look == Look::comanche;
  picture.comanche.interpolate = march_settings.fixed_step.interpolate;
  picture.ground = o.ground;
  picture.ground.natural = o.ground_colours == "natural";
  if (!o.detail_texture.empty()) picture.ground.detail_texture = read_detail_texture(o.detail_texture);
  const std::string extension = extension_of(o.ramp);
  if (extension == ".cpt") {
    picture.ramp_stops = std::make_shared<RampStops>(read_cpt(o.ramp));
  } else if (extension == ".txt" || extension == ".clr") {
    picture.ramp_stops = std::make_shared<RampStops>(read_colour_relief(o.ramp));
  } else if (extension == ".png") {
    const ColourImage row = read_colour_row(o.ramp);
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < row.rgba.size(); ++i) {
      if (i % 4 != 3) rgb.push_back(row.rgba[i]);
    }
    picture.ramp_stops = std::make_shared<RampStops>(ramp_of_row(rgb));
  } else {
    const auto& names = ramp_names();
    if (!o.ramp.empty() && std::find(names.begin(), names.end(), o.ramp) == names.end())
      throw Error(
          fmt::format("--ramp '{}': expected {}, or a .cpt, .txt, .clr or .png file", o.ramp, fmt::join(names, ", ")));
    picture.ramp = o.ramp;
  }
  if (!o.ramp_range.empty()) {
    const auto range =
        ground_numbers_from(o.ramp_range, 2, 2, "--ramp-range", "LOW,HIGH in metres, for example 0,2400");
    if (!(range[0] < range[1])) throw Error(fmt::format("--ramp-range '{}': expected LOW below HIGH", o.ramp_range));
    if (picture.ramp_stops && !picture.ramp_stops->stretched)
      throw Error(fmt::format("--ramp-range: {} has heights of its own (leave one of the two out)", o.ramp));
    picture.ramp_range = ReliefRange{range[0], range[1]};
  }
  if (comanche) {
    picture.width = kLowresWidth;
    picture.height = kLowresHeight;
    picture.aa = 1;
    picture.shadows = false;
  }
  if (!o.lowres.empty()) {
    const auto numbers = numbers_from(o.lowres, 'x', 2, 2, "--lowres", "WIDTHxHEIGHT in pixels, for example 320x240");
    picture.width = pixels(numbers[0], o.lowres);
    picture.height = pixels(numbers[1], o.lowres);
  }
  settle_environment(o, picture);
}

void settle_environment(const LookOptions& o, PictureSettings& picture) {
  picture.fog = o.fog_settings;
  if (!o.fog.empty()) picture.fog.kind = find_fog(o.fog);
  if (o.visibility) picture.fog.visibility = *o.visibility;
  if (o.fog_falloff) picture.fog.falloff = *o.fog_falloff;
  if (!o.water) return;
  picture.water = o.water_settings;
  picture.water->level = *o.water;
  if (o.no_reflection) picture.water->reflection = false;
  if (o.no_refraction) picture.water->refraction = false;
  if (!o.water_colour.empty()) picture.water->srgb = colour_from(o.water_colour, "--water-colour");
}

std::vector<std::string> read_overlay_files(const LookOptions& o, const Georeference& georeference, int cols, int rows,
                                            bool mirror, std::int64_t most_pixels, PictureSettings& picture) {
  if (o.overlay.empty()) return {};
  Overlay overlay = read_overlay(o.overlay, georeference, cols, rows, most_pixels);
  ColourImage& image = overlay.image;
  picture.ground.drape = std::make_shared<Drape>(Drape{image.width,
                                                       image.height,
                                                       std::move(image.rgba),
                                                       {overlay.west, overlay.north},
                                                       {overlay.east, overlay.south},
                                                       mirror});
  return std::move(image.files);
}

void see_from_afar(const LookOptions& o, const WorldBox& box, const Camera& camera, PictureSettings& picture) {
  constexpr double kWays = 10;
  if (o.visibility) return;
  picture.fog.visibility += kWays * way_to(box, camera);
}

void finish_look(const LookOptions& o, double across, const ReliefRange& heights, double exaggeration,
                 PictureSettings& picture) {
  if (!o.visibility) picture.fog.visibility = o.reach.value_or(across > 0 ? across : FogSettings{}.visibility);
  const double relief = heights.high - heights.low;
  if (o.snow_line && relief > 0) picture.ground.snow_share = (*o.snow_line * exaggeration - heights.low) / relief;
  if (o.fog_base) {
    picture.fog.base = *o.fog_base * exaggeration;
  } else {
    picture.fog.base = picture.water ? picture.water->level * exaggeration : heights.low;
  }
  if (!o.fog_falloff) picture.fog.falloff = std::max(1.0, relief / 4);
}

double reach_of(const LookOptions& o, double across, const Scene& scene, const WorldBox& box, const Camera& camera) {
  if (o.reach) return *o.reach;
  if (!scene.wraps()) return std::numeric_limits<double>::infinity();
  return across + kFarthestCorner * way_to(box, camera);
}

}  // namespace scarp::cli
