// SPDX-License-Identifier: MIT
// The path of a body as a table: CSV with a header, one row per pose, columns in any order.
//
//   time,x,y,z,heading,pitch,roll        or lon,lat instead of x,y; `above` (metres above ground) instead of z;
//   0.00,500,200,901.8,90,0,0            pitch and roll are optional (0)
//
// Other columns are skipped. Dialect: ray_table.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

struct PoseRow {
  double time = 0;                          ///< seconds
  dvec3 at{0.0};                            ///< z in metres
  double heading = 0, pitch = 0, roll = 0;  ///< degrees
  std::int64_t line = 0;                    ///< in the file, from 1
};

struct PoseTable {
  std::string path;           ///< for messages
  bool lonlat = false;        ///< x and y are from columns lon and lat
  bool above_ground = false;  ///< z is from the column `above`
  std::vector<PoseRow> rows;  ///< at least one; times increase
};

/// Throws Error with the line but without the file's name: missing columns, duplicate columns, both x and lon, both z
/// and above, rows with more or fewer fields than the header, fields that are not finite numbers, times that do not
/// increase, no rows.
PoseTable parse_pose_csv(std::string_view bytes);

/// Reads a file. Throws Error naming it.
PoseTable read_poses(const std::string& path);

}  // namespace scarp
