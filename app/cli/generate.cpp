// SPDX-License-Identifier: MIT
// `scarp generate`: procedural terrain of any size, or a terrain function, as a GeoTIFF.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/numbers.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/field/height_function.h"
#include "scarp/scene/file/example_functions.h"
#include "scarp/source/procedural_dem_file.h"

namespace scarp::cli {
namespace {

struct GenerateOptions {
  std::string output, size, kind = "fbm", function;
  ProceduralDem terrain;
  int threads = 0;
};

// Samples of a function about its origin; its heights are what it says, whatever the size.
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
  const auto kind = terrain_kind(options.kind);
  if (!kind) throw Error(fmt::format("--kind '{}': expected fbm or ridged", options.kind));
  terrain.kind = *kind;
  // A name that ends in .png is a slip: what is there is a picture, and no program would open the new file as one.
  const std::string extension = extension_of(options.output);
  if (!options.output.empty() && extension != ".tif" && extension != ".tiff") {
    throw Error(
        fmt::format("output '{}': terrain is written as GeoTIFF; let the name end in .tif or .tiff", options.output));
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

void add_generate(CLI::App& program) {
  CLI::App* command = program.add_subcommand("generate", "Write procedural terrain of any size as a GeoTIFF");
  const auto options = std::make_shared<GenerateOptions>();
  GenerateOptions& o = *options;
  command
      ->add_option("--size", o.size,
                   fmt::format("N or NxM samples, columns first, up to {0} x {0}", kLargestProceduralSide))
      ->required();
  command->add_option("-o,--output", o.output, "the GeoTIFF to write")->required();
  CLI::Option* function = command->add_option(
      "--function", o.function, "samples of a terrain function about (0, 0): its name, or a JSON file with one");
  command->add_option("--seed", o.terrain.seed, "which terrain; any whole number from 0")
      ->check([](const std::string& text) {
        return check_whole_number(text, std::numeric_limits<decltype(o.terrain.seed)>::max());
      })
      ->capture_default_str();
  command->add_option("--kind", o.kind, "fbm (rolling mountains) or ridged (sharp crests)")->capture_default_str();
  for (const char* option : {"--seed", "--kind"}) command->get_option(option)->excludes(function);
  command
      ->add_option("--cell", o.terrain.cell_m,
                   fmt::format("metres from sample to sample; above 0, at most {}", kLargestProceduralCell))
      ->check(number_in({.least = 0, .most = kLargestProceduralCell, .above_least = true}))
      ->capture_default_str();
  command
      ->add_option("--wavelength", o.terrain.wavelength,
                   "of the largest features, in samples, from 2 (the lesser of 1024 and half the longer side)")
      ->check(number_in({.least = 2}))
      ->excludes(function);
  command->add_option("--threads", o.threads, "threads, 0 for all")->check(CLI::Range(0, 1024))->capture_default_str();
  command->callback([options, command] {
    keep_inputs(options->output, typed_values(*command));
    run(*options);
  });
}

}  // namespace scarp::cli
