// SPDX-License-Identifier: MIT
// A view of a height field that stays above its ground at any distance.
//
// At distance 1 the whole picture box is framed, with the plinth, and its middle may lie deep under
// the ground. Nearer views therefore approach a point ON the ground in the middle of the field: it keeps its position
// in the picture, and everything else grows from there.
#pragma once

#include "scarp/field/height_field.h"
#include "scarp/render/camera/camera.h"

namespace scarp {

struct FieldView {
  Camera camera;
  double raised = 0;  ///< metres by which the eye was raised out of a hill; 0: not raised
};

/// Camera::framed() with the ground in the middle of the field as its focus (the highest ground, where there is a hole
/// in the middle). If the eye would be below the ground or closer to it than a hundredth of its distance to the focus,
/// it is raised to that height, with the same view direction. `box` is picture_box().
FieldView view_of_field(const HeightField& field, const WorldBox& box, const ViewSettings& settings,
                        double grid_north_azimuth, int width, int height);

}  // namespace scarp
