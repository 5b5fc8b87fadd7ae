// SPDX-License-Identifier: MIT
// The one line that scarp-bench prints when its options are wrong.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace scarp::bench {

/// The exit status that goes with it.
constexpr int kWrongUsage = 2;

/// What is wrong, and which help tells more; CLI11's own words where there are no better ones.
std::string wrong_usage(const CLI::ParseError& error, const CLI::App& program);

/// The word that stands where a subcommand should; empty where one does, or nothing.
std::string unknown_subcommand(const CLI::App& program);

}  // namespace scarp::bench
