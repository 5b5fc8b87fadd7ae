// SPDX-License-Identifier: MIT
#include "app/cli/options/kept_inputs.h"

#include <fmt/format.h>

#include <algorithm>
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

void keep_apart(std::string_view option, const std::string& file, const std::string& output,
                std::vector<std::string> typed) {
  if (file.empty()) return;
  std::error_code no_file;
  const auto place = [&](const std::string& name) { return fs::weakly_canonical(fs::absolute(name), no_file); };
  if (!output.empty() && (place(file) == place(output) || fs::equivalent(file, output, no_file)))
    throw Error(fmt::format("{} '{}': is the output (name another file)", option, file));
  if (const auto own = std::find(typed.begin(), typed.end(), file); own != typed.end()) typed.erase(own);
  keep_inputs(file, typed);
}

}  // namespace scarp::cli
