// SPDX-License-Identifier: MIT
#include "scarp/analysis/line_of_sight.h"

#include <fmt/format.h>

#include <cmath>

#include "scarp/analysis/sight_crossings.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

SightEnd rounded(const HeightField& field, SightEnd end, std::string_view name) {
  const double last_col = field.cols() - 1, last_row = field.rows() - 1;
  constexpr auto kSteps = static_cast<double>(kSubcells);
  end.col = std::round(end.col * kSteps) / kSteps;
  end.row = std::round(end.row * kSteps) / kSteps;
  if (!(end.col >= 0 && end.row >= 0 && end.col <= last_col && end.row <= last_row))
    throw Error(fmt::format("{}: column {:.10g}, row {:.10g} is outside the raster (columns 0 to {}, rows 0 to {})",
                            name, end.col, end.row, last_col, last_row));
  if (!std::isfinite(end.height) || (end.datum == HeightDatum::ground && end.height < 0))
    throw Error(fmt::format("{}: height {} m (must be 0 or more above ground)", name, end.height));
  return end;
}

// Metres above sea of an end; `ground` becomes the ground below it.
double height_of(const SightGround& heights, const SightEnd& end, std::string_view name, double& ground) {
  const auto found = heights.height_at(end.col, end.row);
  ground = found.value_or(std::numeric_limits<double>::quiet_NaN());
  if (!found && end.datum == HeightDatum::ground)
    throw Error(fmt::format("{}: column {:.10g}, row {:.10g} is on nodata (give its height above sea)", name, end.col,
                            end.row));
  const double height = end.datum == HeightDatum::sea ? end.height : *found + end.height;
  if (found && height < *found)
    throw Error(fmt::format("{}: height {:.10g} m is below the ground at {:.10g} m", name, height, *found));
  return height;
}

}  // namespace

SightLine::SightLine(const HeightField& field, const SightEnd& from, const SightEnd& to,
                     const SightCurvature& curvature)
    : from_(rounded(field, from, "observer")),
      to_(rounded(field, to, "target")),
      ground_(field, from_.col, from_.row, curvature) {
  eye_ = height_of(ground_, from_, "observer", eye_ground_);
  target_ = ground_.lowered(height_of(ground_, to_, "target", target_ground_), to_.col, to_.row);
  distance_ = std::sqrt(ground_.square_distance(to_.col, to_.row));
}

LineOfSight line_of_sight(const HeightField& field, const SightEnd& from, const SightEnd& to,
                          const SightCurvature& curvature) {
  const SightLine line(field, from, to, curvature);
  LineOfSight result;
  result.distance = line.distance();
  result.eye = line.eye();
  result.target = line.target() + line.ground().drop(line.to().col, line.to().row);
  for (int axis = 0; axis < 2; ++axis)
    visit_sight(line, axis, [&](const SightCrossing& at) {
      const double clearance = at.ray() - at.ground();
      if (clearance < result.clearance) {
        result.clearance = clearance;
        result.clearance_along = at.along();
      }
      if ((!result.obstruction || at.along() < result.obstruction->along) && sign_of(at.terms) > 0) {
        const double along = at.along(), col = line.col(along), row = line.row(along);
        result.visible = false;
        result.obstruction = {along, col, row, at.ground() + at.drop(line.ground())};
      }
      return true;
    });
  return result;
}

}  // namespace scarp
