// SPDX-License-Identifier: MIT
// What whole programs get that make maps of one elevation model, and how they are run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "bench/program_run.h"
#include "bench/protocol.h"
#include "scarp/source/raster/raster.h"

namespace scarp::bench {

/// The elevation model in the folder of a run.
inline constexpr const char* kDem = "dem.tif";
/// The same output for all programs that write GeoTIFF. SAGA writes its own format, which is not compressed either.
inline constexpr const char* kTiled = "TILED=YES";
inline constexpr const char* kPlain = "COMPRESS=NONE";

/// Writes a procedural DEM on a plane in metres, and returns the surface of the file, which all programs read. The
/// scale is 1 and north is up at the centre, which is at longitude and latitude 0.
Raster make_dem(const std::string& path, const std::string& kind, std::uint64_t seed, int size);

/// Declares --scarp, the path of the program, and sets its default.
void add_scarp_option(cli::Command& command, std::string& path);

/// Runs job.sh in GRASS, in a location of the DEM.
std::vector<std::string> grass_words();
/// job.sh: `command` makes the raster `map` from the raster `dem`; the result is grass.tif.
std::string grass_script(const std::string& command, const std::string& sample_type, int nodata);

/// Runs programs in turn, each as often as `repeats`; slow ones run once. One that takes longer than `limit_s` has no
/// runs. A program has `words`, `script` (job.sh; empty: none) and `result`, a file.
template <class Program>
std::vector<std::vector<ProgramRun>> runs_of(const std::vector<Program>& programs, const std::string& folder,
                                             int repeats, double limit_s) {
  constexpr double kLong_s = 15;
  std::vector<std::vector<ProgramRun>> runs(programs.size());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < programs.size(); ++i) {
      if (repeat > 0 && (runs[i].empty() || runs[i].back().wall_s > kLong_s)) continue;
      const Program& program = programs[i];
      if (!program.script.empty()) std::ofstream(std::filesystem::path(folder) / "job.sh") << program.script;
      std::filesystem::remove(std::filesystem::path(folder) / program.result);
      if (const auto run = run_program(program.words, folder, limit_s)) runs[i].push_back(*run);
    }
  }
  return runs;
}

template <class Value>
double median_of(const std::vector<ProgramRun>& runs, const Value& value) {
  std::vector<double> values;
  for (const ProgramRun& run : runs) values.push_back(value(run));
  return median(values);
}

}  // namespace scarp::bench
