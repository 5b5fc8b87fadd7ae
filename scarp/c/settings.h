// SPDX-License-Identifier: MIT
// Settings of height fields that several structures of the C interface have.
#pragma once

#include <cmath>
#include <cstdint>

#include "scarp/c/scene_handle.h"
#include "scarp/field/height_field.h"

namespace scarp::c {

template <class Enum>
Enum choice(std::int32_t value, Enum last, const char* name) {
  if (value < 0 || value > static_cast<std::int32_t>(last))
    throw Error(fmt::format("heights: {} is {} (must be 0..{})", name, value, static_cast<std::int32_t>(last)));
  return static_cast<Enum>(value);
}

inline bool flag(std::int32_t value, const char* name) {
  if (value != 0 && value != 1) throw Error(fmt::format("heights: {} is {} (must be 0 or 1)", name, value));
  return value == 1;
}

/// 0 is the default. Throws Error for what is not within kReach.
inline double or_one(double value, const char* name) {
  if (value == 0) return 1;
  if (!(value >= 1 / kReach && value <= kReach))
    throw Error(fmt::format("{} is {} (must be {}..{}, or 0 for 1)", name, value, 1 / kReach, kReach));
  return value;
}

template <class Given>
HeightFieldSettings ground_from(const Given& given) {
  if (!(std::abs(given.offset) <= kReach))
    throw Error(fmt::format("heights: offset is {} (must be within {})", given.offset, kReach));
  HeightFieldSettings settings{.cell_x = or_one(given.cell_x, "heights: cell_x"),
                               .cell_y = or_one(given.cell_y, "heights: cell_y"),
                               .scale = or_one(given.scale, "heights: scale"),
                               .offset = given.offset,
                               .exaggeration = or_one(given.exaggeration, "heights: exaggeration"),
                               .surface = choice(given.surface, Surface::triangles, "surface")};
  if (flag(given.has_nodata, "has_nodata")) settings.nodata = given.nodata;
  return settings;
}

}  // namespace scarp::c
