// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vox_material.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace scarp {
namespace {

constexpr float kMostPower = 10;

bool has_type(const VoxMaterial& material, std::string_view type) {
  return find_attribute(material.attributes, "_type") == type;
}

// Returns `fallback` if there is no such attribute, or if it is not a number.
float number(const VoxMaterial& material, std::string_view name, float fallback) {
  const auto text = find_attribute(material.attributes, name);
  if (!text) return fallback;
  float value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  return error == std::errc{} && std::isfinite(value) ? value : fallback;
}

float share(const VoxMaterial& material, std::string_view name, float fallback) {
  return std::clamp(number(material, name, fallback), 0.0f, 1.0f);
}

}  // namespace

float vox_emission(const VoxMaterial& material) {
  if (!has_type(material, "_emit")) return 0;
  const float emitted = share(material, "_emit", share(material, "_weight", 0));
  return emitted * std::exp2(std::clamp(number(material, "_flux", 0), 0.0f, kMostPower));
}

float vox_mirror(const VoxMaterial& material) {
  if (!has_type(material, "_metal") && !has_type(material, "_blend")) return 0;
  const float metal = share(material, "_metal", has_type(material, "_metal") ? share(material, "_weight", 0) : 0);
  return metal * (1 - share(material, "_rough", 0));
}

bool is_vox_glass(const VoxMaterial& material) {
  if (has_type(material, "_glass")) return true;
  return has_type(material, "_blend") && (number(material, "_alpha", 0) > 0 || number(material, "_trans", 0) > 0);
}

}  // namespace scarp
