// SPDX-License-Identifier: MIT
#include "scarp/render/surface/surface_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include "scarp/base/error.h"

namespace scarp {
namespace {

const vec3 kEarth(0.58f, 0.52f, 0.45f);  // sRGB

// Faces of an object often coincide with borders of a checker's cubes, where rounding would decide. The cubes are
// therefore shifted by this fraction of their side.
constexpr double kInside = 1e-4;

vec3 stops_at(const HeightStops& s, double z) {
  const auto above = std::find_if(s.stops.begin(), s.stops.end(), [&](const auto& stop) { return stop.first > z; });
  if (above == s.stops.begin()) return linear_from_srgb(above->second);
  const auto& [low, colour] = *(above - 1);
  if (above == s.stops.end()) return linear_from_srgb(colour);
  const auto f = static_cast<float>((z - low) / (above->first - low));
  return glm::mix(linear_from_srgb(colour), linear_from_srgb(above->second), f);
}

bool in_second(const Checker& checker, const dvec3& place) {
  const auto cube = [&](double x) { return static_cast<std::int64_t>(std::floor(x / checker.size + kInside)); };
  return ((cube(place.x) + cube(place.y) + cube(place.z)) & 1) != 0;
}

}  // namespace

SurfaceColours::SurfaceColours(std::span<const Material> materials) : materials_(materials.begin(), materials.end()) {
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    ramps_.emplace_back();
    const auto refuse = [&](std::string_view what) { throw Error(fmt::format("material {}: {}", i, what)); };
    if (const auto* ramp = std::get_if<HeightRamp>(&materials_[i])) {
      if (!(std::isfinite(ramp->low) && std::isfinite(ramp->high) && ramp->low <= ramp->high))
        refuse("its range of heights must be finite, low before high");
      ramps_.back().emplace(ramp->ramp, ramp->low, ramp->high);
    } else if (const auto* checker = std::get_if<Checker>(&materials_[i])) {
      if (!(std::isfinite(checker->size) && checker->size > 0)) refuse("the side of its cubes must be above 0");
    } else if (const auto* blend = std::get_if<Blend>(&materials_[i])) {
      if (!(blend->from <= blend->to)) refuse("its blend must go from low to high");
      if (std::max(blend->low, blend->high) >= i) refuse("what it blends must come before it");
    } else if (const auto* stops = std::get_if<HeightStops>(&materials_[i])) {
      const auto rises = [](const auto& a, const auto& b) { return a.first < b.first; };
      if (stops->stops.empty() || !std::is_sorted(stops->stops.begin(), stops->stops.end(), rises))
        refuse("its heights must rise, and there must be one");
    }
  }
}

vec3 SurfaceColours::operator()(const SceneSurface& surface) const { return colour(surface.material, surface); }

vec3 SurfaceColours::colour(std::size_t material, const SceneSurface& surface) const {
  const auto own = [&] {
    if (!surface.colour) return linear_from_srgb(kEarth);
    const VoxelColour& c = *surface.colour;
    return linear_from_srgb(vec3(c[0], c[1], c[2]) / 255.0f);
  };
  if (material >= materials_.size()) return own();
  const Material& m = materials_[material];
  const double z = surface.position.z;
  if (const auto* plain = std::get_if<PlainColour>(&m)) return linear_from_srgb(plain->colour);
  if (std::holds_alternative<HeightRamp>(m)) return (*ramps_[material])(z);
  if (const auto* stops = std::get_if<HeightStops>(&m)) return stops_at(*stops, z);
  if (const auto* checker = std::get_if<Checker>(&m)) {
    return linear_from_srgb(in_second(*checker, surface.place) ? checker->second : checker->first);
  }
  if (const auto* blend = std::get_if<Blend>(&m)) {
    const double value =
        blend->by == Blend::By::height ? z : glm::degrees(std::acos(glm::clamp(surface.shading_normal.z, -1.0, 1.0)));
    if (value <= blend->from) return colour(blend->low, surface);
    if (value >= blend->to) return colour(blend->high, surface);
    const auto f = static_cast<float>((value - blend->from) / (blend->to - blend->from));
    return glm::mix(colour(blend->low, surface), colour(blend->high, surface), f);
  }
  return own();
}

}  // namespace scarp
