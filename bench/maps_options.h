// SPDX-License-Identifier: MIT
// Options of `scarp-bench maps`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scarp::bench {

/// `maps`: viewsheds, shadows and least visible heights of all nodes of procedural DEMs; `scarp` compared with other
/// programs.
struct MapsOptions {
  std::vector<int> sizes{1024, 2048, 4096};
  std::string kind = "fbm";  ///< or "ridged"
  std::uint64_t seed = 1;
  int observer_height = 2;                   ///< metres; the observer is in the middle
  int azimuth_deg = 135, altitude_deg = 20;  ///< position of the sun
  int repeats = 3;
  std::int64_t judged = 100'000;  ///< nodes per map that are also decided by a ray
  int lines = 1'000'000;          ///< number of lines of sight
  std::vector<std::string> programs{"scarp", "gdal_viewshed", "r.viewshed", "r.sunmask", "saga"};
  std::string scarp;             ///< path of the program
  int observers = 500;           ///< number of observers of a cumulative viewshed; 0: none
  bool reach = false;            ///< whether small parts of a raster of 40,000 x 40,000 are measured, too
  double program_limit_s = 120;  ///< programs that take longer are stopped, and not run at larger sizes
};

}  // namespace scarp::bench
