// SPDX-License-Identifier: MIT
// The marches of shapes. Their oracle is shape_exhaustive.h.
#pragma once

#include <span>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/field/distance_field.h"
#include "scarp/march/hit_rules.h"
#include "scarp/march/march_entry.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Returns the closest hit of a ray in world space. Overwrites `stats` unless null.
using ShapeMarch = Hit (*)(const DistanceField& shape, const Ray& ray, const MarchSettings& settings,
                           MarchStats* stats);
/// Returns whether the status of the closest hit is `hit`.
using ShapeOcclusion = bool (*)(const DistanceField& shape, const Ray& ray, const MarchSettings& settings);

/// Returns the closest hit that the filter accepts.
using ShapeMarchFiltered = Hit (*)(const DistanceField& shape, const Ray& ray, const HitFilter& accept,
                                   const MarchSettings& settings, MarchStats* stats);

/// A row of the table. No function is null.
struct ShapeMarchEntry : MarchEntry {
  ShapeMarch cpu = nullptr;  ///< scalar C++
  ShapeOcclusion occluded = nullptr;
  ShapeMarchFiltered filtered = nullptr;
};

std::span<const ShapeMarchEntry> shape_marches();
/// Throws Error listing the names if the march is unknown.
const ShapeMarchEntry& find_shape_march(std::string_view name);

}  // namespace scarp
