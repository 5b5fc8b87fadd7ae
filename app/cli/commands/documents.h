// SPDX-License-Identifier: MIT
// Documents that are generated from the declarations of the options.
#pragma once

#include <string>
#include <string_view>

#include "app/options/command.h"

namespace scarp::cli {

/// `text` with every `from` replaced by `to`.
std::string replaced(std::string text, std::string_view from, std::string_view to);

/// doc/user/options.md.
std::string options_markdown(const Program& program);
/// The subcommands and their options as one JSON object, for programs that build forms: their names, texts, kinds of
/// values, ranges, choices, files and restrictions.
std::string options_json(const Program& program);
/// scarp(1), and scarp-COMMAND(1) of a subcommand.
std::string man_page(const Program& program);
std::string man_page(const Command& command);

/// Scripts that complete subcommands, options, choices, and files by extension.
std::string bash_completion(const Program& program);
std::string zsh_completion(const Program& program);
std::string fish_completion(const Program& program);

}  // namespace scarp::cli
