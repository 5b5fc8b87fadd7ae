// SPDX-License-Identifier: MIT
#include "scarp/render/look/relief_look.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scarp/render/film/middles.h"

namespace scarp {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// The gradient at the sample nearest to a position.
std::optional<dvec2> gradient_at(const HeightField& field, double x, double y) {
  const double col = std::floor(x / field.settings().cell_x + 0.5),
               row = field.rows() - 1 - std::ceil(y / field.settings().cell_y - 0.5);
  if (!(col >= 0 && row >= 0 && col < field.cols() && row < field.rows())) return std::nullopt;
  return horn_gradient(field, static_cast<int>(col), static_cast<int>(row));
}

// That of a surface with a normal; walls are nearly infinitely steep.
dvec2 gradient_of(const dvec3& normal) {
  constexpr double kLeast = 1e-9;
  return dvec2(-normal.x, -normal.y) / std::max(normal.z, kLeast);
}

float number_of(Look look, const dvec2& gradient) {
  if (look == Look::slope) return slope_of(gradient);
  if (look == Look::aspect) return aspect_of(gradient).value_or(std::numeric_limits<float>::quiet_NaN());
  return multidirectional_of(gradient);
}

}  // namespace

std::optional<dvec2> horn_gradient(const HeightField& field, int col, int row) {
  if (col < 1 || row < 1 || col > field.cols() - 2 || row > field.rows() - 2) return std::nullopt;
  double heights[3][3];
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      const auto cell = field.cell_heights({col + x - 1, row + y - 1});
      if (!cell) return std::nullopt;
      heights[y][x] = cell->h00, heights[y][x + 1] = cell->h10;
      heights[y + 1][x] = cell->h01, heights[y + 1][x + 1] = cell->h11;
    }
  }
  for (auto& line : heights)
    for (double& height : line) height = field.height_from_sample(height);
  const auto sum = [](double a, double b, double c) { return a + 2 * b + c; };
  const double east = sum(heights[0][2], heights[1][2], heights[2][2]),
               west = sum(heights[0][0], heights[1][0], heights[2][0]),
               north = sum(heights[0][0], heights[0][1], heights[0][2]),
               south = sum(heights[2][0], heights[2][1], heights[2][2]);
  constexpr double kWeights = 8;
  const HeightFieldSettings& cell = field.settings();
  return dvec2((east - west) / (kWeights * cell.cell_x), (north - south) / (kWeights * cell.cell_y));
}

float slope_of(const dvec2& gradient) { return static_cast<float>(kDegrees * std::atan(length(gradient))); }

std::optional<float> aspect_of(const dvec2& gradient) {
  if (gradient == dvec2(0.0)) return std::nullopt;
  const double azimuth = kDegrees * std::atan2(-gradient.x, -gradient.y);
  const auto degrees = static_cast<float>(azimuth < 0 ? azimuth + 360 : azimuth);
  return degrees >= 360 ? 0 : degrees;
}

float multidirectional_of(const dvec2& gradient) {
  constexpr double kGreys = 254, kHalf = std::numbers::sqrt2 / 2;  // sine and cosine of 45 degrees
  const double x = gradient.x, y = gradient.y, square = x * x + y * y;
  if (square == 0) return static_cast<float>(1 + kGreys * kHalf);
  // Light from (e, n): the cosine of its angle to the normal, without the length of the normal.
  const auto lit = [&](double e, double n) { return std::max(0.0, kHalf - kHalf * (e * x + n * y)); };
  // The cosine squared of the angle between the light and the gradient.
  const auto weight = [&](double e, double n) { return (e * x + n * y) * (e * x + n * y) / square; };
  double sum = 0;
  for (const dvec2& light : {dvec2(-kHalf, -kHalf), dvec2(-1, 0), dvec2(-kHalf, kHalf), dvec2(0, 1)})
    sum += weight(light.x, light.y) * lit(light.x, light.y);
  // The weights add up to two.
  return static_cast<float>(1 + kGreys * sum / 2 / std::sqrt(1 + square));
}

std::vector<float> relief_numbers(const Scene& scene, const Camera& camera, ImageSize size, Look look,
                                  const Progress& progress) {
  std::vector<float> numbers(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height),
                             std::numeric_limits<float>::quiet_NaN());
  const dvec3 down = camera.forward();
  // Rays through the outermost samples could miss the border by rounding.
  const HeightField* map = down.x == 0 && down.y == 0 ? scene.only_heights() : nullptr;
  TraceMiddles untraced;
  if (map && !map->wraps()) untraced = [](RayRound& round) { round.hits.assign(round.rays.size(), Hit{}); };
  look_through_middles(
      scene, camera, size, false, progress,
      [&](std::size_t i, const Ray& ray, const Hit& hit, std::uint32_t) {
        std::optional<dvec2> gradient;
        if (untraced) {
          gradient = gradient_at(*map, ray.origin.x, ray.origin.y);
        } else if (!hit || scene.field_of(hit.object).is_backdrop()) {
          return;
        } else if (scene.terrain() && !scene.terrain()->wraps() && hit.object == scene.terrain_object()) {
          const dvec3 at = ray.at(hit.t);
          gradient = gradient_at(*scene.terrain(), at.x, at.y);
        } else {
          gradient = gradient_of(scene.surface(ray, hit).shading_normal);
        }
        if (gradient) numbers[i] = number_of(look, *gradient);
      },
      untraced);
  return numbers;
}

}  // namespace scarp
