// SPDX-License-Identifier: MIT
#include "scarp/render/frame/picture_request.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace scarp {
namespace {

constexpr double kFaintest = 64;   // rays over functions end where haze hides all but 1 / 64 of a colour
constexpr double kLongReach = 64;  // in extents, where there is less haze

template <class T>
void take(std::optional<T>& asked, const std::optional<T>& own) {
  if (!asked) asked = own;
}

// kFunctionMaterial: meadows, dry grass and snow by height, rock on steep slopes; water, green on steep slopes, where
// light shines through, and foam on the highest crests; or one of the ramps.
std::vector<Material> function_materials(const ReliefRange& range, const std::string& ramp, bool sea) {
  const auto at = [&](double share) { return range.low + share * (range.high - range.low); };
  if (sea && ramp.empty()) {
    return {HeightStops{{{at(0.0), {0.04f, 0.15f, 0.24f}},
                         {at(0.5), {0.07f, 0.24f, 0.34f}},
                         {at(0.85), {0.16f, 0.40f, 0.48f}},
                         {at(0.93), {0.30f, 0.54f, 0.60f}},
                         {at(1.0), {0.88f, 0.93f, 0.94f}}}},
            PlainColour{{0.12f, 0.38f, 0.40f}}, Blend{Blend::By::slope, 10, 25, 0, 1}};
  }
  std::vector<Material> materials{HeightStops{{{at(0.0), {0.40f, 0.47f, 0.30f}},
                                               {at(0.35), {0.50f, 0.53f, 0.33f}},
                                               {at(0.6), {0.62f, 0.57f, 0.42f}},
                                               {at(0.8), {0.66f, 0.62f, 0.57f}},
                                               {at(0.88), {0.93f, 0.94f, 0.96f}}}},
                                  PlainColour{{0.47f, 0.43f, 0.40f}}, Blend{Blend::By::slope, 30, 45, 0, 1}};
  if (!ramp.empty()) materials[kFunctionMaterial] = HeightRamp{ramp, range.low, range.high};
  return materials;
}

double haze_distance_of(double haze, double extent) { return haze > 0 ? -extent / std::log1p(-haze) : kUnlimited; }

// Distance in metres from the camera to the nearest point of a box.
double way_to(const WorldBox& box, const Camera& camera) {
  return length(glm::clamp(camera.eye(), box.low, box.high) - camera.eye());
}

// `asked` without the size of a scene file.
bool has_large_pixels(const PictureRequest& asked) {
  return entry_of(look_of(asked)).large_pixels || (asked.look == Look::shaded && asked.low_resolution && !asked.width);
}

ImageSize size_of(const PictureRequest& r, const PictureSubject& subject, bool large_pixels) {
  if (large_pixels) return r.low_resolution.value_or(kLowResolution);
  return {r.width.value_or(subject.size.width), r.height.value_or(subject.size.height)};
}

GroundPaintSettings ground_of(const PictureRequest& r, const PictureSubject& subject) {
  GroundPaintSettings ground;
  ground.natural = r.natural;
  const double relief = subject.heights.high - subject.heights.low;
  if (r.snow_line && relief > 0)
    ground.snow_share = (*r.snow_line * subject.exaggeration - subject.heights.low) / relief;
  ground.detail = r.detail.value_or(subject.files.detail_texture ? kTextureDetail : 0);
  ground.detail_size = r.detail_size, ground.contours = r.contours;
  ground.detail_texture = subject.files.detail_texture, ground.drape = subject.files.drape;
  return ground;
}

std::optional<WaterSettings> water_of(const PictureRequest& r) {
  if (!r.water_level) return {};
  WaterSettings water;
  water.level = *r.water_level;
  water.srgb = r.water_srgb.value_or(water.srgb);
  water.turbidity = r.water_turbidity.value_or(water.turbidity);
  water.waves = r.waves.value_or(water.waves);
  water.wavelength = r.wavelength.value_or(water.wavelength);
  water.reflection = r.reflection.value_or(water.reflection);
  water.refraction = r.refraction.value_or(water.refraction);
  return water;
}

FogSettings fog_of(const PictureRequest& r, const PictureSubject& subject, const Camera* camera) {
  constexpr double kWays = 10;  // visibility in multiples of the distance to the box
  FogSettings fog;
  fog.kind = r.fog.value_or(fog.kind);
  fog.sun_tint = r.sun_tint.value_or(fog.sun_tint);
  fog.visibility =
      r.visibility ? *r.visibility : r.reach.value_or(subject.across > 0 ? subject.across : fog.visibility);
  if (camera && !r.visibility) fog.visibility += kWays * way_to(subject.box, *camera);
  fog.base = r.fog_base      ? *r.fog_base * subject.exaggeration
             : r.water_level ? *r.water_level * subject.exaggeration
                             : subject.heights.low;
  fog.falloff = r.fog_falloff.value_or(std::max(1.0, (subject.heights.high - subject.heights.low) / 4));
  return fog;
}

void set_function(const PictureRequest& r, const PictureSubject& subject, PictureSettings& picture) {
  const double extent = *subject.function_extent;
  picture.haze_distance = haze_distance_of(picture.haze, extent);
  picture.ground_box =
      WorldBox{{-0.5 * extent, -0.5 * extent, subject.heights.low}, {0.5 * extent, 0.5 * extent, subject.heights.high}};
  // A ramp from a file and natural ground are painted by the renderer.
  if (!r.natural && !subject.files.ramp_stops)
    picture.materials = function_materials(r.ramp_range.value_or(subject.heights), r.ramp, subject.sea);
}

}  // namespace

