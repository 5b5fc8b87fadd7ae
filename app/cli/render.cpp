// SPDX-License-Identifier: MIT
// `scarp render`: an elevation model, a voxel model or a scene in, a picture out.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/device_option.h"
#include "app/cli/exr_output.h"
#include "app/cli/field_options.h"
#include "app/cli/input_kind.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/march_options.h"
#include "app/cli/numbers.h"
#include "app/cli/raster_options.h"
#include "app/cli/render_input.h"
#include "app/cli/render_options.h"
#include "app/cli/render_run.h"
#include "app/cli/scene_input.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {
namespace {

int whole(double number, const RenderOptions& options) {
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    throw Error(fmt::format("--size '{}': expected WIDTHxHEIGHT in pixels, for example 1280x720", options.size));
  }
  return static_cast<int>(number);
}

// The texts become settings; all that can be judged without the file is judged here.
ViewSettings settle(RenderOptions& options) {
  PictureSettings& picture = options.picture;
  picture.look = find_look(options.look);
  picture.shadows = !options.no_shadows;
  if (options.is_given("--error-tolerance")) picture.error = {options.error_tolerance, options.error_tolerance / 100};
  settle_look(options.look_options, options.size, options.march, options.march_settings, picture);
  if (!options.size.empty()) {
    const auto size = numbers_from(options.size, 'x', 2, 2, "--size", "WIDTHxHEIGHT in pixels, for example 1280x720");
    picture.width = whole(size[0], options);
    picture.height = whole(size[1], options);
  }
  if (!options.sun.empty()) {
    const auto sun = numbers_from(options.sun, ',', 2, 2, "--sun", "AZIMUTH,ALTITUDE in degrees, for example 315,45");
    picture.sun.azimuth_deg = sun[0];
    picture.sun.altitude_deg = sun[1];
  }
  validate(picture);
  if (picture.look == Look::comanche && !options.is_given("--fov")) options.fov_deg = 60;
  ViewSettings view;
  view.fov_deg = options.fov_deg;
  if (!options.view.empty()) {
    const auto numbers = numbers_from(options.view, ',', 2, 3, "--view",
                                      "AZIMUTH,ELEVATION[,DISTANCE] in degrees and multiples of the framed distance, "
                                      "for example 205,35 or 205,35,0.5");
    view.azimuth_deg = numbers[0];
    view.elevation_deg = numbers[1];
    if (numbers.size() == 3) view.distance = numbers[2];
  }
  validate(view);
  validate(options.march_settings);
  settle_frames(options.frames, options.output);
  options.exr = extension_of(options.output) == ".exr";
  if (const auto range = depth_range_of(options.depth); range && !options.exr) {
    throw Error("--depth-range: device depth is a channel of EXR pictures; let the name of the output end in .exr");
  }
  settle_figure(options.figure, picture, options.exr);
  settle_mesh(options.mesh);
  if (options.exr) {
    require_exr(options.output);
    if (picture.look != Look::shaded) {
      throw Error(
          fmt::format("--look {}: EXR holds the look 'shaded' with depth, position and steps as channels of "
                      "their own; leave --look out, or let the name of the output end in .png",
                      options.look));
    }
  } else if (!options.output.empty() && extension_of(options.output) != ".png") {
    throw Error(fmt::format("output '{}': pictures are written as PNG or EXR; let the name end in .png or .exr",
                            options.output));
  }
  return view;
}

// The looks and numbers that `options` ask for, for what they have effect on.
void require_company_of(const RenderOptions& options, InputKind kind) {
  const PictureSettings& picture = options.picture;
  const bool steps = options.look == "steps";
  const LookOptions& look = options.look_options;
  require_company(
      {{{"--water-colour", "--turbidity", "--waves", "--wavelength", "--no-reflection", "--no-refraction"},
        look.water.has_value(),
        "--water M"},
       {{"--visibility", "--sun-tint"}, !look.fog.empty() && look.fog != "none", "--fog KIND"},
       {{"--fog-base", "--fog-falloff"}, look.fog == "height", "--fog height"},
       {{"--snow-line"}, look.ground_colours == "natural", "--ground natural"},
       {{"--detail-size"}, look.ground.detail > 0, "--detail S"},
       // The number may stand in the scene's file.
       {{"--sun-size", "--ao-distance", "--seed"}, picture.samples > 0 || kind == InputKind::scene, "--samples N"},
       {{"--mesh-at", "--mesh-scale", "--mesh-rotate", "--mesh-up"}, !options.mesh.file.empty(), "--mesh FILE"},
       {{"--normal-radius"}, options.vox_look.normals != "flat", "--normals voxel or smooth"},
       {{"--ramp"}, kind != InputKind::voxels || !options.vox.volume.empty() || steps, "--volume or --look steps"}},
      options.given);
  if (!options.frames.several()) return;
  for (const std::string_view option : {"--eye", "--target", "--top"}) {
    if (is_given(options.given, option))
      throw Error(fmt::format("{}: --path and --turntable have cameras of their own; leave it out", option));
  }
  if (!options.frames.path.empty() && is_given(options.given, "--view"))
    throw Error("--view: the cameras stand in the table of --path; leave it out");
}

// Throws Error for what was typed and would have no effect.
void require_effect(const RenderOptions& options, InputKind kind) {
  require_options_of(kind, options.given);
  find_look(options.look);
  require_options_of_look(options.look, kind, options.given);
  require_company_of(options, kind);
  if (kind == InputKind::terrain) {
    require_settings_of(options.march.empty() ? kTerrainMarch : options.march, options.given, options.march_settings);
  }
  if (kind == InputKind::function) {
    require_settings_of(options.march.empty() ? kFunctionMarch : options.march, options.given, options.march_settings);
  }
}

