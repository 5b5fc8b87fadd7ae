// SPDX-License-Identifier: MIT
// Heights and normals of the ground at many points in one call.
#pragma once

#include <span>

#include "scarp/field/height_field.h"

namespace scarp {

/// Sets heights[i] to field.height(xs[i], ys[i]) in metres, NaN outside the field and over holes, and unless `normals`
/// is empty, normals[i] to the upward unit normal of the surface there (HeightField::normal()), zero without ground.
/// Runs on all threads, or on the executor of this thread (base/executor.h). Throws Error if spans differ in length.
void heights_at(const HeightField& field, std::span<const double> xs, std::span<const double> ys,
                std::span<double> heights, std::span<dvec3> normals = {});

}  // namespace scarp
