// SPDX-License-Identifier: MIT
#include "app/cli/options/memory_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

// Bytes of "512M", "1.5G", "2 GiB"; 0: not a size.
double size_from(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !(number > 0)) return 0;
  std::string unit(end, text.data() + text.size());
  std::erase(unit, ' ');
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::toupper(c); });
  constexpr std::string_view kUnits = "KMGT";
  if (unit.empty() || kUnits.find(unit[0]) == std::string_view::npos) return 0;
  if (const std::string rest = unit.substr(1); !rest.empty() && rest != "B" && rest != "IB") return 0;
  for (std::size_t i = 0; i <= kUnits.find(unit[0]); ++i) number *= 1024;
  return number;
}

}  // namespace

void add_memory_options(Command& command, MemoryOptions& options, const std::vector<std::string>& excludes) {
  command.add(&options.limit, {.names = "--memory",
                               .value = "SIZE",
                               .help = "maximum memory, for example 512M or 8G; arrays beyond it are kept in files",
                               .note = "at least 256M",
                               .fallback = "half of the machine's",
                               .excludes = excludes});
  command.add(&options.scratch, {.names = "--scratch",
                                 .value = "DIR",
                                 .help = "folder for arrays beyond --memory, on a disk with room for them",
                                 .fallback = "the folder of the output",
                                 .excludes = excludes});
}

std::unique_ptr<MemoryLimit> limit_memory(const MemoryOptions& options, const std::string& output) {
  double bytes = machine_memory() / 2;
  if (!options.limit.empty()) {
    bytes = size_from(options.limit);
    if (bytes == 0) throw Error(fmt::format("--memory '{}': expected a size, for example 512M or 8G", options.limit));
    if (bytes < MemoryLimit::kLeast)
      throw Error(fmt::format("--memory {}: is too little for the program and one row of blocks (at least {:.0f}M)",
                              options.limit, MemoryLimit::kLeast / (1 << 20)));
  }
  const std::string folder =
      options.scratch.empty() ? std::filesystem::path(output).parent_path().string() : options.scratch;
  if (!options.scratch.empty() && !std::filesystem::is_directory(folder))
    throw Error(fmt::format("--scratch '{}': is not a folder", folder));
  return std::make_unique<MemoryLimit>(std::max(bytes, MemoryLimit::kLeast), folder);
}

}  // namespace scarp::cli
