// SPDX-License-Identifier: MIT
// `scarp generate`: procedural terrain of any size, or a terrain function, as a GeoTIFF.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/progress.h"
#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/field/height_function.h"
#include "scarp/scene/file/example_functions.h"
#include "scarp/source/raster/procedural_dem_file.h"

namespace scarp::cli {
namespace {

struct GenerateOptions {
  std::string output, size, kind = "fbm", function;
  ProceduralDem terrain;
  int threads = 0;
};

// Samples of a function around its origin; heights do not depend on the size.
ComputedDem dem_of(const HeightFunction& function, const GenerateOptions& options) {
  const int cols = options.terrain.cols, rows = options.terrain.rows;
  const double cell = options.terrain.cell_m;
  if (0.5 * cell * std::max(cols, rows) > kFunctionReach)
    throw Error(
        fmt::format("--cell {}: {} x {} samples reach beyond 2^30 metres, where functions end", cell, cols, rows));
  return {cols, rows, cell, fmt::format("terrain function: {}", options.function),
          [&function, cols, rows, cell](int row, int count, float* out) {
            for (int r = row; r < row + count; ++r) {
              for (int c = 0; c < cols; ++c)
                *out++ =
                    static_cast<float>(function.value((c - 0.5 * (cols - 1)) * cell, (0.5 * (rows - 1) - r) * cell));
            }
          }};
}

void run(GenerateOptions options) {
  ProceduralDem& terrain = options.terrain;
  constexpr std::string_view kForm = "N or NxM samples, columns first, for example 2049 or 4097x2049";
  const auto size = numbers_from(options.size, 'x', 1, 2, "--size", kForm);
  for (const double n : size) {
    if (n != std::floor(n) || !(n >= 1 && n <= kLargestProceduralSide)) {
      throw Error(fmt::format("--size '{}': expected {}, 1 to {} each", options.size, kForm, kLargestProceduralSide));
    }
  }
  terrain.cols = static_cast<int>(size.front());
  terrain.rows = static_cast<int>(size.back());
  terrain.kind = *terrain_kind(options.kind);
  // Rejects names such as *.png: no program would open the file as a picture.
  const std::string extension = extension_of(options.output);
  if (!options.output.empty() && extension != ".tif" && extension != ".tiff") {
    throw Error(fmt::format("output '{}': terrain is written as GeoTIFF (name it *.tif or *.tiff)", options.output));
  }
  const ThreadLimit limit(options.threads);

  const auto begin = std::chrono::steady_clock::now();
  if (!options.function.empty()) {
    const HeightFunction function(read_function(options.function));
    write_computed_dem(options.output, dem_of(function, options), terminal_progress("generate"));
  } else {
    write_procedural_dem(options.output, terrain, terminal_progress("generate"));
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("{}: {} x {} samples, {}; {:.2f} s\n", options.output, terrain.cols, terrain.rows,
             options.function.empty() ? fmt::format("{}, seed {}", options.kind, terrain.seed) : options.function,
             seconds);
}

}  // namespace

void add_generate(Program& program) {
  Command& command = program.add("generate", "Write procedural terrain of any size as a GeoTIFF");
  const auto options = std::make_shared<GenerateOptions>();
  GenerateOptions& o = *options;
  command.add(&o.size, {.names = "--size",
                        .value = "N[xM]",
                        .help = "samples, columns first",
                        .note = fmt::format("up to {0} x {0}", kLargestProceduralSide),
                        .required = true});
  add_output_option(command, o.output, "GeoTIFF to write", "tif tiff");
  std::vector<std::string> functions;
  for (const ExampleFunction& example : example_functions()) functions.emplace_back(example.name);
  command.add(&o.function, {.names = "--function",
                            .value = "NAME",
                            .help = "terrain function to sample about (0, 0)",
                            .choices = std::move(functions),
                            .files = "json",
                            .note = "or a JSON file (doc/user/functions.md)"});
  command.add(&o.terrain.seed, {.names = "--seed", .help = "seed of the terrain", .excludes = {"--function"}});
  command.add(&o.kind, {.names = "--kind",
                        .value = "KIND",
                        .help = "terrain",
                        .choices = {std::string(name_of(TerrainKind::fbm)), std::string(name_of(TerrainKind::ridged))},
                        .closed = true,
                        .note = "rolling mountains or sharp crests",
                        .excludes = {"--function"}});
  command.add(&o.terrain.cell_m, {.names = "--cell",
                                  .help = "distance between samples",
                                  .unit = "metres",
                                  .range = {.least = 0, .most = kLargestProceduralCell, .above_least = true}});
  command.add(&o.terrain.feature_size, {.names = "--feature-size",
                                        .help = "size of the largest features in samples",
                                        .range = {.least = 2},
                                        .fallback = "1024, or half the longer side if that is less",
                                        .excludes = {"--function"}});
  add_threads_option(command, o.threads);
  command.example("scarp generate --size 4097 --seed 7 -o dem.tif");
  command.runs([options, &command] {
    keep_inputs(options->output, command.typed_values());
    run(*options);
  });
}

}  // namespace scarp::cli
