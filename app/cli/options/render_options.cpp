// SPDX-License-Identifier: MIT
#include "app/cli/options/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "app/cli/options/device_option.h"
#include "app/cli/options/field_options.h"
#include "app/cli/options/march_options.h"
#include "app/cli/options/picture_format.h"
#include "app/cli/options/places.h"
#include "app/cli/options/raster_options.h"
#include "app/cli/options/shared_options.h"
#include "app/options/numbers.h"

namespace scarp::cli {
namespace {

constexpr std::string_view kNoPlinth = "only a raster alone is shown on a plinth";
constexpr Looks kLit{"shaded comanche", "the others show numbers"};

bool has_numbers(Look look) { return look == Look::slope || look == Look::aspect || look == Look::multidirectional; }

// All looks except level:N.
std::vector<std::string> plain_looks() {
  std::vector<std::string> looks;
  for (const LookEntry& entry : scarp::looks()) {
    if (entry.look != Look::level) looks.emplace_back(entry.name);
  }
  return looks;
}

// "steps", "level:3".
void set_look(const std::string& text, PictureRequest& request) {
  const std::string level = std::string(name_of(Look::level)) + ":";
  if (text.starts_with(level)) {
    const char *first = text.data() + level.size(), *last = text.data() + text.size();
    const auto [rest, error] = std::from_chars(first, last, request.level);
    if (error != std::errc() || rest != last || request.level < 0)
      throw WrongUsage(fmt::format("--look '{}': expected {}N, N a whole number, 0 or more", text, level));
    request.look = Look::level;
    return;
  }
  const std::vector<std::string> plain = plain_looks();
  if (std::find(plain.begin(), plain.end(), text) == plain.end()) {
    std::vector<std::string_view> words(plain.begin(), plain.end());
    words.push_back("level:N");
    throw WrongUsage(fmt::format("--look '{}': expected {}", text, listed(words, "or")));
  }
  request.look = find_look(text);
}

StepScale step_scale_from(const std::string& text) {
  const auto range = numbers_from(text, ',', 2, 2, "--steps-range", "LOW,HIGH, for example 0,128");
  if (!(range[0] >= 0 && range[1] - range[0] >= 1))
    throw Error(fmt::format("--steps-range '{}': expected 0 <= LOW, and HIGH at least 1 above it", text));
  return {range[0], range[1]};
}

TypedView view_from(const std::string& text) {
  const auto numbers = numbers_from(text, ',', 2, 3, "--view",
                                    "AZIMUTH,ELEVATION[,DISTANCE] in degrees and multiples of the framed distance, "
                                    "for example 205,35 or 205,35,0.5");
  return {numbers[0], numbers[1], numbers.size() == 3 ? std::optional(numbers[2]) : std::nullopt};
}

TypedArea area_from(const std::string& text) {
  const auto edges =
      ground_numbers_from(text, 4, 4, "--area", "W,S,E,N in coordinates of --coords, for example 0,0,500,300");
  return {edges[0], edges[1], edges[2], edges[3], text};
}

void add_picture_options(Command& command, RenderOptions& o) {
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::picture;
    command.add(std::move(to), std::move(option));
  };
  const PictureSettings usual;
  PictureRequest& picture = o.picture;
  const auto set_size = [&picture](const std::string& text) {
    const auto [width, height] = pixels_from(text, "--size", "1280x720");
    picture.width = width, picture.height = height;
  };
  add(set_size,
      {.names = "--size",
       .value = "WIDTHxHEIGHT",
       .help = "size of the picture in pixels",
       .fallback = fmt::format("{}x{}; with --top the aspect ratio of the ground or --area", usual.width, usual.height),
       .common = true,
       .looks = {"shaded hillshade height steps cost error level slope aspect multidirectional",
                 "it has --lowres WIDTHxHEIGHT and --pixel-size PX"}});
  add([&picture](const std::string& text) { set_look(text, picture); },
      {.names = "--look",
       .value = "LOOK",
       .help = "what the picture shows",
       .choices = plain_looks(),
       .note = "or level:N, level N of the maximum pyramid; cost: values that the march reads",
       .fallback = std::string(name_of(usual.look)),
       .now = [&picture] { return std::string(name_of(picture.look)); },
       .common = true,
       .rules = {{"cost needs a picture without --device (it counts the reads of the CPU's marches)",
                  [&o] { return o.picture.look != Look::cost || o.device.empty(); }},
                 {"level:N needs a raster (other inputs have no pyramid)",
                  [&picture] { return picture.look != Look::level; }, kEveryInput & ~kTerrain}}});
  add(&picture.aa, {.names = "--aa",
                    .help = "anti-aliasing: N x N samples per pixel",
                    .range = {1, 16},
                    .fallback = fmt::format("{}", usual.aa),
                    .looks = {"shaded", "the others show one ray per pixel"}});
  add(&o.no_plinth, {.names = "--no-plinth",
                     .help = "no walls below the border of the terrain",
                     .inputs = {kTerrain, kNoPlinth, kNoPlinth}});
  add([&picture](const std::string& text) { picture.step_scale = step_scale_from(text); },
      {.names = "--steps-range",
       .value = "LOW,HIGH",
       .help = "counts of the first and last colour, to compare pictures",
       .note = "steps, or reads of the look cost",
       .fallback = "minimum and maximum in the picture",
       .looks = {"steps cost"}});
  constexpr ErrorSettings kErrors;
  add(&picture.error_tolerance,
      {.names = "--error-tolerance",
       .help = "tolerance of the look error along the ray: cells, or percent of the distance for functions and shapes",
       .range = kZeroOrMore,
       .fallback = fmt::format("{}; functions and shapes {}", kErrors.tolerance, 100 * kErrors.share),
       .looks = {"error"}});
}

void add_light_options(Command& command, RenderOptions& o) {
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::light;
    command.add(std::move(to), std::move(option));
  };
  const PictureSettings usual;
  PictureRequest& picture = o.picture;
  // The scene file may set the number of samples.
  const Rule sampled = needs(
      "--samples N", [&picture] { return picture.samples.value_or(0) > 0; }, kEveryInput & ~kScene);
  const auto set_sun = [&picture](const std::string& text) {
    const auto sun = numbers_from(text, ',', 2, 2, "--sun", "AZIMUTH,ALTITUDE in degrees, for example 315,45");
    picture.sun_azimuth_deg = sun[0], picture.sun_altitude_deg = sun[1];
  };
  add(set_sun, {.names = "--sun",
                .value = "AZ,ALT",
                .help = "compass azimuth and altitude of the sun in degrees",
                .note = "from -6 with --sky scattering",
                .fallback = fmt::format("{},{}; voxels and meshes {},{}", usual.sun.azimuth_deg, usual.sun.altitude_deg,
                                        kModelSunAzimuth, usual.sun.altitude_deg),
                .now =
                    [&picture] {
                      const SunSettings sun;
                      return fmt::format("{},{}", picture.sun_azimuth_deg.value_or(sun.azimuth_deg),
                                         picture.sun_altitude_deg.value_or(sun.altitude_deg));
                    },
                .common = true,
                .looks = {"shaded hillshade comanche", "the others show no sunlight"},
                .rules = {{"has no effect with --unlit, except on --water, --fog, --sky and --ground natural",
                           [&picture] {
                             return !picture.unlit || picture.water_level || picture.fog ||
                                    picture.sky == SkyKind::scattering || picture.natural;
                           },
                           kEveryInput & ~kScene}}});
  add([&picture](const std::string& text) { picture.sky = find_sky(text); },
      {.names = "--sky",
       .value = "KIND",
       .help = "sky model",
       .choices = {"plain", "scattering"},
       .closed = true,
       .note = "scattering: daylight with its sun",
       .fallback = "plain",
       .now = [&picture] { return picture.sky ? std::string(name_of(*picture.sky)) : std::string(); },
       .common = true,
       .looks = kLit});
  add(&picture.sky_turbidity,
      {.names = "--sky-turbidity",
       .help = "turbidity of the air: extinction relative to pure air",
       .range = {2, 10},
       .note = "2: very clear, 10: hazy",
       .fallback = fmt::format("{}", usual.sky.turbidity),
       .looks = kLit,
       .rules = {needs(
           "--sky scattering", [&picture] { return picture.sky == SkyKind::scattering; }, kEveryInput & ~kScene)}});
  add_tone_option(command, Off{&picture.tone_curve}, o.output, Topic::light, kLit);
  add(&picture.unlit, {.names = "--unlit",
                       .help = "surface colours without sunlight, skylight and shadows",
                       .looks = kLit,
                       .excludes = {"--no-shadows", "--samples", "--sun-size", "--ao-distance", "--seed",
                                    "--no-tone-curve", "--normals", "--normal-radius", "--corner-ao"}});
  add(Off{&picture.shadows}, {.names = "--no-shadows", .help = "no cast shadows", .common = true, .looks = {"shaded"}});
  add(&picture.samples, {.names = "--samples",
                         .help = "rays to sun and sky per sample, for soft shadows and ambient occlusion",
                         .range = {0, 4096},
                         .note = "best a power of 2; 0: hard shadows",
                         .fallback = fmt::format("{}", usual.samples),
                         .common = true,
                         .looks = kLit});
  add(&picture.sun_size_deg, {.names = "--sun-size",
                              .help = "apparent diameter of the sun",
                              .unit = "degrees",
                              .range = {0, 90},
                              .note = "0: hard shadows",
                              .fallback = fmt::format("{}", usual.sun.size_deg),
                              .looks = {"shaded"},
                              .rules = {sampled}});
  add(&picture.ao_distance, {.names = "--ao-distance",
                             .help = "maximum ambient-occlusion distance",
                             .unit = "metres",
                             .range = kZeroOrMore,
                             .note = "0: no ambient occlusion",
                             .fallback = "unlimited",
                             .looks = kLit,
                             .rules = {sampled}});
  add(&picture.seed, {.names = "--seed",
                      .help = "seed of the pattern of --samples",
                      .range = {0, static_cast<double>(std::numeric_limits<std::uint32_t>::max())},
                      .fallback = fmt::format("{}", usual.seed),
                      .looks = kLit,
                      .rules = {sampled}});
  add(&picture.haze, {.names = "--haze",
                      .help = "fraction of haze over the diagonal of the scene (functions: over --extent)",
                      .range = {0, 0.95},
                      .fallback = fmt::format("{}; functions {}; other inputs 0", usual.haze, kFunctionHaze),
                      .looks = {"shaded", "the others have no haze", kEveryInput & ~kFunction},
                      .rules = {{"has no effect with --fog, which replaces it",
                                 [&picture] { return picture.fog.value_or(FogKind::none) == FogKind::none; },
                                 kEveryInput & ~kFunction}}});
}

