// SPDX-License-Identifier: MIT
// Programs that compute viewsheds and shadows: `scarp` and its peers, run as whole processes from file to file.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bench/maps_options.h"

namespace scarp::bench {

class MapPrograms {
 public:
  /// Prints to stderr which of options.programs are not installed. Only the others are measured.
  explicit MapPrograms(const MapsOptions& options);

  /// Creates the DEM of this size and returns a row for each program, as README.md describes. A program that exceeds
  /// options.program_limit_s has no time in its row, and no row in later calls.
  std::vector<nlohmann::ordered_json> measure(int size);

  /// Measures cumulative viewsheds: for each pixel, the number of options.observers at random positions that see it.
  /// Takes one run of scarp, and one run of gdal_viewshed per observer.
  std::vector<nlohmann::ordered_json> measure_cumulative(int size);

 private:
  MapsOptions options_;
  std::set<std::string> names_, late_;
};

}  // namespace scarp::bench
