// SPDX-License-Identifier: MIT
// Heights and normals of points in vectors of doubles: the operations of HeightField::height() and normal(), in their
// order, so the results are equal bit for bit.
#pragma once

#include <cstddef>

#include "scarp/field/height_field.h"

namespace scarp {

/// Sets heights[i] to field.height(xs[i], ys[i]), NaN without ground, and unless `normals` is null, normals[i] as
/// heights_at() does, for `count` points. Runs on the calling thread.
void look_up_points(const HeightField& field, const double* xs, const double* ys, std::size_t count, double* heights,
                    dvec3* normals);
/// The same for one point. `normal` may be null.
void look_up_point(const HeightField& field, double x, double y, double& height, dvec3* normal);

}  // namespace scarp
