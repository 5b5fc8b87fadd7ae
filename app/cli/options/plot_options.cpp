// SPDX-License-Identifier: MIT
#include "app/cli/options/plot_options.h"

#include <fmt/format.h>

#include <utility>

#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {

bool is_figure(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".svg" || extension == ".pdf" || extension == ".png";
}

void require_table_or_figure(const std::string& output, const std::string& with) {
  if (!output.empty() && extension_of(output) != ".csv" && !is_figure(output))
    throw Error(fmt::format("output '{}': expected .csv, .svg, .pdf or .png{}", output, with));
#ifndef SCARP_CAIRO
  if (is_figure(output)) throw Error(fmt::format("output '{}': this build draws no figures (SCARP_CAIRO=OFF)", output));
#endif
}

Rule needs_figure(const std::string& output) {
  return needs("a .svg, .pdf or .png output", [&output] { return is_figure(output); });
}

void add_plot_size_option(Command& command, std::string& size, const std::string& fallback, Rule rule) {
  command.add(&size, {.names = "--size",
                      .value = "WxH",
                      .help = "size of the figure in pixels",
                      .fallback = fallback,
                      .common = true,
                      .rules = {std::move(rule)}});
}

std::array<int, 2> plot_size(const std::string& size, int width, int height) {
  if (size.empty()) return {width, height};
  return pixels_from(size, "--size", "1200x480", {.least = 200, .most = 8192});
}

}  // namespace scarp::cli
