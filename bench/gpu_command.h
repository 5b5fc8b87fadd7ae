// SPDX-License-Identifier: MIT
// Options of `scarp-bench devices` and `scarp-bench gpu`.
#pragma once

#include <CLI/CLI.hpp>

#include "bench/commands.h"

namespace scarp::bench {

constexpr int kLeastSize = 33, kMostSize = 32767;  ///< samples per side; the limit of Embree's grids

CLI::App* add_devices_command(CLI::App& app, DevicesOptions& options);
/// All options but those of the report.
CLI::App* add_gpu_command(CLI::App& app, GpuOptions& options);

}  // namespace scarp::bench
