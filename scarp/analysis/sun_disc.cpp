// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_disc.h"
#include "scarp/base/progress_part.h"

#include <array>
#include <cmath>

namespace scarp {
namespace {

constexpr int kDiscStrips = 16;

// Fraction of the unit disc's area that is below a height of -1 to 1.
double area_below(double y) { return 0.5 + (y * std::sqrt(1 - y * y) + std::asin(y)) / std::numbers::pi; }

std::array<SunStrip, kDiscStrips> make_strips() {
  std::array<SunStrip, kDiscStrips> strips{};
  for (int i = 0; i < kDiscStrips; ++i) {
    const double low = 2.0 * i / kDiscStrips - 1, high = 2.0 * (i + 1) / kDiscStrips - 1;
    strips[static_cast<std::size_t>(i)] = {(low + high) / 2 * kSunDiameter / 2,
                                           static_cast<float>(area_below(high) - area_below(low))};
  }
  return strips;
}

}  // namespace

std::span<const SunStrip> sun_strips() {
  static const auto strips = make_strips();
  return strips;
}

std::vector<float> lit_share(const SunGround& ground, const SunDirection& sun, const RowBand& band,
                             const Progress& progress) {
  std::vector<float> lit(static_cast<std::size_t>(ground.field().cols()) * static_cast<std::size_t>(band.rows()), 0);
  const auto strips = sun_strips();
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const SunStrip& strip = strips[i];
    const double altitude = sun.altitude + strip.rise;
    if (altitude <= 0 || altitude > std::numbers::pi / 2) continue;
    const auto codes = ground.rows({sun.azimuth, altitude}, band,
                                   progress_part(progress, static_cast<double>(i), static_cast<double>(strips.size())));
    for (std::size_t k = 0; k < lit.size(); ++k) {
      if (codes[k] == Shade::lit) lit[k] += strip.share;
      if (codes[k] == Shade::hole) lit[k] = kNoShare;
    }
  }
  return lit;
}

}  // namespace scarp
