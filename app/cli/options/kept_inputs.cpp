// SPDX-License-Identifier: MIT
#include "app/cli/options/kept_inputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "scarp/base/error.h"

namespace scarp::cli {

namespace fs = std::filesystem;

void keep_inputs(const std::string& output, const std::vector<std::string>& inputs) {
  std::error_code no_file;
  if (!fs::exists(output, no_file)) return;
  for (const std::string& input : inputs) {
    if (fs::equivalent(output, input, no_file))
      throw Error(fmt::format("output '{}': is the input{} (name another file)", output,
                              input == output ? "" : fmt::format(" '{}'", input)));
  }
}

}  // namespace scarp::cli
