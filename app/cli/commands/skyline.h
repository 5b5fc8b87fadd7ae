// SPDX-License-Identifier: MIT
// The skyline of a point as a figure: layers of ground by distance, and names of visible points.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/cli/commands/horizon_place.h"
#include "app/cli/commands/horizon_points.h"
#include "scarp/output/skyline_figure.h"

namespace scarp::cli {

/// The points of --labels.
class SkylineNames {
 public:
  /// Reads the file; an empty name is none. Throws Error naming the file.
  explicit SkylineNames(const std::string& path);

  /// Returns those whose lines of sight from the place are free, for the figure, and appends the number of the others
  /// to `note`. The ground that was read must be that of the place.
  std::vector<SkylineLabel> visible_from(MapInput& input, const HorizonPlace& place, const HorizonSettings& settings,
                                         std::string& note) const;

 private:
  PlaceTable table_;
  std::size_t column_ = 0;  // with the names
};

/// The skyline of a place, in `count` directions from `first_azimuth` on, with layers of ground by distance.
SkylineFigure skyline_of(MapInput& input, const HorizonPlace& place, double first_azimuth, int count,
                         const HorizonSettings& settings);

/// "skyline at X,Y, eye 2 m above the ground", in --coords.
std::string skyline_title(const MapInput& input, const HorizonPlace& place);

/// Draws the skyline of the point of the table. Throws Error; Interrupted.
void draw_skyline(const HorizonOptions& options, MapInput& input, const PlaceTable& point, const SkylineNames& names);

}  // namespace scarp::cli
