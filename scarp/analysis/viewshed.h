// SPDX-License-Identifier: MIT
// Viewshed: which nodes of a field an observer sees. sight.h defines what blocks a line of sight.
//
//   const auto seen = scarp::viewshed(field, {.col = 512, .row = 300}, {.observer_height = 2});
#pragma once

#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "scarp/analysis/sight.h"
#include "scarp/base/progress.h"

namespace scarp {

/// Visibility of a node.
enum class Seen : std::uint8_t {
  hidden,        ///< ground blocks the line of sight
  visible,       ///< nothing blocks it; also the observer's own node
  out_of_range,  ///< outside the limits of distance or direction, visible or not
  hole,          ///< no sample
};

struct ViewshedSettings {
  double observer_height = 2;                                     ///< metres above ground, >= 0
  std::optional<double> observer_z = std::nullopt;                ///< metres above sea, in place of the above
  double target_height = 0;                                       ///< metres above ground, >= 0
  SightCurvature curvature = {};                                  ///< curvature and refraction
  double min_distance = 0;                                        ///< metres, >= 0: nearer targets are out of range
  double max_distance = std::numeric_limits<double>::infinity();  ///< metres, >= min_distance
  double first_azimuth = 0;                                       ///< radians clockwise from grid north, 0..2pi
  double last_azimuth = 2 * std::numbers::pi;                     ///< likewise; less than the first: through north
  double low_pitch = -std::numbers::pi / 2;                       ///< radians above horizontal, -pi/2..pi/2
  double high_pitch = std::numbers::pi / 2;                       ///< likewise, >= low_pitch
  bool under_surface = false;                                     ///< the eye may be below the field: under trees
};

/// Throws Error if a setting is out of range.
void validate(const ViewshedSettings& settings);

/// An observer's eye over a field, and its limits. Engines and judge share it.
class Viewpoint {
 public:
  /// Throws Error for settings out of range, an observer outside the field or on a hole without `observer_z`, or an eye
  /// below the ground, unless `under_surface`.
  Viewpoint(const HeightField& field, Node observer, const ViewshedSettings& settings);

  Node observer() const { return observer_; }
  const SightGround& ground() const { return ground_; }
  double eye() const { return eye_; }  ///< metres above sea
  const ViewshedSettings& settings() const { return settings_; }

  /// Height of the target over a node with this lowered height.
  double target(double lowered) const { return lowered + settings_.target_height; }
  /// Angle in radians, -pi/2..pi/2, by which the line to a target of this height, lowered, rises above the horizontal.
  double pitch(Node node, double target) const;
  /// Whether any node may be out of range.
  bool has_limits() const { return limits_distance_ || limits_azimuth_ || limits_pitch_; }
  /// Whether a node is within the limits; `target` is its target's height, lowered.
  bool in_range(Node node, double target) const;

 private:
  ViewshedSettings settings_;
  Node observer_;
  SightGround ground_;
  double eye_ = 0;
  bool limits_distance_ = false, limits_azimuth_ = false, limits_pitch_ = false;
};

/// Returns the code of every node, rows from north to south. Throws as Viewpoint does.
std::vector<Seen> viewshed(const HeightField& field, Node observer, const ViewshedSettings& settings = {},
                           const Progress& progress = {});

/// Returns, for every node, the least lowered height at which a target is visible: the smallest double for which no
/// crossing blocks. -infinity if no crossing can block (the observer's node, its neighbours); NaN for holes and targets
/// out of range. A target of height h above ground is visible if lowered ground + h is not below it. `target_height`
/// only matters for pitch limits.
std::vector<double> least_visible(const HeightField& field, Node observer, const ViewshedSettings& settings = {},
                                  const Progress& progress = {});

/// Returns, for every node, the angle in degrees above the horizontal at which the observer sees its target
/// (Viewpoint::pitch()); NaN where the target is hidden or out of range, and for holes. `codes` is the viewshed of the
/// same observer, or some of its rows, the first of which is `first_row`.
std::vector<float> sight_angles(const Viewpoint& view, std::span<const Seen> codes, int first_row = 0);

/// Converts one result of least_visible(): the least height of a visible target above sea (at least the ground) or
/// above ground (at least 0), in metres. NaN stays NaN.
float least_height(const SightGround& ground, Node node, double least_visible, HeightDatum datum);

}  // namespace scarp
