// SPDX-License-Identifier: MIT
#include "app/cli/function_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "app/cli/device_option.h"
#include "app/cli/exr_output.h"
#include "app/cli/findings.h"
#include "app/cli/numbers.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/march/function/presets.h"
#include "scarp/output/png.h"
#include "scarp/render/camera/compass.h"
#include "scarp/render/frame/scene_picture.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/file/example_functions.h"

namespace scarp::cli {
namespace {

constexpr double kHaze = 0.2;        // share over the extent, without --haze
constexpr double kFaintest = 64;     // rays end where haze hides all but 1 / 64 of a colour
constexpr double kLongReach = 64;    // extents, where there is less haze
constexpr double kErrorPercent = 1;  // of the error look, without --error-tolerance
const ViewSettings kView{.azimuth_deg = 190, .elevation_deg = 14, .distance = 0.5, .fov_deg = 45};

// Of the square that is looked at, on a lattice.
SeenHeights heights_around(const HeightFunction& function, double extent) {
  constexpr int kSide = 129;
  SeenHeights range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double h = function.value(extent * (col / (kSide - 1.0) - 0.5), extent * (row / (kSide - 1.0) - 0.5));
      range = {std::min(range.low, h), std::max(range.high, h)};
    }
  }
  return range;
}

Camera camera_of(const HeightFunction& function, const FunctionInput& input, const FunctionPicture& settings) {
  const int width = settings.picture.width, height = settings.picture.height;
  const dvec3 middle(0, 0, function.value(0, 0));
  const auto point = [](const std::string& text, std::string_view option) {
    const auto p = numbers_from(text, ',', 3, 3, option, "X,Y,Z in metres, for example 500,-2000,1800");
    return dvec3(p[0], p[1], p[2]);
  };
  const dvec3 target = settings.target.empty() ? middle : point(settings.target, "--target");
  ViewSettings view = kView;
  if (settings.view_given) view = settings.view;
  if (settings.fov_given) view.fov_deg = settings.view.fov_deg;
  validate(view);
  if (!settings.eye.empty()) return Camera::look_at(point(settings.eye, "--eye"), target, view.fov_deg, width, height);
  constexpr double kDegree = 3.14159265358979323846 / 180;
  dvec3 eye =
      target + view.distance * input.extent * towards(view.azimuth_deg * kDegree, view.elevation_deg * kDegree, 0);
  const double least = function.value(eye.x, eye.y) + 0.01 * input.extent;
  if (eye.z < least) {
    fmt::print(stderr, "note: the eye is raised by {} m, to {} m above the ground\n", metres_text(least - eye.z),
               metres_text(0.01 * input.extent));
    eye.z = least;
  }
  return Camera::look_at(eye, target, view.fov_deg, width, height);
}

// Meadows, dry grass and snow by height, rock where it is steep; or one of the ramps.
SceneLook look_of_heights(const SeenHeights& range, const std::string& ramp, double haze_distance) {
  const auto at = [&](double share) { return range.low + share * (range.high - range.low); };
  Material by_height = HeightRamp{ramp, range.low, range.high};
  if (ramp.empty()) {
    by_height = HeightStops{{{at(0.0), {0.40f, 0.47f, 0.30f}},
                             {at(0.35), {0.50f, 0.53f, 0.33f}},
                             {at(0.6), {0.62f, 0.57f, 0.42f}},
                             {at(0.8), {0.66f, 0.62f, 0.57f}},
                             {at(0.88), {0.93f, 0.94f, 0.96f}}}};
  }
  std::vector<Material> materials{by_height, PlainColour{{0.47f, 0.43f, 0.40f}}};
  if (ramp.empty()) materials.emplace_back(Blend{Blend::By::slope, 30, 45, 0, 1});
  return {std::move(materials), haze_distance};
}

void print_error(const FunctionErrorPicture& error, double percent) {
  fmt::print("judged by lipschitz-local; tolerance {:.3g} % of the distance along the ray; pixels:\n", percent);
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    fmt::print("  {:10}  {:9}  {}\n", name_of(verdict), colour_name_of(verdict), error.counts[verdict]);
  }
  fmt::print("of these {} proven by interval bisection, which contradicts the judge {} times\n", error.judged,
             error.contradictions);
}

}  // namespace