PictureRequest merged(PictureRequest r, const PictureRequest& own) {
  take(r.width, own.width), take(r.height, own.height), take(r.aa, own.aa);
  take(r.sun_azimuth_deg, own.sun_azimuth_deg), take(r.sun_altitude_deg, own.sun_altitude_deg);
  take(r.sun_size_deg, own.sun_size_deg), take(r.shadows, own.shadows);
  take(r.sky, own.sky), take(r.sky_turbidity, own.sky_turbidity);
  if (!r.haze) take(r.haze_distance, own.haze_distance);
  take(r.haze, own.haze);
  take(r.samples, own.samples), take(r.ao_distance, own.ao_distance), take(r.seed, own.seed);
  if (r.materials.empty()) r.materials = own.materials;
  if (!r.no_water) take(r.water_level, own.water_level);
  take(r.water_srgb, own.water_srgb);
  take(r.water_turbidity, own.water_turbidity), take(r.waves, own.waves), take(r.wavelength, own.wavelength);
  take(r.reflection, own.reflection), take(r.refraction, own.refraction);
  if (!r.fog) {
    r.fog = own.fog;
    take(r.visibility, own.visibility), take(r.fog_base, own.fog_base), take(r.fog_falloff, own.fog_falloff);
    take(r.sun_tint, own.sun_tint);
  }
  return r;
}

ImageSize size_of_map(const WorldBox& box, int longer_side) {
  const dvec3 metres = box.high - box.low;
  const double pixels_per_metre = longer_side / std::max(metres.x, metres.y);
  const auto pixels = [&](double m) { return std::max(1, static_cast<int>(std::lround(m * pixels_per_metre))); };
  return {pixels(metres.x), pixels(metres.y)};
}

double function_reach(const PictureRequest& asked, double extent) {
  const double haze = haze_distance_of(asked.haze.value_or(kFunctionHaze), extent);
  return std::min(haze * std::log(kFaintest), kLongReach * extent);
}

Look look_of(const PictureRequest& asked) {
  return asked.look == Look::height && asked.low_resolution ? Look::comanche : asked.look;
}

PictureSettings resolve(const PictureRequest& asked, const PictureSubject& subject, const Camera* camera) {
  const PictureRequest r = merged(asked, subject.own);
  PictureSettings picture;
  picture.look = look_of(r), picture.level = r.level;
  const bool comanche = picture.look == Look::comanche;
  picture.large_pixels = has_large_pixels(asked);
  ImageSize size = size_of(r, subject, picture.large_pixels);
  if (subject.map && !asked.width) size = size_of_map(*subject.map, size.width);
  picture.width = size.width, picture.height = size.height;
  picture.aa = comanche ? 1 : r.aa.value_or(picture.aa);
  picture.step_scale = r.step_scale;
  if (r.error_tolerance) picture.error = {*r.error_tolerance, *r.error_tolerance / 100};
  picture.comanche = r.comanche;
  picture.comanche.heights = r.look == Look::height && comanche;
  picture.comanche.interpolate = r.interpolate.value_or(!r.comanche.shells);
  picture.alpha = subject.alpha;

  picture.materials = r.materials;
  picture.ground = ground_of(r, subject);
  picture.ramp = r.ramp, picture.ramp_stops = subject.files.ramp_stops, picture.ramp_range = r.ramp_range;

  picture.grid_north_azimuth = subject.grid_north_azimuth;
  picture.sun.azimuth_deg = r.sun_azimuth_deg.value_or(picture.sun.azimuth_deg);
  picture.sun.altitude_deg = r.sun_altitude_deg.value_or(picture.sun.altitude_deg);
  picture.sun.size_deg = r.sun_size_deg.value_or(picture.sun.size_deg);
  picture.sky.kind = r.sky.value_or(picture.sky.kind);
  picture.sky.turbidity = r.sky_turbidity.value_or(picture.sky.turbidity);
  picture.shadows = !comanche && r.shadows.value_or(picture.shadows);
  picture.unlit = r.unlit, picture.tone_curve = r.tone_curve.value_or(picture.tone_curve);
  picture.haze = r.haze.value_or(picture.haze);
  picture.haze_distance = r.haze_distance.value_or(picture.haze_distance);
  picture.fog = fog_of(r, subject, camera);
  picture.water = water_of(r);
  picture.samples = r.samples.value_or(picture.samples);
  picture.ao_distance = r.ao_distance.value_or(picture.ao_distance);
  picture.seed = r.seed.value_or(picture.seed);
  if (subject.function_extent) set_function(r, subject, picture);
  validate(picture);
  return picture;
}

}  // namespace scarp