// `frames`: whether the command has options for several pictures.
void add_camera_options(Command& command, RenderOptions& o, bool frames) {
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::camera;
    command.add(std::move(to), std::move(option));
  };
  using Rules = std::vector<Rule>;
  const Rules no_frames = frames ? Rules{{"has no effect with --path or --turntable, which define their own cameras",
                                          [&o] { return !o.frames.fly(); }}}
                                 : Rules{};
  const Rules no_path = frames ? Rules{{"has no effect with --path, whose table defines the cameras",
                                        [&o] { return o.frames.path.empty(); }}}
                               : Rules{};
  const std::string or_path = frames ? " or --path FILE" : "";
  const auto with = [](Rules rules, Rule more) {
    rules.push_back(std::move(more));
    return rules;
  };
  const ViewSettings view;
  CameraOptions& camera = o.camera;
  add([&camera](const std::string& text) { camera.view = view_from(text); },
      {.names = "--view",
       .value = "AZ,EL[,DIST]",
       .help = "camera position: compass azimuth and elevation in degrees, distance relative to that at which "
               "everything fits",
       .fallback = fmt::format("{},{},{}", view.azimuth_deg, view.elevation_deg, view.distance),
       .common = true,
       .rules = no_path,
       .excludes = {"--eye"}});
  add([&camera](const std::string& text) { camera.eye = typed_place(text, "--eye"); },
      {.names = "--eye",
       .value = "X,Y[,Z]",
       .help = "camera position (see --coords)",
       .note = "Z is needed without --eye-above",
       .common = true,
       .rules = no_frames});
  add(&camera.eye_above,
      {.names = "--eye-above",
       .help = "height of the eye above the highest surface or water below,",
       .unit = "metres",
       .range = {.least = 0, .most = kMostOfGround, .above_least = true},
       .note = "not exaggerated",
       .rules = {needs("--eye X,Y" + or_path, [&o] { return o.camera.eye || !o.frames.path.empty(); })}});
  add([&camera](const std::string& text) { camera.target = typed_place(text, "--target"); },
      {.names = "--target",
       .value = "X,Y[,Z]",
       .help = "point to look at; on the ground if Z is omitted",
       .fallback = "the middle",
       .common = true,
       .rules = with(no_frames, needs("--eye X,Y[,Z]", [&camera] { return camera.eye.has_value(); }))});
  add_coordinates_option(
      command, camera.coordinates,
      {.names = "--coords",
       .help = frames ? "coordinates of --eye, --target, --area, --mesh-at and --path"
                      : "coordinates of --eye, --target, --area and --mesh-at",
       .note = "local: metres from the south-west sample, z exaggerated; map: units of the CRS; lonlat: degrees, WGS "
               "84; for map and lonlat, z is in metres as in the file",
       .topic = Topic::camera,
       .rules = {needs(frames ? "--eye, --area, --path or --mesh-at" : "--eye, --area or --mesh-at", [&o] {
         return o.camera.eye || o.camera.area || !o.frames.path.empty() || !o.mesh.at.empty();
       })}});
  add(&camera.fov_deg,
      {.names = "--fov",
       .help = "vertical field of view",
       .unit = "degrees",
       .range = {1, 150},
       .fallback = fmt::format("{}; comanche {}, functions {}", view.fov_deg, kComancheFov, kFunctionView.fov_deg),
       .common = true});
  add(&camera.top, {.names = "--top",
                    .help = "map: straight down, without perspective, grid north up",
                    .common = true,
                    .inputs = {kEveryInput & ~kFunction, "functions have no border to fit a map to"},
                    .rules = no_frames,
                    .excludes = {"--view", "--eye", "--fov"}});
  add([&camera](const std::string& text) { camera.area = area_from(text); },
      {.names = "--area",
       .value = "W,S,E,N",
       .help = "part that the map shows, in coordinates of --coords",
       .fallback = "everything",
       .rules = {needs("--top", [&camera] { return camera.top; })}});
}

}  // namespace