namespace {

constexpr const char* kGroup = "Terrain functions";

}  // namespace

void add_function_option(CLI::App& command, FunctionInput& input, const std::string& extent) {
  std::vector<std::string_view> names;
  for (const ExampleFunction& example : example_functions()) names.push_back(example.name);
  command
      .add_option(
          "--function", input.function,
          fmt::format("in the place of files: {}, or a JSON file (doc/user/functions.md)", fmt::join(names, ", ")))
      ->group(kGroup);
  command.add_option("--extent", input.extent, extent)
      ->check(number_in({.least = 0, .most = kFunctionReach, .above_least = true}))
      ->group(kGroup)
      ->capture_default_str();
}

void add_function_options(CLI::App& command, FunctionInput& input, std::string& march, MarchSettings& settings) {
  add_function_option(command, input, "metres of ground that the picture is about; above 0");
  std::vector<std::string_view> presets;
  for (const MarchPreset& preset : march_presets()) presets.push_back(preset.name);
  command
      .add_option_function<std::string>(
          "--preset",
          [&input, &march, &settings](const std::string& name) {
            const MarchPreset& preset = find_march_preset(name);
            input.preset = name;
            march = preset.march;
            settings = preset.settings;
          },
          fmt::format("a march with the numbers of a known shader: {}; see 'scarp marches --presets'",
                      fmt::join(presets, ", ")))
      ->group(kGroup);
}

void render_function(const FunctionInput& input, FunctionPicture settings, const std::string& output) {
  const FunctionMarchEntry& march = find_function_march(settings.march.empty() ? kFunctionMarch : settings.march);
  ReplaceFile file(output);
  const HeightFunction function(read_function(input.function));
  const double haze = settings.haze_given ? settings.picture.haze : kHaze;
  const double haze_distance = -input.extent / std::log(1 - haze);
  if (std::isinf(settings.march_settings.function.reach)) {
    settings.march_settings.function.reach = std::min(haze_distance * std::log(kFaintest), kLongReach * input.extent);
  }
  if (settings.picture.look == Look::error && !settings.device.empty())
    throw Error("--device: the look error is judged on the CPU; leave it out");
  const Camera camera = camera_of(function, input, settings);
  const auto begin = std::chrono::steady_clock::now();
  const auto took = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const auto tell = [&](double seconds, const std::string& on) {
    fmt::print("{}: {} x {} pixels; {}{}; render {:.2f} s{}\n", output, settings.picture.width, settings.picture.height,
               march.name, input.preset.empty() ? "" : " as in " + input.preset, seconds,
               on.empty() ? "" : ", on " + on);
  };
  const auto done = [&](const Image& image, const std::string& on) {
    const double seconds = took();
    write_png(file, output, {image.rgb.data(), image.width, image.height});
    tell(seconds, on);
  };
  if (settings.picture.look == Look::error) {
    const double percent = settings.tolerance_given ? settings.picture.error_tolerance : kErrorPercent;
    const FunctionErrorPicture error = render_function_error(
        function, march, settings.march_settings, camera,
        {percent / 100, settings.march_settings.function.reach, settings.picture.width, settings.picture.height},
        terminal_progress("render"));
    done(error.image, {});
    print_error(error, percent);
    return;
  }
  const SceneLook look = look_of_heights(heights_around(function, input.extent), settings.picture.ramp, haze_distance);
  const auto [scene, device] = scene_on_device(
      settings.device,
      Scene({scene_function(function, march, settings.march_settings)},
            {{.field = 0, .material = static_cast<std::uint32_t>(look.materials.size() == 3 ? 2 : 0)}}));
  if (std::isinf(settings.picture.ao_distance)) settings.picture.ao_distance = input.extent / 8;
  if (settings.exr) {
    const PictureLayers layers =
        render_scene_layers(scene, look, camera, settings.picture, terminal_progress("render"));
    const double seconds = took();
    write_layers(file, output, layers, camera, settings.depth_range);
    tell(seconds, device);
    return;
  }
  const Picture picture = render_scene(scene, look, camera, settings.picture, terminal_progress("render"));
  done(picture.image, device);
  print_findings(picture);
}

}  // namespace scarp::cli
