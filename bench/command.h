// SPDX-License-Identifier: MIT
// Shared by the commands of scarp-bench: a command, its options and those of the report.
#pragma once

#include <memory>
#include <string>

#include "app/options/command.h"
#include "bench/report.h"

namespace scarp::bench {

/// Adds --json and --csv.
void add_report_options(cli::Command& command, ReportOptions& report);
/// "scarp-bench seams --rays 1e9", as typed.
std::string words_typed(const cli::Program& program);

/// A command and the options that its declarations are bound to.
template <class Options>
struct Declaring {
  cli::Command& command;
  Options& options;
};

/// Declares a command that calls run(options, report). The options of the report are added here.
template <class Options, class Run>
Declaring<Options> add_command(cli::Program& program, const char* name, const char* summary, Run run) {
  cli::Command& command = program.add(name, summary);
  const auto options = std::make_shared<Options>();
  const auto report = std::make_shared<ReportOptions>();
  add_report_options(command, *report);
  command.runs([&program, &command, options, report, run] {
    command.require_effect({});
    report->command = words_typed(program);
    run(*options, *report);
  });
  return {command, *options};
}

}  // namespace scarp::bench
