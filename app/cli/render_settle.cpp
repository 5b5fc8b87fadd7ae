// SPDX-License-Identifier: MIT
#include "app/cli/render_settle.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "app/cli/numbers.h"
#include "app/cli/places.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

int whole(double number, const RenderOptions& options) {
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    throw Error(fmt::format("--size '{}': expected WIDTHxHEIGHT in pixels, for example 1280x720", options.size));
  }
  return static_cast<int>(number);
}

}  // namespace

ViewSettings settle_picture(RenderOptions& options) {
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
  return view;
}

void require_places(const RenderOptions& options) {
  if (!options.target.empty()) typed_place(options.target, "--target");
  if (!options.eye.empty() && typed_place(options.eye, "--eye").z.has_value() == options.eye_above.has_value()) {
    throw Error(fmt::format(
        "--eye '{}': {}", options.eye,
        options.eye_above ? "--eye-above replaces Z (give X,Y)" : "expected X,Y,Z, or X,Y with --eye-above M"));
  }
}

}  // namespace scarp::cli
