// SPDX-License-Identifier: MIT
// Contacts in scenes with many objects: voxel balls of 2 m and hills of 2 x 2 m, at the placements of `objects`, whose
// fields are 0 or 1. Spheres of 0.5 m move by 1 m, boxes of 1 m do not move, closest points are searched without a
// limit, all at random positions in the cube of the objects.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "scarp/scene/scene.h"

namespace scarp::bench {

/// Returns the row's members: number of queries, microseconds of processor time per query of each kind (median of
/// `repeats` passes) and the number of sweeps and boxes that touch something.
nlohmann::ordered_json measure_contacts(const std::vector<SceneObject>& objects, double side, int queries, int repeats);

}  // namespace scarp::bench
