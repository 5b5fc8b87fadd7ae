// SPDX-License-Identifier: MIT
#include "app/cli/options/look_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/source/raster/colour_image.h"
#include "scarp/source/table/colour_relief_file.h"
#include "scarp/source/table/ramp_file.h"

namespace scarp::cli {
namespace {

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

void set_ramp(const std::string& text, PictureRequest& request, PictureFileNames& files) {
  constexpr std::array<std::string_view, 4> kFiles = {".cpt", ".txt", ".clr", ".png"};
  const auto& names = ramp_names();
  if (std::find(kFiles.begin(), kFiles.end(), extension_of(text)) != kFiles.end()) {
    files.ramp = text;
  } else if (std::find(names.begin(), names.end(), text) != names.end()) {
    request.ramp = text;
  } else {
    throw Error(
        fmt::format("--ramp '{}': expected {}, or a .cpt, .txt, .clr or .png file", text, fmt::join(names, ", ")));
  }
}

ReliefRange ramp_range_from(const std::string& text) {
  const auto range = ground_numbers_from(text, 2, 2, "--ramp-range", "LOW,HIGH in metres, for example 0,2400");
  if (!(range[0] < range[1])) throw Error(fmt::format("--ramp-range '{}': expected LOW below HIGH", text));
  return {range[0], range[1]};
}

// Adds options for lit looks.
auto lit(Command& command, Topic topic) {
  return [&command, topic](Binding to, Option option) {
    option.topic = topic;
    option.looks = {"shaded comanche", "the others show numbers"};
    command.add(std::move(to), std::move(option));
  };
}

void add_ground_options(Command& command, PictureRequest& o, PictureFileNames& files) {
  const auto ground = lit(command, Topic::ground);
  command.add(
      [&o, &files](const std::string& text) { set_ramp(text, o, files); },
      {.names = "--ramp",
       .value = "RAMP",
       .help = "colours by height",
       .choices = {ramp_names().begin(), ramp_names().end()},
       .files = "cpt txt clr png",
       .note = "or a file: .cpt, .txt or .clr of gdaldem, .png of 1 x N colours",
       .fallback = "hypsometric; viridis for the looks steps and cost",
       .now = [&o, &files] { return files.ramp.empty() ? o.ramp : files.ramp; },
       .topic = Topic::ground,
       .common = true,
       .looks = {"shaded steps cost comanche slope", "the others have their own colours"},
       .rules = {{"has no effect without --volume or --look steps or cost (voxels and meshes have their own colours)",
                  [&command] {
                    const std::string look = command.value("--look");
                    return command.given("--volume") || look == "steps" || look == "cost";
                  },
                  kVoxels | kMesh}}});
  command.add([&o](const std::string& text) { o.ramp_range = ramp_range_from(text); },
              {.names = "--ramp-range",
               .value = "LOW,HIGH",
               .help = "heights of the first and last colour, also for --look height,",
               .unit = "metres",
               .fallback = "lowest and highest ground",
               .topic = Topic::ground,
               .looks = {"shaded height comanche level", "the others show no heights"},
               .rules = {{"has no effect with --ground natural", [&o] { return !o.natural; }},
                         {"has no effect without --look height (voxels and meshes have their own colours)",
                          [&command] { return command.value("--look") == "height"; }, kVoxels | kMesh}}});
  ground([&o](const std::string& text) { o.natural = text == "natural"; },
         {.names = "--ground",
          .value = "KIND",
          .help = "ground colours",
          .choices = {"ramp", "natural"},
          .closed = true,
          .note = "natural: rock, grass and snow",
          .fallback = "ramp",
          .now = [&o] { return std::string(o.natural ? "natural" : ""); },
          .common = true});
  ground(&o.snow_line, {.names = "--snow-line",
                        .help = "height of the snow line",
                        .unit = "metres",
                        .fallback = fmt::format("{} of the relief", GroundPaintSettings{}.snow_share),
                        .rules = {needs("--ground natural", [&o] { return o.natural; })}});
  const Rule detailed = needs("--detail F or --detail-texture FILE", [&o, &files] {
    return o.detail.value_or(files.detail_texture.empty() ? 0 : kTextureDetail) > 0;
  });
  ground(&o.detail, {.names = "--detail",
                     .help = "strength of noise patches or of --detail-texture",
                     .range = {0, 1},
                     .fallback = fmt::format("0; {} with --detail-texture", kTextureDetail)});
  ground(&o.detail_size, {.names = "--detail-size",
                          .help = "size of the largest patches or width of --detail-texture",
                          .unit = "metres",
                          .range = kZeroOrMore,
                          .fallback = "16 cells",
                          .rules = {detailed}});
  ground(&files.detail_texture,
         {.names = "--detail-texture",
          .value = "FILE",
          .help = "image, repeated over the ground, whose grey levels replace the noise",
          .files = "*",
          .rules = {{"has no effect with --detail 0", [&o] { return o.detail.value_or(1) > 0; }}}});
  ground(&o.contours, {.names = "--contours",
                       .help = "contour interval",
                       .unit = "metres",
                       .range = kZeroOrMore,
                       .fallback = "none",
                       .common = true});
  ground(&files.overlay,
         {.names = "--overlay",
          .value = "FILE",
          .help = "image draped over everything: on georeferenced terrain by its own georeference (without: "
                  "--overlay-fit), else over the scene or --extent",
          .files = "*",
          .common = true});
  ground(&files.overlay_fit,
         {.names = "--overlay-fit",
          .help = "--overlay stretched over the whole terrain, border to border, whatever its georeference",
          .note = "without it, image and terrain must both be georeferenced or neither",
          .rules = {needs("--overlay FILE", [&files] { return !files.overlay.empty(); })}});
}

void add_water_options(Command& command, PictureRequest& o) {
  const WaterSettings usual;
  const auto water = lit(command, Topic::water);
  // A scene file may have its own water and fog.
  const Rule wet = needs(
      "--water M", [&o] { return o.water_level.has_value(); }, kEveryInput & ~kScene);
  water(&o.water_level, {.names = "--water",
                         .help = "water level",
                         .unit = "metres",
                         .note = "water covers all ground below it",
                         .common = true});
  water(&o.no_water, {.names = "--no-water",
                      .help = "without the water of the scene file",
                      .inputs = {kScene, "only scene files have their own water"},
                      .excludes = {"--water"}});
  water([&o](const std::string& text) { o.water_srgb = colour_from(text, "--water-colour"); },
        {.names = "--water-colour",
         .value = "RRGGBB",
         .help = "colour of deep water",
         .fallback = colour_text(usual.srgb),
         .now = [&o] { return o.water_srgb ? colour_text(*o.water_srgb) : std::string(); },
         .rules = {wet}});
  water(&o.water_turbidity, {.names = "--turbidity",
                             .help = "light lost beyond that of pure water, per metre",
                             .range = kZeroOrMore,
                             .fallback = fmt::format("{}", usual.turbidity),
                             .rules = {wet}});
  water(&o.waves, {.names = "--waves",
                   .help = "mean slope of the waves",
                   .range = {0, 0.5},
                   .note = "0: a mirror",
                   .fallback = fmt::format("{}", usual.waves),
                   .rules = {wet}});
  water(&o.wavelength, {.names = "--wavelength",
                        .help = "length of the longest wave",
                        .unit = "metres",
                        .range = kZeroOrMore,
                        .fallback = "two cells",
                        .rules = {wet}});
  water(Off{&o.reflection},
        {.names = "--no-reflection", .help = "reflection of the sky only, not of the terrain", .rules = {wet}});
  water(Off{&o.refraction},
        {.names = "--no-refraction", .help = "opaque water of one colour, whatever its depth", .rules = {wet}});
}

void add_fog_options(Command& command, PictureRequest& o) {
  const auto fog = lit(command, Topic::fog);
  const auto names_of_fog = [] {
    std::vector<std::string> names;
    for (const FogKind kind : {FogKind::none, FogKind::distance, FogKind::height, FogKind::iterations})
      names.emplace_back(name_of(kind));
    return names;
  };
  const Rule foggy = needs(
      "--fog KIND", [&o] { return o.fog && *o.fog != FogKind::none; }, kEveryInput & ~kScene);
  const Rule high = needs(
      "--fog height", [&o] { return o.fog == FogKind::height; }, kEveryInput & ~kScene);
  fog([&o](const std::string& text) { o.fog = find_fog(text); },
      {.names = "--fog",
       .value = "KIND",
       .help = "fog",
       .choices = names_of_fog(),
       .closed = true,
       .note = "iterations: by marching steps",
       .fallback = "none",
       .now = [&o] { return o.fog ? std::string(name_of(*o.fog)) : std::string(); },
       .common = true,
       .rules = {{"iterations needs --look comanche --march fixed-step (use distance or height)", [&command, &o] {
                    return o.fog != FogKind::iterations ||
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
  fog(&o.sun_tint, {.names = "--sun-tint",
                    .help = "warmth of the fog towards the sun",
                    .range = {0, 1},
                    .fallback = fmt::format("{}", FogSettings{}.sun_tint),
                    .rules = {foggy, {"has no effect with --sky scattering, which sets the colour of fog", [&command] {
                                        return command.value("--sky") != "scattering";
                                      }}}});
}

void add_large_pixel_options(Command& command, PictureRequest& o) {
  // In the window, pictures of the look shaded have the window's size.
  const bool written = command.find("--output") != nullptr;
  constexpr Looks kLarge{"comanche"}, kStepping{"height comanche"};
  const Looks pixels{written ? "shaded height comanche" : "height comanche", "other looks have --size"};
  const Rule stepped = needs("--march fixed-step", [&command] { return command.value("--march") == "fixed-step"; });
  const Rule alone{"has no effect with --mesh, where rays step by --fixed-step",
                   [&command] { return !command.given("--mesh"); }};
  constexpr Inputs kStepped{kTerrain, "rays over functions step by --function-step M", "its rays do not step"};
  const Rule large_pixels{"needs --lowres WIDTHxHEIGHT without --look comanche",
                          [&o] { return o.look == Look::comanche || o.low_resolution; }};
  const auto large = [&](Binding to, Option option) {
    option.topic = Topic::comanche;
    command.add(std::move(to), std::move(option));
  };
  const auto set_low_resolution = [&o](const std::string& text) {
    const auto [width, height] = pixels_from(text, "--lowres", "320x240");
    o.low_resolution = ImageSize{width, height};
  };
  large(set_low_resolution, {.names = "--lowres",
                             .value = "WIDTHxHEIGHT",
                             .help = "size of the picture in large pixels",
                             .note = "the look height then uses the rays and camera of comanche",
                             .fallback = fmt::format("{}x{}", kLowResolution.width, kLowResolution.height),
                             .looks = pixels,
                             .excludes = {"--size", "--refine"}});
  large(&o.comanche.scale, {.names = "--pixel-size",
                            .value = "PX",
                            .help = "side of a large pixel in pixels of the image",
                            .range = {1, 64},
                            .looks = pixels,
                            .rules = {large_pixels}});
  large(&o.comanche.steps, {.names = "--steps",
                            .help = "number of steps of fixed-step over the reach",
                            .range = {1, 65536},
                            .inputs = kStepped,
                            .looks = kStepping,
                            .rules = {stepped, large_pixels, alone}});
  large(&o.comanche.shells, {.names = "--shells",
                             .help = "fixed-step samples on spheres round the eye instead of planes",
                             .note = "hits are at samples unless --fixed-step-interpolate true",
                             .inputs = kStepped,
                             .looks = kStepping,
                             .rules = {stepped, large_pixels, alone}});
  large(&o.comanche.step_by_view, {.names = "--step-by-view",
                                   .help = "longer fixed-step steps for rays that point down",
                                   .inputs = kStepped,
                                   .looks = kStepping,
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

}  // namespace

void add_look_options(Command& command, PictureRequest& o, PictureFileNames& files) {
  add_ground_options(command, o, files);
  add_water_options(command, o);
  add_fog_options(command, o);
  add_large_pixel_options(command, o);
}

PictureFiles read_picture_files(const PictureFileNames& names, const PictureRequest& request) {
  PictureFiles files;
  if (!names.detail_texture.empty()) files.detail_texture = read_detail_texture(names.detail_texture);
  if (names.ramp.empty()) return files;
  RampStops stops;
  const std::string extension = extension_of(names.ramp);
  if (extension == ".cpt") {
    stops = read_cpt(names.ramp);
  } else if (extension == ".png") {
    const ColourImage row = read_colour_row(names.ramp);
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < row.rgba.size(); ++i) {
      if (i % 4 != 3) rgb.push_back(row.rgba[i]);
    }
    stops = ramp_of_row(rgb);
  } else {
    stops = read_colour_relief(names.ramp);
  }
  if (request.ramp_range && !stops.stretched)
    throw Error(fmt::format("--ramp-range: {} has heights of its own (leave one of the two out)", names.ramp));
  files.ramp_stops = std::make_shared<RampStops>(std::move(stops));
  return files;
}

OverlayFiles read_overlay_files(const PictureFileNames& names, const Georeference& georeference, int cols, int rows,
                                bool mirror, std::int64_t most_pixels) {
  if (names.overlay.empty()) return {};
  Overlay overlay = read_overlay(names.overlay, georeference, cols, rows, most_pixels, names.overlay_fit);
  ColourImage& image = overlay.image;
  return {std::make_shared<Drape>(Drape{image.width,
                                        image.height,
                                        std::move(image.rgba),
                                        {overlay.west, overlay.north},
                                        {overlay.east, overlay.south},
                                        mirror}),
          std::move(image.files)};
}

}  // namespace scarp::cli
