// SPDX-License-Identifier: MIT
// The columns shared by the tables of marches. Each kind of field has its own table:
//
//   height/height_table.h   function/function_table.h   shape/shape_table.h   voxel/voxel_table.h
//
// The command line, benchmarks, tests and documentation read the tables: a technique in a table is tested against its
// oracle. Techniques do not include the tables.
#pragma once

#include <string_view>

#include "scarp/march/guarantee.h"
#include "scarp/march/sampling_kind.h"

namespace scarp {

struct MarchEntry {
  std::string_view name{};  ///< as typed: "max-mip"
  Guarantee guarantee = Guarantee::approximate;
  Sampling sampling = Sampling::none;
  bool simd = false;               ///< answers batches with vector code
  bool gpu = false;                ///< runs on Vulkan devices
  std::string_view parameters{};   ///< its settings with their defaults, in readable form
  std::string_view description{};  ///< one line
};

}  // namespace scarp
