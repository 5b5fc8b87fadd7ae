// SPDX-License-Identifier: MIT
// Programs that map horizons, sky view and hours of sun: `scarp` and its peers, run as whole processes from file to
// file, and their errors against every crossing in double.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace scarp::bench {

struct SkyProgramOptions {
  std::vector<std::string> programs;  ///< "scarp", "r.horizon", "r.sun", "saga"
  std::string scarp;                  ///< path of the program
  std::string kind = "ridged";
  std::uint64_t seed = 1;
  int size = 512, repeats = 3;
  int judged = 2000;             ///< pixels per map whose error is measured
  double program_limit_s = 300;  ///< programs that take longer are stopped
};

/// Returns a row for each map and program that is asked for and installed; prints to stderr which are not.
std::vector<nlohmann::ordered_json> measure_sky_programs(const SkyProgramOptions& options);

}  // namespace scarp::bench
