// SPDX-License-Identifier: MIT
#include "scarp/render/light/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/render/light/sky.glsl.h"

namespace scarp {
namespace {

constexpr double kGround = 6.36e6, kTop = 6.46e6;         // radii in metres
constexpr double kAirScale = 8000, kAerosolScale = 1200;  // heights in metres
constexpr double kOzoneLow = 10e3, kOzoneHigh = 40e3;     // likewise
constexpr double kObserver = 1000;                        // metres; seen from the sea itself, aerosols hide the horizon
constexpr double kOff = 1;                                // metres off the ground, which rays must not touch
constexpr double kScattered = 0.97;                       // share of the extinction by aerosols
constexpr double kAlbedo = 0.3;                           // of the ground
constexpr double kWavelength[3] = {0.68, 0.55, 0.44};     // micrometres
constexpr double kOzoneThickness = 0.0035;                // metres
// Preetham et al., table 2; red is the mean over the red primary of sRGB, because 680 nm misses most of the absorption.
constexpr double kOzonePerMetre[3] = {10.0, 8.5, 0.4};
// Knots of the light that is scattered more than once.
constexpr std::array<double, 6> kKnots = {0, 1500, 5000, 12000, 25000, 50000};  // metres
constexpr double kSunStep = 3 * std::numbers::pi / 180;

// The column of a gas with density exp(-x), x in scale heights, relative to the vertical column from the same point.
// `radius` in scale heights, cosine >= 0.
double chapman(double radius, double cosine) {
  const double level = std::sqrt(std::numbers::pi / 2 * radius);
  return level / ((level - 1) * cosine + 1);
}

// The column from a point to space, relative to the vertical one from sea level. `up` is the column for cosines >= 0;
// a ray that points down first passes its lowest point.
template <class Up>
double column(double radius, double cosine, const Up& up) {
  if (cosine >= 0) return up(radius, cosine);
  return std::max(0.0, 2 * up(radius * std::sqrt(1 - cosine * cosine), 0) - up(radius, -cosine));
}

double column_of_gas(double radius, double cosine, double scale) {
  return column(radius, cosine,
                [scale](double r, double c) { return std::exp((kGround - r) / scale) * chapman(r / scale, c); });
}

// A thin shell, at the middle of the layer.
double column_of_ozone(double radius, double cosine) {
  return column(radius, cosine, [](double r, double c) {
    const double above = std::clamp((kGround + kOzoneHigh - r) / (kOzoneHigh - kOzoneLow), 0.0, 1.0);
    const double share = r / std::max(r, kGround + 0.5 * (kOzoneLow + kOzoneHigh));
    constexpr double kLeast = 1e-3;  // within the shell itself
    return above / std::sqrt(std::max(1 - share * share * (1 - c * c), kLeast));
  });
}

}  // namespace

struct Atmosphere::End {
  dvec3 transmittance;
  dvec3 point;
  bool ground;
};

Atmosphere::Atmosphere(double turbidity, double altitude)
    : altitude_(altitude), to_sun_(std::cos(altitude), 0, std::sin(altitude)) {
  static_assert(kKnots.size() == kHeights);
  const double angstrom = 0.04608 * turbidity - 0.04586;
  for (int i = 0; i < 3; ++i) {
    air_[i] = 0.008735 * std::pow(kWavelength[i], -4.08);
    aerosol_[i] = angstrom * std::pow(kWavelength[i], -1.3);
    ozone_[i] = kOzoneThickness * kOzonePerMetre[i];
  }
  for (std::size_t i = 0; i < kHeights; ++i) {
    for (std::size_t j = 0; j < kSuns; ++j)
      more_[i][j] = scattered_often(kGround + kKnots[i], altitude + (static_cast<int>(j) - kSuns / 2) * kSunStep);
  }
}

// Sunlight at a point, by the cosine of the sun's angle from the zenith there.
dvec3 Atmosphere::sun_at(double radius, double cosine) const {
  if (cosine < 0 && radius * std::sqrt(1 - cosine * cosine) < kGround) return dvec3(0.0);
  return exp(-(air_ * column_of_gas(radius, cosine, kAirScale) +
               aerosol_ * column_of_gas(radius, cosine, kAerosolScale) + ozone_ * column_of_ozone(radius, cosine)));
}

dvec3 Atmosphere::sunlight(double altitude) const { return sun_at(kGround + kObserver, std::sin(altitude)); }

// Calls `at` with the middle of each step, its radius, the transmittance to it, and the optical depths of scattering
// by air and by aerosols within the step. Steps grow with the distance.
template <class F>
Atmosphere::End Atmosphere::walk(const dvec3& from, const dvec3& direction, int steps, const F& at) const {
  const double along = dot(from, direction), inside = along * along - dot(from, from);
  const double to_ground = inside + kGround * kGround;
  const bool ground = along < 0 && to_ground > 0;
  const double end = -along + (ground ? -std::sqrt(to_ground) : std::sqrt(inside + kTop * kTop));
  dvec3 depth(0.0);
  double before = 0;
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps, t = end * share * share, length_of_step = t - before;
    const dvec3 point = from + direction * (0.5 * (before + t));
    before = t;
    const double radius = length(point), height = radius - kGround;
    const dvec3 air = air_ * (std::exp(-height / kAirScale) / kAirScale * length_of_step),
                aerosol = aerosol_ * (std::exp(-height / kAerosolScale) / kAerosolScale * length_of_step);
    dvec3 lost = air + aerosol;
    if (height > kOzoneLow && height < kOzoneHigh) lost += ozone_ * (length_of_step / (kOzoneHigh - kOzoneLow));
    at(point, radius, exp(-(depth + 0.5 * lost)), air, kScattered * aerosol);
    depth += lost;
  }
  return {exp(-depth), from + direction * end, ground};
}

