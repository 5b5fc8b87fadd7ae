// SPDX-License-Identifier: MIT
// `scarp-bench shaders`.
#pragma once

#include <string>
#include <vector>

#include "bench/report.h"

namespace scarp::bench {

/// `shaders`: RADV's statistics of each shader, for cards that need not be installed.
struct ShadersOptions {
  std::vector<std::string> families{"polaris10", "vega10", "navi10", "navi21", "gfx1100"};  ///< of AMD cards
  std::string shader{};  ///< only shaders whose path contains this
  std::string update{};  ///< a table of shader_table.h to write; empty: none
};
/// Throws Error if RADV is missing or does not know a family, or if no shader has the name.
void run_shaders(const ShadersOptions& options, const ReportOptions& report);

}  // namespace scarp::bench
