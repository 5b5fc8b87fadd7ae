// SPDX-License-Identifier: MIT
// Scenes with one terrain, for picture tests.
#pragma once

#include <string_view>
#include <utility>

#include "scarp/march/height/height_table.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp::test {

inline Scene terrain(HeightField field, std::string_view march = "max-mip", const MarchSettings& settings = {}) {
  return Scene(scene_heights(std::move(field), find_height_march(march), settings));
}

inline Scene terrain_on_plinth(HeightField field, std::string_view march = "max-mip") {
  return with_plinth(terrain(std::move(field), march));
}

}  // namespace scarp::test
