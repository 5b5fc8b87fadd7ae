// SPDX-License-Identifier: MIT
// Generates the output of `--help` from the declarations of the options.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/options/command.h"

namespace scarp::cli {

/// The program: its subcommands.
std::string help_text(const Program& program);
/// A subcommand. Topic "": the common options where there are many; "all": every option; else the options of a topic.
/// Throws WrongUsage listing the topics if there is no such topic.
std::string help_text(const Command& command, const std::string& topic);

/// The topics of a subcommand in order, each with its options.
using TopicOptions = std::pair<Topic, std::vector<const Declared*>>;
std::vector<TopicOptions> options_by_topic(const Command& command);
/// "scarp render [IN...] -o FILE [OPTIONS]".
std::string usage_of(const Command& command);

}  // namespace scarp::cli
