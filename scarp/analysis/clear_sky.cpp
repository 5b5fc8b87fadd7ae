// SPDX-License-Identifier: MIT
#include "scarp/analysis/clear_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scarp {
namespace {

constexpr double kSolarConstant = 1367;  // W/m^2

// Outside the atmosphere: the Earth's distance changes over the year.
double extraterrestrial(double day_of_year) {
  const double angle = 2 * std::numbers::pi * day_of_year / 365.25;
  return kSolarConstant * (1 + 0.03344 * std::cos(angle - 0.048869));
}

// Relative to the vertical path down to the sea.
double air_mass(double altitude, double height) {
  const double h = altitude;
  const double refracted = h + 0.061359 * (0.1594 + h * (1.123 + h * 0.065656)) / (1 + h * (28.9344 + h * 277.3971));
  const double pressure = std::exp(-height / 8434.5);
  return pressure / (std::sin(refracted) + 0.50572 * std::pow(refracted * 180 / std::numbers::pi + 6.07995, -1.6364));
}

double rayleigh_thickness(double mass) {
  if (mass > 20) return 1 / (10.4 + 0.718 * mass);
  return 1 / (6.6296 + mass * (1.7513 + mass * (-0.1202 + mass * (0.0065 - mass * 0.00013))));
}

double diffuse_share(double altitude, double linke) {
  const double at_zenith = -0.015843 + linke * (0.030543 + linke * 0.0003797);
  const double first = 0.26463 + linke * (-0.061581 + linke * 0.0031408);
  const double a1 = first * at_zenith < 0.0022 ? 0.0022 / at_zenith : first;
  const double a2 = 2.0402 + linke * (0.018945 - linke * 0.011161);
  const double a3 = -1.3025 + linke * (0.039231 + linke * 0.0085079);
  const double sine = std::sin(altitude);
  return at_zenith * std::max(a1 + sine * (a2 + sine * a3), 0.0);
}

}  // namespace

ClearSky clear_sky(double altitude, double height, double day_of_year, double linke) {
  if (!(altitude > 0)) return {};
  const double outside = extraterrestrial(day_of_year), mass = air_mass(altitude, height);
  return {outside * std::exp(-0.8662 * linke * mass * rayleigh_thickness(mass)),
          outside * diffuse_share(altitude, linke)};
}

ClearSky clear_sky(double altitude, double height, double day_of_year, double linke,
                   std::optional<double> transmittance) {
  if (!transmittance) return clear_sky(altitude, height, day_of_year, linke);
  if (!(altitude > 0)) return {};
  const double outside = extraterrestrial(day_of_year);
  const double at_sea = std::pow(*transmittance, air_mass(altitude, 0));
  return {outside * std::pow(*transmittance, air_mass(altitude, height)),
          outside * std::sin(altitude) * std::max(0.0, 0.2710 - 0.2939 * at_sea)};
}

}  // namespace scarp