void declare_picture(Command& command, RenderOptions& o, bool written) {
  add_raster_inputs(command, o.inputs, kEveryFile, false);
  if (written)
    add_output_option(command, o.output, picture_help() + ", .gif, .mp4 (films)", picture_extensions() + " gif mp4");
  add_device_option(command, o.device);
  add_voxel_drawing_option(command, o.voxel_drawing, o.device);
  add_threads_option(command, o.threads);
  add_picture_options(command, o);
  add_light_options(command, o);
  add_camera_options(command, o, written);
  add_field_options(command, o.field, BeyondBorders::mirrors, &o.exaggeration);
  add_look_options(command, o.picture, o.picture_files);
  if (written) {
    add_figure_options(command, o.figure, o.camera.top, o.output);
    add_frame_options(command, o.frames);
    add_depth_options(command, o.depth);
    command.add(&o.json, {.names = "--json",
                          .help = "one JSON object instead of text: times, and the numbers of the looks steps, cost, "
                                  "error and height",
                          .rules = {{"describes one picture, without --path, --turntable or --animate",
                                     [&o] { return !o.frames.several(); }}}});
    add_quiet_option(command, o.quiet, {"--json"});
  }
  add_mesh_options(command, o.mesh);
  add_vox_options(command, o.vox);
  add_vox_rounding_options(command, o.vox_look);
  add_vox_look_options(command, o.vox_look);
  add_function_options(command, o.function, "side of the ground in the picture", o.march, o.march_settings);
  add_raster_options(command, o.raster);
  command.add(&o.full, {.names = "--full",
                        .help = fmt::format("all samples of rasters with more than {} million, instead of "
                                            "averages of blocks",
                                            Decimation{}.above / 1'000'000),
                        .topic = Topic::input,
                        .inputs = {kTerrain, "other inputs are always read completely"}});
  add_march_option(command, o.march);
  if (written) add_compare_option(command, o.compared, [&o] { return o.frames.fly(); });
  add_march_options(command, o.march_settings, &o.picture.interpolate);
}

