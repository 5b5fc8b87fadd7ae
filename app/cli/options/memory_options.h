// SPDX-License-Identifier: MIT
// --memory and --scratch, of subcommands whose rasters may be larger than the machine's memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/cli/memory/memory_limit.h"
#include "app/options/command.h"

namespace scarp::cli {

struct MemoryOptions {
  std::string limit;    ///< "512M"; empty: half of the machine's
  std::string scratch;  ///< folder; empty: that of the output
};

/// Declares both. `excludes`: options with which little memory is needed.
void add_memory_options(Command& command, MemoryOptions& options, const std::vector<std::string>& excludes = {});

/// Starts the limit. Throws Error for a limit that is not a number or too small, and a folder that does not exist.
std::unique_ptr<MemoryLimit> limit_memory(const MemoryOptions& options, const std::string& output);

}  // namespace scarp::cli
