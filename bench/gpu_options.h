// SPDX-License-Identifier: MIT
// Options of `scarp-bench gpu`, with and without --raster.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/fields.h"
#include "bench/rays.h"
#include "bench/report.h"

namespace scarp::bench {

/// `gpu`: the marches on a Vulkan device, and the comparison of the max-mip article there.
struct GpuOptions {
  FieldOptions field;
  std::string device = "auto";    ///< DeviceSettings::choice
  std::vector<int> sizes;         ///< samples per side; empty: 1025, 4097 and, except on CPU devices, 16385
  std::optional<RayCounts> rays;  ///< nullopt: those of RayCounts, for CPU devices a sixteenth
  std::int64_t judged = 0;        ///< rays per class that the oracle also traces; 0: 20,000, for CPU devices 4096
  std::uint64_t ray_seed = 1;
  std::vector<std::string> classes{"chunk", "primary", "shadow", "grazing", "ao"};
  std::vector<double> exaggerations{1};
  double miss_limit = 0.001;  ///< fraction of the hits that naive-missed may miss
  int repeats = 5;
  double pass_limit_s = 10;
  bool raster = false;
};
/// Compares primary rays with drawing the same triangles. Sizes are 1025, 2049, 4097, 16385; on CPU devices 257, 513,
/// 1025, 2049, 4097.
void run_gpu_raster(const GpuOptions& options, const ReportOptions& report);

}  // namespace scarp::bench
