// SPDX-License-Identifier: MIT
#include "scarp/render/frame/contour_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "scarp/render/surface/contours.glsl.h"

namespace scarp {
namespace {

// The lattice of rays: they are 20 pixels apart in a picture of the default size.
constexpr int kAcross = 64, kDown = 36;
// Lines on a smaller fraction of the sloping ground than this are easily missed.
constexpr double kSeen = 0.01;

// The smallest of 1, 2 and 5 times a power of ten that is not below x > 0.
double rounded_up(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= x) return digit * power;
  }
  return 10 * power;
}

// The heights, in metres, that pixels cover, where the ground slopes.
std::vector<double> heights_per_pixel(const Scene& scene, const Camera& camera, const PictureSettings& settings) {
  std::vector<Ray> rays;
  for (int row = 0; row < kDown; ++row) {
    for (int col = 0; col < kAcross; ++col)
      rays.push_back(camera.ray((col + 0.5) / kAcross * settings.width, (row + 0.5) / kDown * settings.height));
  }
  std::vector<Hit> hits(rays.size());
  scene.closest_hits(rays, hits);
  std::vector<double> heights;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i] || scene.field_of(hits[i].object).is_backdrop()) continue;
    const SceneSurface surface = scene.surface(rays[i], hits[i]);
    if (surface.wall) continue;
    const double footprint = camera.footprint(rays[i], hits[i].t, surface.normal),
                 height = glsl::scarp_height_per_pixel(surface.normal, footprint);
    if (height > 0) heights.push_back(height);
  }
  return heights;
}

}  // namespace

std::optional<double> better_contours(const Scene& scene, const Camera& camera, const PictureSettings& settings) {
  std::vector<double> heights = heights_per_pixel(scene, camera, settings);
  if (heights.empty() || !(settings.ground.contours > 0)) return {};
  const double exaggeration = paint_extent(scene, settings).exaggeration,
               heavy = glsl::kScarpHeavyContour * settings.ground.contours * exaggeration;
  const auto seen = std::count_if(heights.begin(), heights.end(),
                                  [&](double height) { return heavy > glsl::kScarpTouchingContours * height; });
  if (static_cast<double>(seen) > kSeen * static_cast<double>(heights.size())) return {};
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return rounded_up(glsl::kScarpTouchingContours * *middle / exaggeration);
}

}  // namespace scarp
