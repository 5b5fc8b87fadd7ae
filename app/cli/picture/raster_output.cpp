// SPDX-License-Identifier: MIT
#include "app/cli/picture/raster_output.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/picture/map_preview.h"
#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"

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
  command.add(&options.part, {.names = "--part",
                              .value = "I/N",
                              .help = "part I of N of the output, as a separate raster",
                              .note = "bands of rows, from north to south",
                              .fallback = "all",
                              .common = true});
  command.add(&options.preview, {.names = "--preview",
                                 .value = "FILE",
                                 .help = "picture of the first band over the shaded model, with a legend",
                                 .files = "png jpg pdf",
                                 .fallback = "none",
                                 .common = true});
  command.add(&options.dry_run,
              {.names = "--dry-run", .help = "print size, memory and time, and write nothing", .common = true});
  command.add(&options.quiet, {.names = "--quiet", .help = "no summary", .common = true});
}

void settle_output(RasterOutput& options, const MapOptions& map) {
  if (options.driver.empty()) options.driver = raster_driver_of(map.output);
  require_raster_driver(options.driver, options.creation);
  keep_inputs(map.output, map.typed);
  // Only a check: formats choose their own temporary files.
  if (!options.dry_run) const ReplaceFile writable(map.output);
  if (options.preview.empty()) return;
  preview_format_of(options.preview);
  if (std::filesystem::path(options.preview).lexically_normal() == std::filesystem::path(map.output).lexically_normal())
    throw Error(fmt::format("--preview '{}': is the output (name another file)", options.preview));
  std::vector<std::string> others = map.typed;
  std::erase(others, options.preview);
  keep_inputs(options.preview, others);
}

RowBand rows_of_part(const MapInput& input, const RasterOutput& options) {
  const int rows = input.field().rows();
  if (options.part.empty()) return {0, rows};
  constexpr std::string_view kForm = "I/N, whole numbers with 1 <= I <= N, for example 3/16";
  const auto n = numbers_from(options.part, '/', 2, 2, "--part", kForm);
  if (!(n[0] >= 1 && n[0] <= n[1] && n[0] == std::floor(n[0]) && n[1] == std::floor(n[1])))
    throw Error(fmt::format("--part '{}': expected {}", options.part, kForm));
  if (n[1] > rows) throw Error(fmt::format("--part '{}': {} has only {} rows", options.part, input.path(), rows));
  return row_band(rows, static_cast<int>(n[0]), static_cast<int>(n[1]));
}

RasterMap map_of(const MapInput& input, const RasterOutput& options, const RowBand& rows, const std::string& method,
                 std::vector<std::pair<std::string, std::string>> metadata) {
  RasterMap map;
  map.cols = input.field().cols();
  map.rows = rows.rows();
  const Georeference& geo = input.georeference();
  if (geo.present) {
    // GDAL's transform refers to pixel corners; nodes are at pixel centres.
    auto m = geo.map_from_node;
    const double north = rows.first - 0.5;
    m[0] += -0.5 * m[1] + north * m[2];
    m[3] += -0.5 * m[4] + north * m[5];
    map.place = MapPlace{m, geo.crs_wkt};
  }
  map.driver = options.driver;
  map.creation_options = options.creation;
  map.metadata = std::move(metadata);
  map.metadata.insert(map.metadata.begin(),
                      {{"SCARP_VERSION", SCARP_VERSION}, {"METHOD", method}, {"SOURCE", input.path()}});
  if (!options.part.empty())
    map.metadata.emplace_back(
        "PART", fmt::format("{}: rows {} to {} of {}", options.part, rows.first, rows.last - 1, input.field().rows()));
  return map;
}

void print_dry_run(const MapInput& input, const RowBand& rows, const std::string& output, double bytes_per_node,
                   double seconds) {
  const double cols = input.field().cols(), all = cols * input.field().rows(), nodes = cols * rows.rows();
  const double samples = input.field().sample_type() == SampleType::float32 ? 4 : 2;
  constexpr double kMebi = 1 << 20;
  fmt::print("{}: {} x {} pixels; about {:.0f} MiB of memory and {:.1f} s; nothing written (--dry-run)\n", output,
             input.field().cols(), rows.rows(), std::ceil((all * samples + nodes * bytes_per_node) / kMebi), seconds);
}

void print_map_summary(const MapInput& input, const RasterOutput& options, const RowBand& rows,
                       const std::string& output, const std::string& what,
                       std::chrono::steady_clock::time_point begin) {
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
  if (options.quiet) return;
  fmt::print("{}: {} x {} pixels, {}; {:.2f} s\n", output, input.field().cols(), rows.rows(), what,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace scarp::cli
