// SPDX-License-Identifier: MIT
#include "app/cli/options/shared_options.h"

#include <utility>

#include "scarp/base/file_name.h"

namespace scarp::cli {

void add_output_option(Command& command, std::string& output, const std::string& help, const std::string& files,
                       const std::string& fallback) {
  command.add(&output, {.names = "-o,--output",
                        .value = "FILE",
                        .help = help,
                        .files = files,
                        .writes = true,
                        .fallback = fallback,
                        .common = true,
                        .required = fallback.empty()});
}

void add_threads_option(Command& command, int& threads) {
  command.add(&threads, {.names = "--threads",
                         .help = "number of threads",
                         .range = {0, 1024},
                         .note = "0: all processors",
                         .common = true});
}

void add_tone_option(Command& command, Binding to, const std::string& output, Topic topic, Looks looks) {
  const Rule tones{"has no effect on .exr files, which hold linear light",
                   [&output] { return extension_of(output) != ".exr"; }};
  command.add(std::move(to), {.names = "--no-tone-curve",
                              .help = "clip bright colours instead of compressing them",
                              .topic = topic,
                              .looks = looks,
                              .rules = {tones}});
}

void add_json_option(Command& command, bool& json) {
  command.add(&json, {.names = "--json", .help = "one JSON object instead of text", .common = true});
}

void add_quiet_option(Command& command, bool& quiet, const std::vector<std::string>& excludes, bool common) {
  command.add(&quiet,
              {.names = "--quiet", .help = "no summary, notes and progress", .common = common, .excludes = excludes});
}

}  // namespace scarp::cli
