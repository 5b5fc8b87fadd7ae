// SPDX-License-Identifier: MIT
// The subcommands of `scarp`. Each declares itself and its options; it throws scarp::Error when it fails.
#pragma once

#include "app/options/command.h"

namespace scarp::cli {

void add_render(Program& program);
void add_cast(Program& program);
void add_composite(Program& program);
void add_contours(Program& program);
void add_horizon(Program& program);
void add_info(Program& program);
void add_los(Program& program);
void add_generate(Program& program);
void add_marches(Program& program);
void add_merge(Program& program);
void add_profile(Program& program);
void add_replay(Program& program);
void add_section(Program& program);
void add_shadow(Program& program);
void add_skyview(Program& program);
void add_sunhours(Program& program);  // with SCARP_ERFA
void add_view(Program& program);      // with SCARP_VIEWER
void add_viewshed(Program& program);
void add_voxelise(Program& program);
void add_devices(Program& program);  // with SCARP_VULKAN

void add_options(Program& program);  // hidden: writes the documents generated from the declarations

ProgramAbout about_scarp();
/// The program with all of these subcommands.
Program scarp_program();

}  // namespace scarp::cli
