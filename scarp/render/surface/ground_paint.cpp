// SPDX-License-Identifier: MIT
#include "scarp/render/surface/ground_paint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scarp/base/setting.h"
#include "scarp/field/noise.h"

namespace scarp::glsl {
namespace {

using ScarpPaintPlace = dvec2;

double scarp_paint_noise(const dvec2& place, int set, int octave, double size);

}  // namespace
}  // namespace scarp::glsl

#include "scarp/render/surface/ground_paint.glsl.h"

namespace scarp::glsl {
namespace {

double scarp_paint_noise(const dvec2& place, int /*set*/, int octave, double size) {
  const dvec2 grain = scarp_patch_grain(octave);
  const double along = (grain.x * place.x + grain.y * place.y) / (2 * size),
               across = (grain.x * place.y - grain.y * place.x) / size;
  return noise(NoiseKind::perlin, static_cast<std::uint32_t>(octave + 1), along, across);
}

}  // namespace
}  // namespace scarp::glsl

namespace scarp {
namespace {

// Minimum relief, so that relative heights on level ground are 0 and not 0 / 0.
constexpr double kLeastRelief = 1e-300;

}  // namespace

void validate(const GroundPaintSettings& settings) {
  require_setting("ground", std::isfinite(settings.snow_share), "the snow line", settings.snow_share,
                  "a finite share of the relief");
  require_setting("ground", settings.detail >= 0 && settings.detail <= 1, "the detail", settings.detail, "0 to 1");
  require_setting("ground", std::isfinite(settings.detail_size) && settings.detail_size >= 0, "the detail's size",
                  settings.detail_size, "0 or more metres");
  require_setting("ground", std::isfinite(settings.contours) && settings.contours >= 0, "the distance of contour lines",
                  settings.contours, "0 or more metres");
}

int lines_per_heavy_contour() { return glsl::kScarpHeavyContour; }

GroundPaint::GroundPaint(const GroundPaintSettings& settings, const PaintExtent& extent, Ramp ramp, const dvec3& to_sun)
    : settings_(settings),
      extent_(extent),
      ramp_(std::move(ramp)),
      away_from_sun_(-to_sun.x, -to_sun.y),
      relief_(std::max(extent.high - extent.low, kLeastRelief)),
      detail_size_(settings.detail_size > 0 ? settings.detail_size : 16 * extent.cell) {}

vec3 GroundPaint::draped(const dvec3& position, vec3 below) const {
  const Drape& image = *settings_.drape;
  dvec2 at((position.x - extent_.origin.x) / extent_.size.x, 1 - (position.y - extent_.origin.y) / extent_.size.y);
  if (extent_.repeats) at -= floor(at);
  at = glsl::scarp_drape_place(at, image.first, image.last, image.mirrored);
  if (at.x < 0 || at.y < 0 || at.x > 1 || at.y > 1) return below;
  const double col = std::clamp(at.x * image.width - 0.5, 0.0, image.width - 1.0),
               row = std::clamp(at.y * image.height - 0.5, 0.0, image.height - 1.0);
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

double GroundPaint::patches(const dvec3& position, int set, double footprint) const {
  return glsl::scarp_patches(dvec2(position), set, detail_size_, footprint);
}

double GroundPaint::detail(const dvec3& position, double footprint) const {
  if (settings_.detail_texture) return settings_.detail_texture->at(dvec2(position), detail_size_, footprint);
  return patches(position, glsl::kScarpDetail, footprint);
}

vec3 GroundPaint::ground(const dvec3& position, double height, const dvec3& normal, double footprint) const {
  if (!settings_.natural) return ramp_(height);
  return glsl::scarp_natural((height - extent_.low) / relief_, normal, away_from_sun_, settings_.snow_share,
                             patches(position, glsl::kScarpBlur, footprint),
                             patches(position, glsl::kScarpRough, footprint));
}

vec3 GroundPaint::over(vec3 colour, const dvec3& position, double height, const dvec3& normal, double footprint) const {
  if (settings_.drape) colour = draped(position, colour);
  if (settings_.detail > 0) {
    const double factor = 1 + settings_.detail * detail(position, footprint);
    colour *= static_cast<float>(std::max(0.0, factor));
  }
  if (settings_.contours > 0) colour = glsl::scarp_with_contours(colour, height, normal, footprint, contour_interval());
  return colour;
}

GroundPaint::Patch GroundPaint::patch(int set, int octave) const {
  double size = glsl::scarp_patch_size(set, detail_size_);
  for (int i = 0; i < octave; ++i) size = glsl::scarp_smaller_patch(size);
  const dvec2 grain = glsl::scarp_patch_grain(octave);
  return {grain / (2 * size), dvec2(-grain.y, grain.x) / size};
}

double GroundPaint::contour_interval() const { return settings_.contours * extent_.exaggeration; }
double GroundPaint::heavy_contour_interval() const { return glsl::kScarpHeavyContour * contour_interval(); }

}  // namespace scarp
