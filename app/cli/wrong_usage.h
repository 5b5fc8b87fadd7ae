// SPDX-License-Identifier: MIT
// What a program says in one line where its options are wrong: of scarp and scarp-bench alike.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace scarp::cli {

/// The exit status that goes with it.
constexpr int kWrongUsage = 2;

/// What is wrong, and which help tells more; CLI11's own words where there are no better ones.
std::string wrong_usage(const CLI::ParseError& error, const CLI::App& program);

/// The word that stands where a subcommand should; empty where one does, or nothing.
std::string unknown_subcommand(const CLI::App& program);

}  // namespace scarp::cli
