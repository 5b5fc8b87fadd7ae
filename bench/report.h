// SPDX-License-Identifier: MIT
// Results for programs and for people: the JSON and CSV of all commands, and plain tables.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace scarp::bench {

/// What every command is asked about its output.
struct ReportOptions {
  std::string command;  ///< as typed
  std::string json;     ///< a file to write; empty: none
  std::string csv{};    ///< likewise
};

/// For the options that name these files, so that no figures are lost after a long run: throws Error if one cannot be
/// written there; otherwise returns an empty string, as CLI11 expects of checks.
std::string writable(const std::string& path);

/// Writes the files of `options`: JSON is {machine, command, date, rows}; CSV has the first three as comments, and the
/// rows as bench/results keeps them. Throws Error if a file cannot be written; it is then not left or changed.
void write_json(const ReportOptions& options, const nlohmann::ordered_json& rows);

/// A number with so many significant digits, in as few characters as that takes; "-" for null.
std::string short_number(const nlohmann::ordered_json& value, int digits = 3);

/// A table of text: the first row is the head. The first `left` columns are set to the left, the others to the right.
void print_table(const std::vector<std::vector<std::string>>& lines, std::size_t left);

/// Processor, cores, system, compiler, Embree: one line.
std::string machine();

}  // namespace scarp::bench