InputKind kind_of(const RenderOptions& options) {
  if (!options.function.function.empty()) {
    if (options.inputs.empty()) return InputKind::function;
    throw Error(fmt::format("'{}': --function stands in the place of files; give one of both", options.inputs.front()));
  }
  if (options.inputs.empty()) throw CLI::RequiredError("IN (or --function NAME)");
  if (!options.function.preset.empty())
    throw Error("--preset: has the numbers of shaders over functions; add --function");
  if (is_scene_input(options.inputs)) return InputKind::scene;
  return is_vox_input(options.inputs, options.vox) ? InputKind::voxels : InputKind::terrain;
}

void run(RenderOptions options) {
  const InputKind kind = kind_of(options);
  require_effect(options, kind);
  const ViewSettings view = settle(options);
  keep_inputs(options.output, options.typed);
  if (!options.eye.empty()) point_from(options.eye, "--eye");
  if (!options.target.empty()) point_from(options.target, "--target");
  const ThreadLimit limit(options.threads);
  render_input(kind, std::move(options), view);
}

}  // namespace

void add_render(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("render", "Render an elevation model, a voxel model or a scene into a picture");
  const auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  add_raster_inputs(*command, o.inputs)->required(false);
  command
      ->add_option("-o,--output", o.output,
                   "the picture: .png, or .exr in linear light with depth, normal, position and steps")
      ->required();
  command->add_option("--size", o.size, "WIDTHxHEIGHT in pixels (1280x720; with --top the shape of the ground)");
  command->add_option("--look", o.look, "shaded, height, steps, error, comanche")->capture_default_str();
  add_field_options(*command, o.field, BeyondBorders::mirrors);
  command->add_option(
      "--sun", o.sun,
      "AZIMUTH,ALTITUDE of the sun in degrees, compass and above the horizon (315,45; of voxels 235,45)");
  command->add_flag("--no-shadows", o.no_shadows, "hill shade only: the sun shines through the ground");
  command
      ->add_option(
          "--samples", o.picture.samples,
          "rays to the sun's disc for soft shadows, and as many to the sky for ambient occlusion, per sample of "
          "the shaded look: 1 to 4096, best a power of 2; 0: hard shadows alone")
      ->capture_default_str();
  command
      ->add_option("--sun-size", o.picture.sun.size_deg,
                   "apparent diameter of the sun in degrees for --samples, 0 to 90; 0: hard shadows")
      ->check(number_in({0, 90}))
      ->capture_default_str();
  command
      ->add_option("--ao-distance", o.picture.ao_distance,
                   "metres within which ground hides the sky (the whole field); 0: no ambient occlusion")
      ->check(number_in(kZeroOrMore));
  command->add_option("--seed", o.picture.seed, "of the pattern of --samples")
      ->check([](const std::string& text) {
        return check_whole_number(text, std::numeric_limits<decltype(o.picture.seed)>::max());
      })
      ->capture_default_str();
  command->add_flag("--no-plinth", o.no_plinth, "no walls below the terrain's border");
  command
      ->add_option("--haze", o.picture.haze,
                   "share of haze over a distance as long as the field's diagonal (of functions "
                   "over --extent, 0.2), 0 to 0.95")
      ->check(number_in({0, 0.95}))
      ->capture_default_str();
  command->add_option("--aa", o.picture.aa, "N x N samples per pixel of the shaded look, 1 to 16")
      ->capture_default_str();
  command
      ->add_option("--error-tolerance", o.error_tolerance,
                   "of the error look along the ray, in sides of a cell; of functions in percent of the distance (1)")
      ->check(number_in(kZeroOrMore))
      ->capture_default_str();
  add_look_options(*command, o.look_options);
  add_device_option(*command, o.device);
  command->add_option("--threads", o.threads, "threads, 0 for all")->check(CLI::Range(0, 1024))->capture_default_str();

  const std::string from = "Where from";
  CLI::Option* view = command
                          ->add_option("--view", o.view,
                                       "AZIMUTH,ELEVATION[,DISTANCE]: the camera stands at that compass azimuth and "
                                       "elevation in degrees; distance in "
                                       "multiples of the one at which all just fits (190,35,1)")
                          ->group(from);
  CLI::Option* eye =
      command
          ->add_option("--eye", o.eye, "X,Y,Z in metres: x east, y north from the south-west sample, z up, exaggerated")
          ->group(from);
  command->add_option("--target", o.target, "X,Y,Z that the eye looks at (the middle)")->group(from)->needs(eye);
  CLI::Option* fov = command->add_option("--fov", o.fov_deg, "vertical angle of view in degrees, 1 to 150")
                         ->check(number_in({1, 150}))
                         ->group(from)
                         ->capture_default_str();
  command->add_flag("--top", o.top, "a map: straight down, no perspective, grid north up")
      ->group(from)
      ->excludes(view)
      ->excludes(eye)
      ->excludes(fov);
  view->excludes(eye);

  add_frame_options(*command, o.frames);
  add_depth_options(*command, o.depth);
  add_figure_options(*command, o.figure);
  add_mesh_options(*command, o.mesh);
  add_function_options(*command, o.function, o.march, o.march_settings);
  command->add_option("--march", o.march, "technique, see 'scarp marches' (max-mip; voxel-bricks; lipschitz-local)")
      ->group("Settings of marches");
  add_march_options(*command, o.march_settings);
  add_raster_options(*command, o.raster);
  add_vox_options(*command, o.vox);
  add_vox_look_options(*command, o.vox_look);
  command->callback([options, command] {
    options->given = given_options(*command);
    options->typed = typed_values(*command);
    run(*options);
  });
}

}  // namespace scarp::cli