ViewSettings view_of(const CameraOptions& camera, Look look) {
  ViewSettings view;
  view.fov_deg = camera.fov_deg.value_or(look == Look::comanche ? kComancheFov : view.fov_deg);
  if (camera.view) {
    view.azimuth_deg = camera.view->azimuth_deg, view.elevation_deg = camera.view->elevation_deg;
    view.distance = camera.view->distance.value_or(view.distance);
  }
  return view;
}

void check_picture(const RenderOptions& options) {
  resolve(options.picture, {});
  const CameraOptions& camera = options.camera;
  validate(view_of(camera, look_of(options.picture)));
  validate(options.march_settings);
  if (camera.eye && camera.eye->z.has_value() == camera.eye_above.has_value()) {
    throw Error(fmt::format(
        "--eye '{}': {}", camera.eye->text,
        camera.eye_above ? "--eye-above replaces Z (give X,Y)" : "expected X,Y,Z, or X,Y with --eye-above M"));
  }
}

Command& declare_render(Program& program, RenderOptions& o) {
  Command& command =
      program.add("render", "Render an elevation model, voxels, a mesh, a scene or a terrain function as a picture");
  declare_picture(command, o, true);
  command.example("scarp render dem.tif -o dem.png --sun 300,30");
  command.example("scarp render dem.tif -o map.png --top --contours 20 --legend --scale-bar");
  command.example("scarp render city.vox -o city.png --samples 16 --view 220,30");
  return command;
}

bool writes_numbers(const RenderOptions& options) {
  return has_numbers(look_of(options.picture)) && !options.output.empty() && picture_format_of(options.output).map;
}

}  // namespace scarp::cli
