// SPDX-License-Identifier: MIT
// Heights and normals of the ground, at one point or at many in one call.
#pragma once

#include <optional>
#include <span>

#include "scarp/field/height_field.h"

namespace scarp {

/// A point of the ground.
struct GroundPoint {
  double height;  ///< metres
  dvec3 normal;   ///< upward unit normal of the surface, HeightField::normal()
};

/// Returns the height and the normal at (x, y), in less time than height(), place() and normal() of the field; nullopt
/// outside the field and over holes.
std::optional<GroundPoint> ground_point(const HeightField& field, double x, double y);

/// Sets heights[i] to field.height(xs[i], ys[i]) in metres, NaN outside the field and over holes, and unless `normals`
/// is empty, normals[i] to the upward unit normal of the surface there (HeightField::normal()), zero without ground.
/// Runs on all threads, or on the executor of this thread (base/executor.h). Throws Error if spans differ in length.
void heights_at(const HeightField& field, std::span<const double> xs, std::span<const double> ys,
                std::span<double> heights, std::span<dvec3> normals = {});

}  // namespace scarp
