// SPDX-License-Identifier: MIT
// Line of sight between two points of a field. sight.h defines what blocks it.
//
//   const auto line = scarp::line_of_sight(field, {.col = 10, .row = 20, .height = 2}, {.col = 400, .row = 90});
//   if (!line.visible) std::printf("blocked after %g m\n", line.obstruction->along * line.distance);
#pragma once

#include <limits>
#include <optional>
#include <string_view>

#include "scarp/analysis/sight.h"

namespace scarp {

/// One end of a line of sight.
struct SightEnd {
  double col = 0, row = 0;                  ///< rounded to 1/kSubcells of a cell
  double height = 0;                        ///< metres; >= 0 above ground
  HeightDatum datum = HeightDatum::ground;  ///< reference of `height`
  bool under_surface = false;               ///< may be below the field: under trees
};

/// Returns the column or row of an end as SightLine rounds it.
double rounded_end(double position);

class SightParts;

/// Two ends of a line, ready for queries: checked, rounded, with heights.
class SightLine {
 public:
  /// `cells`: lengths of a column and a row step along this line in metres, if not those of the field. Throws Error for
  /// an end outside the field, an end on a hole whose height is above ground, a height that is below the ground (unless
  /// `under_surface`) or not finite, and a length or a curvature out of range.
  SightLine(const HeightField& field, const SightEnd& from, const SightEnd& to, const SightCurvature& curvature,
            const std::optional<dvec2>& cells = {});

  const SightGround& ground() const { return ground_; }
  double col(double along) const { return from_.col + along * (to_.col - from_.col); }
  double row(double along) const { return from_.row + along * (to_.row - from_.row); }
  const SightEnd& from() const { return from_; }
  const SightEnd& to() const { return to_; }
  double distance() const { return distance_; }  ///< metres, horizontal
  double eye() const { return eye_; }            ///< metres above sea
  double target() const { return target_; }      ///< metres, lowered
  /// Heights of the ground at the ends in metres above sea; NaN on a hole.
  double ground_at_eye() const { return eye_ground_; }
  double ground_at_target() const { return target_ground_; }

 private:
  friend class SightParts;
  // Without heights.
  SightLine(const SightEnd& from, const SightEnd& to, const SightGround& ground)
      : from_(from), to_(to), ground_(ground) {}
  // Returns the end with rounded position, of a field of `cols` x `rows` nodes. Throws Error for an invalid end.
  static SightEnd checked(int cols, int rows, SightEnd end, std::string_view name);
  // Set heights and distance. Grounds may be of different parts, in which positions count from their first node.
  void stand_observer(const SightEnd& from, const SightGround& around);
  void stand_target(const SightEnd& to, const SightGround& around);

  SightEnd from_, to_;
  SightGround ground_;
  double distance_ = 0, eye_ = 0, target_ = 0, eye_ground_ = 0, target_ground_ = 0;
};

/// The first crossing, from the start, that blocks a line of sight.
struct Obstruction {
  double along = 0;         ///< 0 at the start, 1 at the end
  double col = 0, row = 0;  ///< its position
  double height = 0;        ///< height of the ground there in metres above sea
};

/// Result of line_of_sight(). Numbers are rounded; `visible` is exact.
struct LineOfSight {
  bool visible = true;
  std::optional<Obstruction> obstruction{};  ///< set if not visible
  double distance = 0;                       ///< metres, horizontal
  double eye = 0, target = 0;                ///< metres above sea
  /// Least height, in metres, of the line above the ground at crossings; negative if blocked; infinity without
  /// crossings.
  double clearance = std::numeric_limits<double>::infinity();
  double clearance_along = 0;  ///< position of the least clearance, 0..1 along the line
};

class BlockMaxima;

/// Answers one query. Throws as SightLine does. `maxima` of the same field speed up many lines over one field, with the
/// same results; without them every crossing is visited. `cells` as for SightLine.
LineOfSight line_of_sight(const HeightField& field, const SightEnd& from, const SightEnd& to,
                          const SightCurvature& curvature = {}, const BlockMaxima* maxima = nullptr,
                          const std::optional<dvec2>& cells = {});

/// Returns the radius of the first Fresnel zone in metres, `from` and `to` metres from the ends of a path: there, a
/// detour over the edge of the zone is half a wavelength longer (ITU-R P.526). All in metres, `from` + `to` > 0.
double fresnel_radius(double wavelength, double from, double to);

/// Result of fresnel_clearance().
struct FresnelClearance {
  /// Height of the line above the ground over the radius of the first Fresnel zone: 1 if all of the zone is clear, 0 if
  /// the line grazes, negative if it is blocked. Infinity without crossings.
  double share = std::numeric_limits<double>::infinity();
  double along = 0;  ///< position of this share, 0..1 along the line
};

/// Returns the least share over all crossings. Heights are vertical and distances horizontal. `wavelength` in metres,
/// > 0.
FresnelClearance fresnel_clearance(const SightLine& line, double wavelength);

}  // namespace scarp
