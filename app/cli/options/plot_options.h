// SPDX-License-Identifier: MIT
// Outputs that are a table or a figure, by the extension, and the size of figures.
#pragma once

#include <array>
#include <string>

#include "app/options/command.h"

namespace scarp::cli {

/// Whether the output is a figure, by its extension.
bool is_figure(const std::string& output);

/// Throws Error unless the output is empty (standard output), a .csv table, or a figure that this build can draw.
/// `with`: continues the message, " with --at".
void require_table_or_figure(const std::string& output, const std::string& with = {});

/// The rule of options for figures. `output` must outlive the command.
Rule needs_figure(const std::string& output);

/// Declares --size. `fallback`: the default in words.
void add_plot_size_option(Command& command, std::string& size, const std::string& fallback, Rule rule);

/// Width and height of --size; without it `width` and `height`. Throws Error.
std::array<int, 2> plot_size(const std::string& size, int width, int height);

}  // namespace scarp::cli
