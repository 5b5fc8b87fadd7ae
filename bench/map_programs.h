// SPDX-License-Identifier: MIT
// Programs that make viewsheds and shadows: `scarp` and its peers, as whole processes from one file to another.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bench/maps_options.h"

namespace scarp::bench {

class MapPrograms {
 public:
  /// Notes on stderr which of options.programs are not installed, and measures the others.
  explicit MapPrograms(const MapsOptions& options);

  /// Makes the DEM of this size and returns a row for each program, as README.md describes. A program that exceeds
  /// options.program_limit_s gets no time, and no row in later calls.
  std::vector<nlohmann::ordered_json> measure(int size);

  /// Number of options.observers at random positions that see each pixel: one run of scarp, and one run of
  /// gdal_viewshed for each.
  std::vector<nlohmann::ordered_json> measure_cumulative(int size);

 private:
  MapsOptions options_;
  std::set<std::string> names_, late_;
};

}  // namespace scarp::bench
