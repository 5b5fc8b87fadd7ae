// SPDX-License-Identifier: MIT
#include "bench/command.h"

namespace scarp::bench {

void add_report_options(cli::Command& command, ReportOptions& report) {
  const auto file = [&command](std::string& to, const char* name, const char* help, const char* type) {
    command.add(
        [&to](const std::string& path) {
          require_writable(path);
          to = path;
        },
        {.names = name, .value = "FILE", .help = help, .files = type, .topic = cli::Topic::report});
  };
  file(report.json, "--json", "file to write {machine, command, date, rows} to", "json");
  file(report.csv, "--csv", "file to write the rows to, as in bench/results", "csv");
}

std::string words_typed(const cli::Program& program) {
  std::string text = program.about().name;
  for (const std::string& word : program.words()) text += " " + word;
  return text;
}

}  // namespace scarp::bench
