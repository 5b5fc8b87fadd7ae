// SPDX-License-Identifier: MIT
// Options shared by several subcommands that do not belong in any other file.
#pragma once

#include <string>
#include <vector>

#include "app/options/command.h"

namespace scarp::cli {

/// Declares -o, --output. `files` are its extensions; it is required without a default.
void add_output_option(Command& command, std::string& output, const std::string& help, const std::string& files,
                       const std::string& fallback = {});
/// Declares --threads.
void add_threads_option(Command& command, int& threads);
/// Declares --no-tone-curve for pictures in the file `output`, which must outlive the command.
void add_tone_option(Command& command, Binding to, const std::string& output, Topic topic, Looks looks = {});
/// Declares --json.
void add_json_option(Command& command, bool& json);

/// Declares --quiet. With it, the subcommand prints nothing but errors and warnings, and creates a SilentProgress.
void add_quiet_option(Command& command, bool& quiet, const std::vector<std::string>& excludes = {},
                      bool common = false);

}  // namespace scarp::cli
