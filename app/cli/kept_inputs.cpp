// SPDX-License-Identifier: MIT
#include "app/cli/kept_inputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "scarp/base/error.h"

namespace scarp::cli {

namespace fs = std::filesystem;

std::vector<std::string> typed_values(const CLI::App& command) {
  std::vector<std::string> values;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name() == "--output") continue;
    // "-" of --rays is what stands before the program in a shell: scarp cast --rays - < FILE.
    for (const std::string& value : option->results()) values.push_back(value == "-" ? "/dev/stdin" : value);
  }
  return values;
}

void keep_inputs(const std::string& output, const std::vector<std::string>& inputs) {
  std::error_code no_file;
  if (!fs::exists(output, no_file)) return;
  for (const std::string& input : inputs) {
    if (fs::equivalent(output, input, no_file))
      throw Error(fmt::format("output '{}': is the input{}; name another file", output,
                              input == output ? "" : fmt::format(" '{}'", input)));
  }
}

}  // namespace scarp::cli
