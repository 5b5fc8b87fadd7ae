// SPDX-License-Identifier: MIT
// What the targets of formats that are read as parts share.
#pragma once

#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"
#include "scarp/source/voxel_parts.h"

namespace scarp::fuzz {

/// Aborts when a voxel is outside its part, or when the refusal is empty or has several lines.
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
