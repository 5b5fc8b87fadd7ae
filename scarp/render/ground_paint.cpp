// SPDX-License-Identifier: MIT
#include "scarp/render/ground_paint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/field/noise.h"

namespace scarp {
namespace {

// sRGB.
constexpr vec3 kMeadow(0.36f, 0.43f, 0.22f), kForest(0.20f, 0.30f, 0.16f), kDry(0.60f, 0.55f, 0.36f);
constexpr vec3 kRock(0.47f, 0.43f, 0.40f), kScree(0.60f, 0.56f, 0.51f), kSnow(0.93f, 0.95f, 0.98f);
// Sines of slopes between which grass gives way to rock, and cosines below which snow slides off.
constexpr double kGrassHolds = 0.45, kRockBegins = 0.68;
constexpr double kSnowSlides = 0.55, kSnowHolds = 0.72;
// How much lower snow lies on the shadowed side, and how wide the borders are, in shares of the relief.
constexpr double kAspect = 0.10, kBorder = 0.05;

constexpr double kContourWidth = 1.1, kHeavyWidth = 2.0;  // pixels
constexpr vec3 kContour(0.24f, 0.16f, 0.10f);

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("ground: {} is {}; it must be {}", what, value, range));
}

double smoothstep(double from, double to, double x) {
  const double s = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

vec3 mix(vec3 from, vec3 to, double share) {
  const auto f = static_cast<float>(share);
  return from * (1 - f) + to * f;
}

}  // namespace

void validate(const GroundPaintSettings& settings) {
  require(std::isfinite(settings.snow_share), "the snow line", settings.snow_share, "a finite share of the relief");
  require(settings.detail >= 0 && settings.detail <= 1, "the detail", settings.detail, "0 to 1");
  require(std::isfinite(settings.detail_size) && settings.detail_size >= 0, "the detail's size", settings.detail_size,
          "0 or more metres");
  require(std::isfinite(settings.contours) && settings.contours >= 0, "the distance of contour lines",
          settings.contours, "0 or more metres");
}

GroundPaint::GroundPaint(const GroundPaintSettings& settings, const HeightField& field, Ramp ramp, const dvec3& to_sun)
    : settings_(settings),
      field_(field),
      ramp_(std::move(ramp)),
      away_from_sun_(-to_sun.x, -to_sun.y),
      low_(field.min_height()),
      relief_(std::max(field.max_height() - low_, 1e-300)),
      detail_size_(settings.detail_size > 0 ? settings.detail_size
                                            : 16 * std::min(field.settings().cell_x, field.settings().cell_y)) {}

double GroundPaint::patches(const dvec3& position, double size, double footprint, int octaves) const {
  double sum = 0, weight = 1;
  for (int i = 0; i < octaves; ++i, size /= 2.17, weight *= 0.62) {
    const double seen = std::clamp(size / (2 * footprint) - 1, 0.0, 1.0);
    if (seen == 0) break;
    // Stretched along alternating directions, so that no two octaves have one grain.
    const double c = i % 2 == 0 ? 0.8 : 0.6, s = i % 2 == 0 ? 0.6 : -0.8;
    const double along = (c * position.x + s * position.y) / (2 * size),
                 across = (c * position.y - s * position.x) / size;
    sum += weight * seen * noise(NoiseKind::perlin, static_cast<std::uint32_t>(i + 1), along, across);
  }
  return sum;
}

vec3 GroundPaint::natural(const dvec3& position, double height, const dvec3& normal, double footprint) const {
  const double share = (height - low_) / relief_, blur = patches(position, 3 * detail_size_, footprint, 3);
  const double steep = std::sqrt(std::max(0.0, 1 - normal.z * normal.z));
  const double rough = patches(position, 0.7 * detail_size_, footprint, 2);
  vec3 colour = mix(kForest, kMeadow, smoothstep(0.08, 0.35, share + 0.10 * blur));
  colour = mix(colour, kDry, smoothstep(0.30, 0.62, share + 0.16 * blur));
  const vec3 rock = mix(kRock, kScree, smoothstep(-0.4, 0.6, rough));
  colour = mix(colour, rock, smoothstep(kGrassHolds, kRockBegins, steep + 0.10 * blur + 0.35 * (share - 0.5)));
  const double line = settings_.snow_share - kAspect * dot(dvec2(normal), away_from_sun_);
  const double snow = smoothstep(line - kBorder, line + kBorder, share + 0.07 * blur) *
                      smoothstep(kSnowSlides, kSnowHolds, normal.z + 0.06 * rough);
  return linear_from_srgb(mix(colour, kSnow, snow));
}

vec3 GroundPaint::draped(const dvec3& position, vec3 below) const {
  const Drape& image = *settings_.drape;
  double x = position.x / field_.width(), y = 1 - position.y / field_.depth();
  if (field_.wraps()) {
    x -= std::floor(x);
    y -= std::floor(y);
  }
  const double col = std::clamp(x * image.width - 0.5, 0.0, image.width - 1.0),
               row = std::clamp(y * image.height - 0.5, 0.0, image.height - 1.0);
  const int c0 = static_cast<int>(col), r0 = static_cast<int>(row);
  vec3 sum(0.0f);
  float opacity = 0;
  for (int i = 0; i < 4; ++i) {
    const int c = std::min(c0 + i % 2, image.width - 1), r = std::min(r0 + i / 2, image.height - 1);
    const std::uint8_t* p = image.rgba.data() + 4 * (std::int64_t{r} * image.width + c);
    const auto weight = static_cast<float>((i % 2 ? col - c0 : 1 - (col - c0)) * (i / 2 ? row - r0 : 1 - (row - r0))) *
                        static_cast<float>(p[3]) / 255.0f;
    sum += weight * linear_from_srgb(vec3(p[0], p[1], p[2]) / 255.0f);
    opacity += weight;
  }
  return sum + (1 - opacity) * below;
}

vec3 GroundPaint::with_contours(vec3 colour, double height, const dvec3& normal, double footprint) const {
  const double interval = settings_.contours * field_.settings().exaggeration;
  const double slope = std::sqrt(std::max(0.0, 1 - normal.z * normal.z)) / std::max(normal.z, 1e-9);
  const double per_pixel = std::max(slope * footprint, 1e-12);  // metres of height
  const double line = std::round(height / interval);
  const double pixels = std::abs(height - line * interval) / per_pixel;
  const bool heavy = std::fmod(std::abs(line), 5) == 0;
  const double width = heavy ? kHeavyWidth : kContourWidth;
  // Of all lines when 8 pixels apart; none at 3 but for the heavy ones, which are five times as far apart.
  const double apart = interval * (heavy ? 5 : 1) / per_pixel;
  const double ink = std::clamp(width / 2 + 0.5 - pixels, 0.0, 1.0) * smoothstep(3, 8, apart) * (heavy ? 0.85 : 0.6);
  return mix(colour, linear_from_srgb(kContour), ink);
}

vec3 GroundPaint::operator()(const dvec3& position, double height, const dvec3& normal, double footprint) const {
  vec3 colour = settings_.natural ? natural(position, height, normal, footprint) : ramp_(height);
  if (settings_.drape) colour = draped(position, colour);
  if (settings_.detail > 0) {
    colour *= static_cast<float>(std::max(0.0, 1 + settings_.detail * patches(position, detail_size_, footprint, 4)));
  }
  if (settings_.contours > 0) colour = with_contours(colour, height, normal, footprint);
  return colour;
}

}  // namespace scarp
