// SPDX-License-Identifier: MIT
// The commands of scarp-bench. Each declares itself and its options; it throws Error when it fails.
#pragma once

#include "app/options/command.h"

namespace scarp::bench {

void add_heights(cli::Program& program);
void add_survey(cli::Program& program);
void add_naive(cli::Program& program);
void add_batches(cli::Program& program);
void add_calls(cli::Program& program);
void add_tiles(cli::Program& program);
void add_simd(cli::Program& program);
void add_volumes(cli::Program& program);
void add_pyramid(cli::Program& program);
void add_maps(cli::Program& program);
void add_view(cli::Program& program);
void add_devices(cli::Program& program);  // with SCARP_VULKAN
void add_gpu(cli::Program& program);      // with SCARP_VULKAN
void add_shaders(cli::Program& program);  // with SCARP_VULKAN
void add_simt(cli::Program& program);
void add_leaks(cli::Program& program);
void add_edits(cli::Program& program);
void add_extents(cli::Program& program);
void add_voxels(cli::Program& program);
void add_voxel_edits(cli::Program& program);
void add_voxel_worlds(cli::Program& program);
void add_voxel_models(cli::Program& program);
void add_voxel_leaks(cli::Program& program);
void add_scenes(cli::Program& program);
void add_seams(cli::Program& program);
void add_pitches(cli::Program& program);
void add_sky(cli::Program& program);
void add_sweeps(cli::Program& program);
void add_frames(cli::Program& program);
void add_functions(cli::Program& program);
void add_function_leaks(cli::Program& program);  // with SCARP_GDAL
void add_shapes(cli::Program& program);
void add_pixel_match(cli::Program& program);
void add_c(cli::Program& program);  // with SCARP_C

}  // namespace scarp::bench
