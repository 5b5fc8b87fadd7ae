// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "bench/commands.h"
#include "scarp/base/error.h"

namespace scarp::bench {

void run_view(const ViewOptions& options) {
  const std::string scarp = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "scarp").string();
  const std::string sizes = fmt::format("{}", fmt::join(options.sizes, ","));
  ::execlp("bash", "bash", SCARP_SOURCE_DIR "/bench/view.sh", scarp.c_str(), sizes.c_str(), options.csv.c_str(),
           nullptr);
  throw Error(fmt::format("view: bash cannot be started: {}", std::strerror(errno)));
}

}  // namespace scarp::bench
