// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

// `view`: the window, measured by view.sh on a virtual display.
struct ViewOptions {
  std::vector<int> sizes{2049, 4097, 8193};
  std::string csv;  // file to write the rows to; empty: standard output
};

// Throws Error if the script cannot be started; otherwise does not return.
void run_view(const ViewOptions& options) {
  const std::string scarp = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "scarp").string();
  const std::string sizes = fmt::format("{}", fmt::join(options.sizes, ","));
  ::execlp("bash", "bash", SCARP_SOURCE_DIR "/bench/view.sh", scarp.c_str(), sizes.c_str(), options.csv.c_str(),
           nullptr);
  throw Error(fmt::format("view: bash cannot be started: {}", std::strerror(errno)));
}

}  // namespace

void add_view(cli::Program& program) {
  cli::Command& command = program.add("view", "The window on a display without a screen");
  const auto options = std::make_shared<ViewOptions>();
  add_sizes_option(command, options->sizes, "samples per side");
  command.add(
      &options->csv,
      {.names = "--csv", .value = "FILE", .help = "file to write the rows to, as in bench/results", .files = "csv"});
  command.runs([options] { run_view(*options); });
}

}  // namespace scarp::bench
