// SPDX-License-Identifier: MIT
#include "scarp/render/camera/field_view.h"

namespace scarp {
namespace {

// Fraction of the distance to the focus: ground this close covers a part of the picture that does not depend on the
// scale.
constexpr double kClear = 0.01;

}  // namespace

FieldView view_of_field(const HeightField& field, const WorldBox& box, const ViewSettings& settings,
                        double grid_north_azimuth, int width, int height) {
  dvec3 focus(0.5 * field.width(), 0.5 * field.depth(), 0);
  focus.z = field.height(focus.x, focus.y).value_or(field.max_height());
  FieldView view{Camera::framed(box, settings, grid_north_azimuth, width, height, focus)};
  const dvec3 eye = view.camera.eye();
  const auto ground = field.height(eye.x, eye.y);
  if (!ground) return view;
  const double least = *ground + kClear * length(eye - focus);
  if (eye.z >= least) return view;
  view.raised = least - eye.z;
  view.camera.move_eye({eye.x, eye.y, least});
  return view;
}

}  // namespace scarp
