// SPDX-License-Identifier: MIT
// `scarp merge`: joins the parts of a map.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/picture/raster_output.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/output/raster_map.h"

namespace scarp::cli {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output;
  FormatOptions format;
  bool quiet = false;
};

void run(const MergeOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto silence = options.quiet ? std::make_optional<SilentProgress>() : std::nullopt;
  const std::string& driver = options.format.driver;
  const MergedFormat format{driver.empty() ? raster_driver_of(options.output) : driver, options.format.creation};
  require_raster_driver(format.driver, format.creation_options);
  keep_inputs(options.output, options.parts);
  merge_raster_maps(options.output, options.parts, format, terminal_progress("merge"));
  if (options.quiet) return;
  fmt::print("{}: {} parts; {:.2f} s\n", options.output, options.parts.size(),
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace

void add_merge(Program& program) {
  Command& command = program.add("merge", "Join the parts of a map that --part has written");
  const auto options = std::make_shared<MergeOptions>();
  MergeOptions& o = *options;
  command.add(&o.parts, {.names = "PART",
                         .help = "rasters that a map subcommand has written with --part I/N: all of them, in any order",
                         .files = "*",
                         .common = true,
                         .required = true});
  add_output_option(command, o.output, "raster to write", "tif tiff img asc");
  add_format_options(command, o.format, {}, true);
  add_quiet_option(command, o.quiet, {}, true);
  command.runs([options, &command] {
    command.require_effect({});
    run(*options);
  });
  command.footer(R"(The parts are compared: all must be there, and come from one command and one input, of the same
size and time. The result is the raster that the command writes without --part.)");
  command.example("scarp shadow dem.tif --sun 135,20 --part 1/2 -o north.tif");
  command.example("scarp shadow dem.tif --sun 135,20 --part 2/2 -o south.tif");
  command.example("scarp merge north.tif south.tif -o shadow.tif");
}

}  // namespace scarp::cli
