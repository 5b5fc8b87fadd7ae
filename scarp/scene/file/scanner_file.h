// SPDX-License-Identifier: MIT
// Scanners from JSON files.
//
//   {
//     "elevations": {"from": 2, "to": -24.8, "count": 64},
//     "azimuths": {"count": 1800},
//     "rate": 10,
//     "range": [1, 120],
//     "mounting": {"up": 1.7},
//     "pose": {"at": [500, 300], "above": 0, "heading": 90}
//   }
//
// doc/user/cast.md documents every key. Angles in the file are in degrees. The path of a table is relative to the
// file's folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scarp/scene/lidar.h"

namespace scarp {

struct ScannerFile {
  Lidar lidar;                      ///< positions of the path are in the coordinates of the file
  bool lonlat = false;              ///< they come from the columns lon and lat of a table
  std::vector<std::string> places;  ///< name of each pose for messages, "car.json: /path/3"
  std::vector<std::string> files;   ///< files that were read besides the file itself
};

/// Parses the text of a file in `folder`. Throws Error, without the file's name, for text that is not JSON, missing,
/// unknown and mistyped keys, values out of range, and a path whose times do not rise. The message names the position
/// as a JSON pointer and the expected value.
ScannerFile parse_scanner(std::string_view text, const std::string& folder);

/// Reads a file. Throws Error naming it.
ScannerFile read_scanner(const std::string& path);

}  // namespace scarp
