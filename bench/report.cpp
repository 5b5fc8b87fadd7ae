// SPDX-License-Identifier: MIT
#include "bench/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "bench/embree_peer.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"

namespace scarp::bench {
namespace {

// "model name : AMD EPYC" of the first processor.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

std::string machine() {
  utsname system{};
  uname(&system);
  return fmt::format("{}, {} cores, {} {}, compiler {}, Embree {}", processor(), std::thread::hardware_concurrency(),
                     system.sysname, system.release, __VERSION__, EmbreePeer::version());
}

namespace {

// Numbers and words as in JSON, quoted only if they contain a comma; null is empty.
std::string csv_cell(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  const auto text = value.get<std::string>();
  return text.find_first_of(",\"") == std::string::npos ? text : value.dump();
}

// The columns are those of all rows, in order of first occurrence.
std::string csv_of(const nlohmann::ordered_json& rows) {
  std::vector<std::string> columns;
  for (const auto& row : rows) {
    for (const auto& [name, value] : row.items()) {
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
    }
  }
  std::string text = fmt::format("{}\n", fmt::join(columns, ","));
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      text += (i == 0 ? "" : ",") + csv_cell(row.value(columns[i], nlohmann::ordered_json()));
    text += '\n';
  }
  return text;
}

void write_file(const std::string& name, const std::string& text) {
  ReplaceFile file(name);
  std::ofstream out(file.temporary_path());
  out << text;
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", name));
  file.commit();
}

}  // namespace

void require_writable(const std::string& path) { const ReplaceFile probe(path); }

void write_json(const ReportOptions& options, const nlohmann::ordered_json& rows) {
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  const std::string date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
  if (!options.json.empty()) {
    nlohmann::ordered_json all;
    all["machine"] = machine();
    all["command"] = options.command;
    all["date"] = date;
    all["rows"] = rows;
    write_file(options.json, all.dump(1) + '\n');
  }
  if (!options.csv.empty()) {
    write_file(options.csv, fmt::format("# machine: \"{}\"\n# command: {}\n# date: {}\n{}", machine(), options.command,
                                        date, csv_of(rows)));
  }
}

std::string short_number(const nlohmann::ordered_json& value, int digits) {
  if (value.is_null()) return "-";
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  return fmt::format("{:.{}g}", value.get<double>(), digits);
}

void print_table(const std::vector<std::vector<std::string>>& lines, std::size_t left) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()));
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
      text += i < left ? fmt::format("{:<{}}  ", line[i], widths[i]) : fmt::format("{:>{}}  ", line[i], widths[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    std::puts(text.c_str());
  }
  std::fflush(stdout);
}

}  // namespace scarp::bench
