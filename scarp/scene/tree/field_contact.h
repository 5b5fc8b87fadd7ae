// SPDX-License-Identifier: MIT
// Contacts and closest points, with the part of the field that they are on.
#pragma once

#include <cstdint>

#include "scarp/base/ray.h"
#include "scarp/march/sweep.h"

namespace scarp {

/// A position on a field. Members that name a kind of field are set only for that kind, as in Hit.
struct FieldPlace {
  Cell cell{};             ///< height fields and tiles
  ivec3 voxel{-1};         ///< voxels
  std::uint32_t part = 0;  ///< voxels: index of the placed model; tiles: index of the tile
};

struct FieldContact : Contact {
  FieldPlace place;
};

struct FieldPoint {
  dvec3 point{0.0};
  dvec3 normal{0.0};    ///< unit, outward; zero within a voxel
  double distance = 0;  ///< 0: in a voxel
  FieldPlace place;
};

}  // namespace scarp
