// SPDX-License-Identifier: MIT
// The commands of scarp-bench and their options.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"

namespace scarp::bench {

/// Which ground, rays and threads; shared by the commands that trace rays.
struct TraceOptions {
  FieldOptions field;
  RayCounts rays;
  std::uint64_t ray_seed = 1;
  std::vector<double> exaggerations{1};
  std::vector<int> threads{1};
  int repeats = 3;
  double pass_limit_s = 10;
  std::int64_t judged = 20000;  ///< rays per class that the judge answers
};

/// `heights`: all marches beside Embree in the five ray classes.
struct HeightsOptions {
  TraceOptions trace;
  std::vector<int> sizes{2049};
  std::vector<std::string> classes{"primary", "shadow", "grazing", "ao", "nodes"};
  std::vector<std::string> engines{"scarp", "embree-tri", "embree-grid"};
  std::string embree_quality = "high";
};
void run_heights(const HeightsOptions& options, const ReportOptions& report);

/// `naive`: the comparison of the max-mip article, with naive marching as fine as it takes to be right.
struct NaiveOptions {
  TraceOptions trace;
  double miss_limit = 0.001;  ///< share of the judge's hits that naive may miss
};
void run_naive(const NaiveOptions& options, const ReportOptions& report);

/// `pyramid`: how fast the pyramid of maxima is built.
struct PyramidOptions {
  std::vector<int> sizes{2049, 8193};
  int repeats = 5;
};
void run_pyramid(const PyramidOptions& options, const ReportOptions& report);

/// `leaks`: rays aimed at what engines lose, each judged.
struct LeaksOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
  int large = 2049;                       ///< side of the large field, in samples
  std::int64_t judge_every = 4096;        ///< each so many-th ray over a small field is also answered by exhaustive
  std::int64_t embree_rays = 10'000'000;  ///< at most about so many are also given to Embree; 0: none
  std::string dump;                       ///< file for the first failing rays; empty: leaks-SEED.txt
};
/// Throws Error, after the report, when a ray was lost, false or contradictory.
void run_leaks(const LeaksOptions& options, const ReportOptions& report);

/// `edits`: how soon an edit of a rectangle is visible to queries.
struct EditsOptions {
  int size = 16385;  ///< samples per side
  int rect = 256;    ///< samples per side of the rectangle
  int edits = 200;
};
void run_edits(const EditsOptions& options, const ReportOptions& report);

/// `extents`: the largest fields, int16, beside windows cut out of them.
struct ExtentsOptions {
  std::vector<std::pair<int, int>> sizes{{65536, 512}, {65536, 65536}};  ///< columns and rows
  std::int64_t windows = 256;                                            ///< each with 256 rays
};
void run_extents(const ExtentsOptions& options, const ReportOptions& report);

/// `functions`: the marches over terrain functions beside proofs.
struct FunctionsOptions {
  int width = 480, height = 270;  ///< pixels
  int octaves = 9;                ///< of the fractals
  std::uint64_t seed = 1;
  int repeats = 3;
  std::int64_t judged = 4000;  ///< about so many rays per function are judged
};
/// Throws Error, after the report, when a conservative march lost a crossing.
void run_functions(const FunctionsOptions& options, const ReportOptions& report);

}  // namespace scarp::bench
