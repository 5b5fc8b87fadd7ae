// SPDX-License-Identifier: MIT
// scarp-bench: Scarp and its peers on the same rays in the same run. See bench/README.md for the method.
#include <cstdio>
#include <exception>

#include "app/options/help.h"
#include "bench/commands.h"

namespace scarp::bench {
namespace {

cli::Program bench_program() {
  cli::Program program({.name = "scarp-bench",
                        .version = SCARP_VERSION,
                        .summary = "Scarp beside its peers, on the same rays in the same run.",
                        .example = "scarp-bench heights --rays small"});
  add_heights(program);
  add_survey(program);
  add_naive(program);
  add_batches(program);
  add_calls(program);
  add_tiles(program);
  add_simd(program);
  add_volumes(program);
  add_pyramid(program);
  add_maps(program);
  add_view(program);
#ifdef SCARP_BENCH_VULKAN
  add_devices(program);
  add_gpu(program);
  add_shaders(program);
#endif
  add_simt(program);
  add_leaks(program);
  add_edits(program);
  add_extents(program);
  add_voxels(program);
  add_voxel_edits(program);
  add_voxel_worlds(program);
  add_voxel_models(program);
  add_voxel_leaks(program);
  add_scenes(program);
  add_seams(program);
  add_pitches(program);
  add_sky(program);
  add_sweeps(program);
  add_frames(program);
  add_functions(program);
#ifdef SCARP_BENCH_GDAL
  add_function_leaks(program);
#endif
  add_shapes(program);
  add_pixel_match(program);
#ifdef SCARP_BENCH_C
  add_c(program);
#endif
  return program;
}

int run(int argc, char** argv) {
  constexpr int kFailed = 1, kWrongUsage = 2;
  cli::Program program = bench_program();
  if (argc < 2) {
    std::fputs(help_text(program).c_str(), stderr);
    return kWrongUsage;
  }
  try {
    program.run(argc, argv);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scarp-bench: error: %s\n", error.what());
    return dynamic_cast<const cli::WrongUsage*>(&error) ? kWrongUsage : kFailed;
  }
}

}  // namespace
}  // namespace scarp::bench

int main(int argc, char** argv) { return scarp::bench::run(argc, argv); }
