// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky_fit.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <vector>

namespace scarp {
namespace {

constexpr std::size_t kLayers = 5, kTerms = 4 * kLayers;
// Added to the diagonal of the normal equations, relative to it: below a sun at the zenith, terms coincide. From 1e-10
// to 1e-5, errors of the fit change by less than 2 %.
constexpr double kRidge = 1e-7;

using Terms = std::array<double, kTerms>;

// As scarp_scattered(), which sums the coefficients times these.
Terms terms_of(const dvec3& direction, const dvec3& to_sun) {
  const double cosine = dot(direction, to_sun), forward = glsl::scarp_forward(cosine);
  Terms terms{};
  for (std::size_t i = 0; i < kLayers; ++i) {
    const double layer =
        i == 0 ? 1 : glsl::scarp_sky_layer(direction.z, glsl::kScarpSkyLayers[static_cast<int>(i) - 1]);
    const double factors[4] = {1, cosine, cosine * cosine, forward};
    for (std::size_t j = 0; j < 4; ++j) terms[4 * i + j] = layer * factors[j];
  }
  return terms;
}

// Half the sky, which is symmetric: denser at the horizon, and rings around the sun.
std::vector<dvec3> directions_around(const dvec3& to_sun) {
  constexpr int kUp = 12, kHalfAround = 13, kOfRing = 8;
  std::vector<dvec3> directions;
  for (int i = 0; i < kUp; ++i) {
    const double share = static_cast<double>(i) / (kUp - 1), up = share * share, level = std::sqrt(1 - up * up);
    for (int j = 0; j < kHalfAround; ++j) {
      const double turn = std::numbers::pi * j / (kHalfAround - 1);
      directions.emplace_back(level * std::cos(turn), level * std::sin(turn), up);
    }
  }
  const dvec3 above(-to_sun.z, 0, to_sun.x), beside(0, 1, 0);
  for (const double degrees : {1.0, 3.0, 6.0, 12.0, 20.0}) {
    for (int j = 0; j < kOfRing; ++j) {
      const double off = glm::radians(degrees), turn = std::numbers::pi * (j + 0.5) / kOfRing;
      const dvec3 direction =
          std::cos(off) * to_sun + std::sin(off) * (std::cos(turn) * above + std::sin(turn) * beside);
      if (direction.z > 0) directions.push_back(direction);
    }
  }
  return directions;
}

// Solves the symmetric equations by elimination.
std::array<dvec3, kTerms> solve(std::array<Terms, kTerms>& matrix, std::array<dvec3, kTerms> right) {
  for (std::size_t i = 0; i < kTerms; ++i) matrix[i][i] *= 1 + kRidge;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = i + 1; j < kTerms; ++j) {
      const double factor = matrix[j][i] / matrix[i][i];
      for (std::size_t k = i; k < kTerms; ++k) matrix[j][k] -= factor * matrix[i][k];
      right[j] -= factor * right[i];
    }
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t j = i + 1; j < kTerms; ++j) right[i] -= matrix[i][j] * right[j];
    right[i] /= matrix[i][i];
  }
  return right;
}

}  // namespace

void fit_sky(const Atmosphere& atmosphere, glsl::ScarpSky& sky) {
  std::array<Terms, kTerms> matrix{};
  std::array<dvec3, kTerms> right;
  right.fill(dvec3(0.0));
  for (const dvec3& direction : directions_around(atmosphere.to_sun())) {
    const dvec3 radiance = atmosphere.radiance(direction);
    // Luminance of the primaries of sRGB, IEC 61966-2-1.
    const double brightness = dot(radiance, dvec3(0.2126, 0.7152, 0.0722)), weight = 1 / (brightness * brightness);
    const Terms terms = terms_of(direction, atmosphere.to_sun());
    for (std::size_t i = 0; i < kTerms; ++i) {
      right[i] += weight * terms[i] * radiance;
      for (std::size_t j = 0; j < kTerms; ++j) matrix[i][j] += weight * terms[i] * terms[j];
    }
  }
  const std::array<dvec3, kTerms> found = solve(matrix, right);
  glsl::ScarpSkyPart* const parts[kLayers] = {&sky.all, &sky.first, &sky.second, &sky.third, &sky.fourth};
  for (std::size_t i = 0; i < kLayers; ++i) {
    *parts[i] = {vec3(found[4 * i]), vec3(found[4 * i + 1]), vec3(found[4 * i + 2]), vec3(found[4 * i + 3])};
  }
}

}  // namespace scarp
