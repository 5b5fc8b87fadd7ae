// SPDX-License-Identifier: MIT
#include "bench/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
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

void write_json(const ReportOptions& options, const nlohmann::ordered_json& rows) {
  if (options.json.empty()) return;
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  nlohmann::ordered_json all;
  all["machine"] = machine();
  all["command"] = options.command;
  all["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
  all["rows"] = rows;
  ReplaceFile file(options.json);
  std::ofstream out(file.temporary_path());
  out << all.dump(1) << '\n';
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", options.json));
  file.commit();
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