// Radiance, the same in all directions, of the light that is scattered more than once at a point.
dvec3 Atmosphere::scattered_often(double radius, double altitude) const {
  constexpr int kUp = 8, kAround = 4, kSteps = 12;  // half the sphere: the other half is its mirror image
  const dvec3 to_sun(std::cos(altitude), 0, std::sin(altitude));
  dvec3 once(0.0), share(0.0);
  for (int i = 0; i < kUp; ++i) {
    for (int j = 0; j < kAround; ++j) {
      const double up = -1 + 2 * (i + 0.5) / kUp, level = std::sqrt(1 - up * up),
                   turn = std::numbers::pi * (j + 0.5) / kAround;
      const End end = walk({0, 0, radius + kOff}, {level * std::cos(turn), level * std::sin(turn), up}, kSteps,
                           [&](const dvec3& p, double r, const dvec3& clear, const dvec3& air, const dvec3& aerosol) {
                             const dvec3 scattered = clear * (air + aerosol);
                             once += scattered * sun_at(r, dot(p, to_sun) / r) / (4 * std::numbers::pi);
                             share += scattered;
                           });
      const double cosine = dot(end.point, to_sun) / kGround;
      if (end.ground && cosine > 0)
        once += end.transmittance * (kAlbedo / std::numbers::pi * cosine) * sun_at(kGround + kOff, cosine);
    }
  }
  constexpr double kDirections = kUp * kAround;
  return once / kDirections / (1.0 - share / kDirections);
}

// The same, interpolated between the knots.
dvec3 Atmosphere::more_at(double radius, double altitude) const {
  const double height = radius - kGround;
  std::size_t i = 0;
  while (i + 2 < kHeights && height > kKnots[i + 1]) ++i;
  const double u = std::clamp((height - kKnots[i]) / (kKnots[i + 1] - kKnots[i]), 0.0, 1.0);
  const double at = std::clamp((altitude - altitude_) / kSunStep + kSuns / 2, 0.0, kSuns - 1.0);
  const auto j = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kSuns - 2));
  const double v = at - static_cast<double>(j);
  const auto across = [&](const std::array<dvec3, kSuns>& row) { return (1 - v) * row[j] + v * row[j + 1]; };
  return (1 - u) * across(more_[i]) + u * across(more_[i + 1]);
}

dvec3 Atmosphere::radiance(const dvec3& direction) const {
  constexpr int kSteps = 40;
  const double c = dot(direction, to_sun_);
  const double by_air = 3 / (16 * std::numbers::pi) * (1 + c * c),
               by_aerosol = glsl::scarp_forward(c) / (4 * std::numbers::pi);
  dvec3 sum(0.0);
  walk({0, 0, kGround + kObserver}, direction, kSteps,
       [&](const dvec3& p, double r, const dvec3& clear, const dvec3& air, const dvec3& aerosol) {
         const double cosine = dot(p, to_sun_) / r;
         sum += clear * ((air * by_air + aerosol * by_aerosol) * sun_at(r, cosine) +
                         (air + aerosol) * more_at(r, std::asin(std::clamp(cosine, -1.0, 1.0))));
       });
  return sum;
}

}  // namespace scarp
