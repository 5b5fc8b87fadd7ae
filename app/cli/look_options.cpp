// SPDX-License-Identifier: MIT
#include "app/cli/look_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "scarp/source/colour_image.h"
#include "scarp/source/ramp_file.h"

namespace scarp::cli {
namespace {

// Ways to a field of which twice are as far as its corners behind: they are farther off than the field's longer side
// and the way to it by less than half of that side, and who sees all of a field is farther away.
constexpr double kFarthestCorner = 2;

// Metres from the camera to the nearest point of a box.
double way_to(const Box& box, const Camera& camera) {
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

int pixels(double number, const std::string& text) {
  if (number != std::floor(number) || !(std::abs(number) <= 1e9)) {
    throw Error(fmt::format("--lowres '{}': expected WIDTHxHEIGHT in pixels, for example 320x240", text));
  }
  return static_cast<int>(number);
}

}  // namespace

void add_look_options(CLI::App& command, LookOptions& o) {
  std::string group = "Ground";
  command
      .add_option("--ramp", o.ramp,
                  fmt::format("colours by height: {}, a .cpt file, or a .png of 1 x N colours (hypsometric; viridis "
                              "for steps)",
                              fmt::join(ramp_names(), ", ")))
      ->group(group);
  command.add_option("--ground", o.ground_colours, "ramp, or natural: rock, grass and snow by slope and aspect (ramp)")
      ->group(group);
  command.add_option("--snow-line", o.snow_line, "metres above which natural ground has snow (0.7 of the relief)")
      ->check(number_in(kAnyNumber))
      ->group(group);
  command.add_option("--detail", o.ground.detail, "strength of patches of noise on the ground, 0 to 1")
      ->check(number_in({0, 1}))
      ->group(group)
      ->capture_default_str();
  command.add_option("--detail-size", o.ground.detail_size, "of the largest patches in metres (16 cells)")
      ->check(number_in(kZeroOrMore))
      ->group(group);
  command.add_option("--contours", o.ground.contours, "metres from contour line to contour line; 0: none")
      ->check(number_in(kZeroOrMore))
      ->group(group)
      ->capture_default_str();
  command.add_option("--overlay", o.overlay, "a picture that lies on the ground, georeferenced where the terrain is")
      ->group(group);

  group = "Water";
  command.add_option("--water", o.water, "level in metres: water over all ground below it (looks shaded and comanche)")
      ->check(number_in(kAnyNumber))
      ->group(group);
  command.add_option("--water-colour", o.water_colour, "RRGGBB: what deep water gives back (1a4055)")->group(group);
  command
      .add_option("--turbidity", o.water_settings.turbidity, "light that water loses besides pure water's, per metre")
      ->check(number_in(kZeroOrMore))
      ->group(group)
      ->capture_default_str();
  command.add_option("--waves", o.water_settings.waves, "mean slope of the waves, 0 to 0.5; 0: a mirror")
      ->check(number_in({0, 0.5}))
      ->group(group)
      ->capture_default_str();
  command.add_option("--wavelength", o.water_settings.wavelength, "of the longest wave in metres (two cells)")
      ->check(number_in(kZeroOrMore))
      ->group(group);
  command.add_flag("--no-reflection", o.no_reflection, "water mirrors the sky alone")->group(group);
  command.add_flag("--no-refraction", o.no_refraction, "water has one colour, whatever its depth")->group(group);

  group = "Fog";
  command
      .add_option("--fog", o.fog,
                  "none, distance, height, or iterations (of fixed-step, as the first ray casters had it)")
      ->group(group);
  command
      .add_option("--visibility", o.visibility,
                  "metres at which 2 of 100 parts of a contrast are left (the reach, or the field's longer side; more "
                  "from afar)")
      ->check(number_in(kAboveZero))
      ->group(group);
  command.add_option("--fog-base", o.fog_base, "height in metres where that holds (the water, or the lowest ground)")
      ->check(number_in(kAnyNumber))
      ->group(group);
  command.add_option("--fog-falloff", o.fog_falloff, "metres of height by which it thins out e times (relief / 4)")
      ->check(number_in(kAboveZero))
      ->group(group);
  command.add_option("--sun-tint", o.fog_settings.sun_tint, "how warm fog is towards the sun, 0 to 1")
      ->check(number_in({0, 1}))
      ->group(group)
      ->capture_default_str();

  group = "Look comanche";
  command.add_option("--lowres", o.lowres, "WIDTHxHEIGHT of the large pixels (320x240)")->group(group);
  command.add_option("--pixel-size", o.comanche.scale, "pixels of the image along the side of a large one, 1 to 64")
      ->group(group)
      ->capture_default_str();
  command.add_option("--steps", o.comanche.steps, "of fixed-step over the reach, 1 to 65536")
      ->group(group)
      ->capture_default_str();
  command.add_flag("--shells", o.comanche.shells, "fixed-step on spheres round the eye instead of planes")
      ->group(group);
  command.add_flag("--step-by-view", o.comanche.step_by_view, "fixed-step with longer steps looking down")
      ->group(group);
  command.add_flag("--iterations", o.comanche.iterations, "a picture of the steps, black (none) to white (all)")
      ->group(group);
  command
      .add_option(
          "--reach", o.reach,
          "metres that the camera sees: needed by fields that wrap round (their longer side; more from outside)")
      ->check(number_in(kAboveZero))
      ->group(group);
}

void settle_look(const LookOptions& o, const std::string& size, std::string_view march,
                 const MarchSettings& march_settings, PictureSettings& picture) {
  const bool comanche = picture.look == Look::comanche;
  picture.comanche = o.comanche;
  picture.comanche.interpolate = march_settings.fixed_step.interpolate;
  picture.fog = o.fog_settings;
  picture.ground = o.ground;
  if (o.ground_colours == "natural") {
    picture.ground.natural = true;
  } else if (!o.ground_colours.empty() && o.ground_colours != "ramp") {
    throw Error(fmt::format("--ground '{}': expected ramp or natural", o.ground_colours));
  }
  const std::string extension = extension_of(o.ramp);
  if (extension == ".cpt") {
    picture.ramp_stops = std::make_shared<RampStops>(read_cpt(o.ramp));
  } else if (extension == ".png") {
    const ColourImage row = read_colour_row(o.ramp);
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < row.rgba.size(); ++i) {
      if (i % 4 != 3) rgb.push_back(row.rgba[i]);
    }
    picture.ramp_stops = std::make_shared<RampStops>(ramp_of_row(rgb));
  } else {
    picture.ramp = o.ramp;
  }
  if (comanche) {
    if (!size.empty()) {
      throw Error(
          fmt::format("--size '{}': the look comanche has --lowres WIDTHxHEIGHT and --pixel-size N instead", size));
    }
    picture.width = 320;
    picture.height = 240;
    picture.aa = 1;
    picture.shadows = false;
  } else if (!o.lowres.empty()) {
    throw Error(fmt::format("--lowres '{}': goes with --look comanche; other looks have --size", o.lowres));
  }
  if (!o.lowres.empty()) {
    const auto numbers = numbers_from(o.lowres, 'x', 2, 2, "--lowres", "WIDTHxHEIGHT in pixels, for example 320x240");
    picture.width = pixels(numbers[0], o.lowres);
    picture.height = pixels(numbers[1], o.lowres);
  }
  if (!o.fog.empty()) picture.fog.kind = find_fog(o.fog);
  const bool stepped = comanche && march == "fixed-step";
  if ((o.comanche.shells || o.comanche.step_by_view) && !stepped) {
    throw Error("--shells, --step-by-view: each goes with --march fixed-step in the look comanche; leave them out");
  }
  if (stepped && march_settings.sampling.refinement != Refinement::none) {
    throw Error("--refine: the look comanche has --fixed-step-interpolate instead");
  }
  if (picture.fog.kind == FogKind::iterations && !stepped) {
    throw Error("--fog iterations: goes with --look comanche --march fixed-step; let it be distance or height");
  }
  if (o.visibility) picture.fog.visibility = *o.visibility;
  if (o.fog_falloff) picture.fog.falloff = *o.fog_falloff;
  if (!o.water) return;
  picture.water = o.water_settings;
  picture.water->level = *o.water;
  picture.water->reflection = !o.no_reflection;
  picture.water->refraction = !o.no_refraction;
  if (!o.water_colour.empty()) picture.water->srgb = colour_from(o.water_colour, "--water-colour");
}

std::vector<std::string> read_look_files(const LookOptions& o, const Raster& raster, const FieldOptions& field,
                                         PictureSettings& picture) {
  if (o.overlay.empty()) return {};
  if (field.mirror) throw Error("--overlay: goes with a terrain as it is; leave --wrap mirror out");
  ColourImage image = read_overlay(o.overlay, raster.georeference, raster.cols, raster.rows);
  picture.ground.drape = std::make_shared<Drape>(Drape{image.width, image.height, std::move(image.rgba)});
  return std::move(image.files);
}

void see_from_afar(const LookOptions& o, const Box& box, const Camera& camera, PictureSettings& picture) {
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

double reach_of(const LookOptions& o, double across, const Scene& scene, const Box& box, const Camera& camera) {
  if (o.reach) return *o.reach;
  if (!scene.wraps()) return std::numeric_limits<double>::infinity();
  return across + kFarthestCorner * way_to(box, camera);
}

}  // namespace scarp::cli
