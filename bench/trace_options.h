// SPDX-License-Identifier: MIT
// The ground, rays and threads of the commands that trace rays over height fields, and their options.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "bench/fields.h"
#include "bench/rays.h"

namespace scarp::bench {

constexpr int kLeastSize = 33, kMostSize = 32767;  ///< samples per side; the limit of Embree's grids

/// Ground, rays and threads; shared by the commands that trace rays.
struct TraceOptions {
  FieldOptions field;
  RayCounts rays;
  std::uint64_t ray_seed = 1;
  std::vector<double> exaggerations{1};
  std::vector<int> threads{1};
  int repeats = 3;
  double pass_limit_s = 10;
  std::int64_t judged = 20000;             ///< rays per class that the judge also traces
  std::string instruction_set = "native";  ///< bench/instruction_set.h (heights, survey)
};

/// --size or --sizes.
void add_size_option(cli::Command& command, int& size, const char* help = "samples per side of the procedural DEM");
void add_sizes_option(cli::Command& command, std::vector<int>& sizes,
                      const char* help = "samples per side of the procedural DEM");
/// --kind and --seed.
void add_ground_options(cli::Command& command, FieldOptions& field);
void add_repeats_option(cli::Command& command, int& repeats, const char* help = "counted passes");
void add_pass_limit_option(cli::Command& command, double& seconds, const char* what);
/// --classes, any of those named by `classes` or listed.
void add_classes_option(cli::Command& command, std::vector<std::string>& classes, std::vector<std::string> known = {});
/// --threads, --repeats, --ray-seed, --pass-limit and --rays.
void add_measure_options(cli::Command& command, TraceOptions& trace);
/// The options of add_measure_options(), and --dem, --kind, --seed, --exaggerations and --judged.
void add_trace_options(cli::Command& command, TraceOptions& trace);
/// --target, --samples and --surface.
void add_field_options(cli::Command& command, TraceOptions& trace);
/// Declares --rays full or small, which calls reads(size).
void add_ray_size_option(cli::Command& command, cli::Setter reads, const char* note);

}  // namespace scarp::bench
