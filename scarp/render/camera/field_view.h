// SPDX-License-Identifier: MIT
// A view onto a height field that stays above its ground, however near it comes.
//
// At distance 1 the whole picture box is framed, with the plinth, and its middle may lie deep under
// the ground. Nearer views therefore go straight towards a place ON the ground, that in the middle of the field: it
// stays where it is in the picture, and all else grows from there.
#pragma once

#include "scarp/field/height_field.h"
#include "scarp/render/camera/camera.h"

namespace scarp {

struct FieldView {
  Camera camera;
  double raised = 0;  ///< metres by which the eye was lifted out of a hill; 0: it was above the ground
};

/// Camera::framed() with the ground in the middle of the field as its focus (the highest ground, where there is a hole
/// in the middle). Where the eye would come closer to the ground below it than a hundredth of its way to the focus, or
/// under it, it is raised to that height and looks the same way. `box` is what picture_box() says.
FieldView view_of_field(const HeightField& field, const WorldBox& box, const ViewSettings& settings,
                        double grid_north_azimuth, int width, int height);

}  // namespace scarp
