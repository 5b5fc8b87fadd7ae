// SPDX-License-Identifier: MIT
// Shared by the targets of formats that are read as parts.
#pragma once

#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"
#include "scarp/source/voxel/voxel_parts.h"

namespace scarp::fuzz {

/// Aborts if a voxel is outside its part, or if the error is empty or has several lines.
template <class Parse>
void expect_parts(const Parse& parse, std::string_view bytes) {
  try {
    for (const VoxelPart& part : parse(bytes).parts) {
      for (const ListedVoxel& v : part.voxels) {
        require(v.x >= 0 && v.y >= 0 && v.z >= 0);
        require(v.x < part.size.x && v.y < part.size.y && v.z < part.size.z);
      }
    }
  } catch (const Error& error) {
    expect_line(error);
  }
}

}  // namespace scarp::fuzz
