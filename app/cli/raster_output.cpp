// SPDX-License-Identifier: MIT
#include "app/cli/raster_output.h"

#include <fmt/format.h>

namespace scarp::cli {

void add_raster_output_options(Command& command, RasterOutput& options) {
  command.add(&options.driver, {.names = "--of",
                                .value = "FORMAT",
                                .help = "GDAL's short name of the output format",
                                .choices = {"GTiff", "COG"},
                                .note = "any raster format of gdalinfo --formats that can be written",
                                .fallback = "by the extension",
                                .common = true});
  command.add(&options.creation, {.names = "--co",
                                  .value = "NAME=VALUE",
                                  .help = "creation option of the format",
                                  .note = "repeatable",
                                  .repeats = true,
                                  .fallback = "GTiff: tiled, DEFLATE",
                                  .common = true});
  command.add(&options.dry_run,
              {.names = "--dry-run", .help = "print size, memory and time, and write nothing", .common = true});
  command.add(&options.quiet, {.names = "--quiet", .help = "no summary", .common = true});
}

void settle_driver(RasterOutput& options, const std::string& output) {
  if (options.driver.empty()) options.driver = raster_driver_of(output);
  require_raster_driver(options.driver, options.creation);
}

RasterMap map_of(const MapInput& input, const RasterOutput& options, const std::string& method,
                 std::vector<std::pair<std::string, std::string>> metadata) {
  RasterMap map;
  map.cols = input.field().cols();
  map.rows = input.field().rows();
  const Georeference& geo = input.georeference();
  if (geo.present) {
    // GDAL's transform is that of pixel corners; nodes are at pixel centres.
    auto m = geo.map_from_node;
    m[0] -= 0.5 * (m[1] + m[2]);
    m[3] -= 0.5 * (m[4] + m[5]);
    map.place = MapPlace{m, geo.crs_wkt};
  }
  map.driver = options.driver;
  map.creation_options = options.creation;
  map.metadata = std::move(metadata);
  map.metadata.insert(map.metadata.begin(),
                      {{"SCARP_VERSION", SCARP_VERSION}, {"METHOD", method}, {"SOURCE", input.path()}});
  return map;
}

void print_dry_run(const MapInput& input, const std::string& output, double bytes_per_node, double seconds) {
  const double nodes = static_cast<double>(input.field().cols()) * input.field().rows();
  const double samples = input.field().sample_type() == SampleType::float32 ? 4 : 2;
  constexpr double kMebi = 1 << 20;
  fmt::print("{}: {} x {} pixels; about {:.0f} MiB of memory and {:.1f} s; nothing written (--dry-run)\n", output,
             input.field().cols(), input.field().rows(), std::ceil(nodes * (samples + bytes_per_node) / kMebi),
             seconds);
}

void print_map_summary(const MapInput& input, const RasterOutput& options, const std::string& output,
                       const std::string& what, std::chrono::steady_clock::time_point begin) {
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
  if (options.quiet) return;
  fmt::print("{}: {} x {} pixels, {}; {:.2f} s\n", output, input.field().cols(), input.field().rows(), what,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace scarp::cli
