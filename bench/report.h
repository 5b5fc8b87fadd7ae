// SPDX-License-Identifier: MIT
// Output for programs and for human readers: the JSON and CSV of all commands, and plain tables.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace scarp::bench {

/// Output options of every command.
struct ReportOptions {
  std::string command;  ///< as typed
  std::string json;     ///< a file to write; empty: none
  std::string csv{};    ///< likewise
};

/// Throws Error if the file cannot be written, so that a long run does not lose its results.
void require_writable(const std::string& path);

/// Writes the files of `options`: JSON is {machine, command, date, rows}; CSV has the first three as comments, and the
/// rows in the format of bench/results. Throws Error if a file cannot be written; it is then neither created nor
/// changed.
void write_json(const ReportOptions& options, const nlohmann::ordered_json& rows);

/// A number with this many significant digits, as short as possible; "-" for null.
std::string short_number(const nlohmann::ordered_json& value, int digits = 3);

/// Prints a table of text; the first row is the heading. The first `left` columns are left-aligned, the others
/// right-aligned.
void print_table(const std::vector<std::vector<std::string>>& lines, std::size_t left);

/// Processor, cores, system, compiler, Embree: one line.
std::string machine();

}  // namespace scarp::bench
