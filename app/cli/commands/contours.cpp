// SPDX-License-Identifier: MIT
// `scarp contours`: contour lines of an elevation model as a vector file.
#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_input.h"
#include "app/cli/options/raster_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/picture/raster_output.h"
#include "app/cli/progress.h"
#include "app/options/numbers.h"
#include "scarp/analysis/sight.h"
#include "scarp/base/error.h"
#include "scarp/output/map_vectors.h"

namespace scarp::cli {
namespace {

constexpr std::size_t kMostLevels = 10000;
constexpr float kHole = -std::numeric_limits<float>::max();

struct ContourOptions : MapOptions {
  std::optional<double> interval;
  double base = 0;
  std::string levels;
  bool dry_run = false, quiet = false;
};

ContourLevels levels_of(const ContourOptions& options) {
  if (options.levels.empty() && !options.interval)
    throw WrongUsage("--interval M or --levels M,M,... is required (see 'scarp contours --help')");
  ContourLevels levels{options.interval, options.base, {}};
  if (!options.levels.empty())
    levels.levels =
        ground_numbers_from(options.levels, 1, kMostLevels, "--levels", "heights in metres, for example 100,250");
  return levels;
}

// Heights in metres, row by row from north to south.
std::vector<float> heights_of(const HeightField& field) {
  const SightGround ground(field);
  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows()));
  for (int row = 0; row < field.rows(); ++row) {
    for (int col = 0; col < field.cols(); ++col) {
      const auto height = ground.height({col, row});
      heights.push_back(height ? static_cast<float>(*height) : kHole);
    }
  }
  return heights;
}

void run(const ContourOptions& options, const Command& command) {
  command.require_effect({});
  const auto silence = options.quiet ? std::make_optional<SilentProgress>() : std::nullopt;
  const ContourLevels levels = levels_of(options);
  if (vector_driver_of(options.output).empty())
    throw Error(fmt::format("output '{}': expected .gpkg, .geojson, .shp or .fgb", options.output));
  keep_inputs(options.output, options.typed);
  const auto begin = std::chrono::steady_clock::now();
  MapInput input(options);
  keep_inputs(options.output, input.files());
  if (options.dry_run) {
    // Samples, and the heights in metres.
    const double bytes = bytes_of(input.sample_type()) + sizeof(float);
    print_dry_run(options.output, fmt::format("contour lines of {} x {} samples", input.cols(), input.rows()),
                  bytes * input.cols() * static_cast<double>(input.rows()), {}, {});
    return;
  }
  input.read(input.whole(), terminal_progress("read"));
  input.close();
  const double relief = input.field().max_height() - input.field().min_height();
  if (levels.interval && relief / *levels.interval > static_cast<double>(kMostLevels))
    throw Error(fmt::format("--interval {:.10g}: more than {} lines over {:.6g} m of relief", *levels.interval,
                            kMostLevels, relief));
  const std::vector<float> heights = heights_of(input.field());
  RasterMap map;
  map.cols = input.cols();
  map.rows = input.rows();
  map.place = map_place(input.georeference());
  map.bands.push_back({"height", "m", std::span<const float>(heights), static_cast<double>(kHole), {}});
  write_contours(options.output, map, levels, terminal_progress("contours"));
  if (options.quiet) return;
  print_notes(input.notes);
  fmt::print("{}: contour lines of {} x {} samples; {:.2f} s\n", options.output, map.cols, map.rows,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace

void add_contours(Program& program) {
  Command& command = program.add("contours", "Write contour lines of an elevation model as a vector file");
  const auto options = std::make_shared<ContourOptions>();
  ContourOptions& o = *options;
  add_raster_inputs(command, o.inputs, "elevation model: anything GDAL reads, .npy, .npz, .exr");
  add_output_option(command, o.output, "vector file to write", "gpkg geojson shp fgb");
  command.add(&o.interval, {.names = "--interval",
                            .help = "height between lines",
                            .unit = "metres",
                            .range = kAboveZero,
                            .fallback = "none",
                            .common = true});
  command.add(&o.base, {.names = "--base",
                        .help = "height from which the interval counts",
                        .unit = "metres",
                        .range = {-kMostOfGround, kMostOfGround},
                        .common = true,
                        .rules = {needs("--interval M", [&o] { return o.interval.has_value(); })}});
  command.add(&o.levels, {.names = "--levels",
                          .value = "M,M,...",
                          .help = "heights of the lines in metres",
                          .fallback = "multiples of --interval",
                          .common = true,
                          .excludes = {"--interval"}});
  add_dry_run_option(command, o.dry_run, {}, true);
  add_quiet_option(command, o.quiet, {}, true);
  add_raster_options(command, o.raster);
  command.example("scarp contours dem.tif --interval 10 -o contours.gpkg");
  command.example("scarp contours dem.tif --levels 500,750 -o levels.geojson");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
