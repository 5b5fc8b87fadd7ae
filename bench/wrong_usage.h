// SPDX-License-Identifier: MIT
// The one line that scarp-bench prints when its options are wrong.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace scarp::bench {

/// Its exit status.
constexpr int kWrongUsage = 2;

/// Describes the error and names the help to read; in CLI11's words if there are no better ones.
std::string wrong_usage(const CLI::ParseError& error, const CLI::App& program);

/// The word in place of a subcommand; empty if it is a subcommand, or if there is none.
std::string unknown_subcommand(const CLI::App& program);

}  // namespace scarp::bench
