// SPDX-License-Identifier: MIT
// `scarp render`: an elevation model, a voxel model or a scene in, a picture out.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/numbers.h"
#include "app/cli/places.h"
#include "app/cli/render_input.h"
#include "app/cli/render_options.h"
#include "app/cli/render_run.h"
#include "scarp/base/error.h"
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
  picture.tone_curve = !options.no_tone_curve;
  if (!options.sky.empty()) picture.sky.kind = find_sky(options.sky);
  if (options.is_given("--error-tolerance")) picture.error = {options.error_tolerance, options.error_tolerance / 100};
  if (!options.steps_range.empty()) {
    const auto range = numbers_from(options.steps_range, ',', 2, 2, "--steps-range", "LOW,HIGH, for example 0,128");
    if (!(range[0] >= 0 && range[1] - range[0] >= 1))
      throw Error(
          fmt::format("--steps-range '{}': expected 0 <= LOW, and HIGH at least 1 above it", options.steps_range));
    picture.step_scale = StepScale{range[0], range[1]};
  }
  settle_look(options.look_options, options.march_settings, picture);
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
  if (picture.look == Look::comanche && !options.is_given("--fov")) options.fov_deg = kComancheFov;
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
  options.format = &picture_format_of(options.output);
  if (const auto range = depth_range_of(options.depth); range && !options.format->layers) {
    throw Error("--depth-range needs an EXR picture, of which it is a channel (name the output *.exr)");
  }
  settle_figure(options.figure, picture, *options.format);
  if (options.format->layers && picture.look != Look::shaded) {
    throw Error(
        fmt::format("--look {}: EXR pictures hold the look 'shaded', with depth, position and steps as channels "
                    "(leave --look out, or name the output *.png)",
                    options.look));
  }
  if (options.format->map && !options.top) {
    throw Error(
        fmt::format("output '{}': a {} is a map (add --top, or name it *.png)", options.output, options.format->name));
  }
  picture.alpha = options.format->map;
  return view;
}

void run(RenderOptions options, const Command& command) {
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind, options.look, march_of(options, kind)});
  const ViewSettings view = settle(options);
  keep_inputs(options.output, options.typed);
  if (!options.target.empty()) typed_place(options.target, "--target");
  if (!options.eye.empty() && typed_place(options.eye, "--eye").z.has_value() == options.eye_above.has_value()) {
    throw Error(fmt::format(
        "--eye '{}': {}", options.eye,
        options.eye_above ? "--eye-above replaces Z (give X,Y)" : "expected X,Y,Z, or X,Y with --eye-above M"));
  }
  const ThreadLimit limit(options.threads);
  render_input(kind, std::move(options), view);
}

}  // namespace

void add_render(Program& program) {
  const auto options = std::make_shared<RenderOptions>();
  Command& command = declare_render(program, *options);
  command.runs([options, &command] {
    options->given = command.given();
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
