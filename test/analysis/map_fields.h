// SPDX-License-Identifier: MIT
// Small adversarial fields for viewsheds and shadows.
#pragma once

#include <string>
#include <vector>

#include "scarp/analysis/shadow.h"
#include "scarp/analysis/viewshed.h"

namespace scarp::test {

struct MapField {
  std::string name;
  HeightField field;
};

/// At least 60 fields of up to 24 samples per side: shapes, ties, cliffs, holes, oblong cells, single rows.
std::vector<MapField> map_fields();

/// Observers in a field: at corners, at edges and inside, wherever there is a sample.
std::vector<Node> map_observers(const HeightField& field);

/// Viewshed settings: on the ground, on a tower, high up, with and without curvature and limits.
std::vector<ViewshedSettings> map_settings();

/// Sun positions: along axes and diagonals, between them, low and high.
std::vector<SunDirection> map_suns();

}  // namespace scarp::test
