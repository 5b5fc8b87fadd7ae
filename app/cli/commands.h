// SPDX-License-Identifier: MIT
// The subcommands of `scarp`. Each adds itself, its options and its help to the program; it runs when it was called,
// and throws scarp::Error when it fails.
#pragma once

#include <CLI/CLI.hpp>

namespace scarp::cli {

void add_render(CLI::App& program);
void add_cast(CLI::App& program);
void add_composite(CLI::App& program);
void add_info(CLI::App& program);
void add_generate(CLI::App& program);
void add_marches(CLI::App& program);
void add_replay(CLI::App& program);
void add_section(CLI::App& program);
void add_voxelise(CLI::App& program);
void add_devices(CLI::App& program);  // with SCARP_VULKAN

}  // namespace scarp::cli
