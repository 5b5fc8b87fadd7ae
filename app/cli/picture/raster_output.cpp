// SPDX-License-Identifier: MIT
#include "app/cli/picture/raster_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/part_number.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/picture/map_preview.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/map_vectors.h"

namespace scarp::cli {

namespace {

constexpr const char* kPolygons = "polygons";

}  // namespace

void add_format_options(Command& command, FormatOptions& options, const std::vector<std::string>& excludes,
                        bool common) {
  command.add(&options.driver, {.names = "--of",
                                .value = "FORMAT",
                                .help = "GDAL's short name of the output format",
                                .choices = {"GTiff", "COG"},
                                .note = "any raster format of gdalinfo --formats that can be written",
                                .fallback = "by the extension",
                                .common = common,
                                .excludes = excludes});
  command.add(&options.creation, {.names = "--co",
                                  .value = "NAME=VALUE",
                                  .help = "creation option of the format",
                                  .note = "repeatable",
                                  .repeats = true,
                                  .fallback = "GTiff: tiled, DEFLATE",
                                  .common = common,
                                  .excludes = excludes});
}

void add_dry_run_option(Command& command, bool& dry_run, const std::vector<std::string>& excludes, bool common) {
  command.add(&dry_run, {.names = "--dry-run",
                         .help = "print size and estimated cost, and write nothing",
                         .common = common,
                         .excludes = excludes});
}

void add_raster_output_options(Command& command, RasterOutput& options, const std::vector<std::string>& excludes) {
  add_format_options(command, options, excludes);
  command.add(&options.part, {.names = "--part",
                              .value = "I/N",
                              .help = "part I of N of the output, as a separate raster (scarp merge joins them)",
                              .note = "rows from north to south; auto, auto/N: of a job array",
                              .fallback = "all",
                              .common = true,
                              .excludes = excludes});
  command.add(&options.resume, {.names = "--resume",
                                .help = "keep finished rows in OUTPUT.resume, and go on if the file exists",
                                .excludes = excludes});
  command.add(&options.preview, {.names = "--preview",
                                 .value = "FILE",
                                 .help = "picture of the first band over the shaded model, with a legend",
                                 .files = "png jpg pdf",
                                 .writes = true,
                                 .fallback = "none",
                                 .common = true,
                                 .excludes = excludes});
  add_draw_options(command, options.draw, Topic::general,
                   needs("--preview FILE", [&options] { return !options.preview.empty(); }), excludes);
  add_dry_run_option(command, options.dry_run, excludes);
  add_quiet_option(command, options.quiet, excludes);
}

void settle_output(RasterOutput& options, const MapOptions& map, std::string_view sample_type) {
  const std::string vectors = options.driver.empty() ? vector_driver_of(map.output) : "";
  if (!vectors.empty() && sample_type != "Float32") {
    if (!options.creation.empty())
      throw Error(fmt::format("--co: applies to rasters, and '{}' holds polygons", map.output));
    options.driver = kPolygons;
  } else {
    if (!vectors.empty() && vectors != "GPKG")
      throw Error(fmt::format("output '{}': polygons are for codes and counts (name it *.tif)", map.output));
    if (options.driver.empty()) options.driver = raster_driver_of(map.output);
    require_raster_driver(options.driver, options.creation, sample_type);
  }
  if (is_automatic_part(options.part)) options.part = part_of_job_array(options.part);
  keep_inputs(map.output, map.typed);
  // Only a check: formats choose their own temporary files.
  if (!options.dry_run) const ReplaceFile writable(map.output);
  if (options.preview.empty()) return;
  preview_format_of(options.preview);
  keep_apart("--preview", options.preview, map.output, map.typed);
}

std::optional<MapPlace> map_place(const Georeference& georeference) {
  if (!georeference.present) return std::nullopt;
  // GDAL's transform refers to pixel corners; nodes are at pixel centres.
  auto m = georeference.map_from_node;
  m[0] -= 0.5 * (m[1] + m[2]);
  m[3] -= 0.5 * (m[4] + m[5]);
  return MapPlace{m, georeference.crs_wkt};
}

void write_map(const RasterOutput& options, const std::string& output, const RasterMap& map) {
  const Progress progress = terminal_progress("write");
  options.driver == kPolygons ? write_map_polygons(output, map, progress) : write_raster_map(output, map, progress);
}

MapArea map_area(const MapInput& input, const RasterOutput& options, const RasterWindow& whole,
                 const RasterWindow& read) {
  MapArea area{whole, whole, read, {}};
  if (!options.part.empty()) {
    const auto [part, parts] = part_from(options.part);
    if (parts > whole.rows)
      throw Error(fmt::format("--part '{}': {} has only {} rows", options.part, input.path(), whole.rows));
    const RowBand rows = row_band(whole.rows, part, parts);
    area.output.row += rows.first;
    area.output.rows = rows.rows();
  }
  const int north = std::max(area.output.row, read.row),
            south = std::min(area.output.row + area.output.rows, read.row + read.rows);
  area.computed = north < south ? RasterWindow{read.col, north, read.cols, south - north}
                                : RasterWindow{read.col, read.row, read.cols, 0};
  return area;
}

RasterMap map_of(const MapInput& input, const RasterOutput& options, const MapArea& area, const std::string& method,
                 std::vector<std::pair<std::string, std::string>> metadata) {
  const RasterWindow &output = area.output, &computed = area.computed;
  RasterMap map;
  map.cols = output.cols;
  map.rows = output.rows;
  if (computed != output)
    map.part = MapPart{computed.col - output.col, computed.row - output.row, computed.cols, computed.rows};
  map.place = map_place(input.georeference_of(output));
  map.driver = options.driver;
  map.creation_options = options.creation;
  map.metadata = std::move(metadata);
  map.metadata.insert(map.metadata.begin(),
                      {{"SCARP_VERSION", SCARP_VERSION}, {"METHOD", method}, {"SOURCE", input.path()}});
  if (const RasterWindow& whole = area.whole; whole != input.whole())
    map.metadata.emplace_back(
        "WINDOW", fmt::format("columns {} to {}, rows {} to {} of {} x {}", whole.col, whole.col + whole.cols - 1,
                              whole.row, whole.row + whole.rows - 1, input.cols(), input.rows()));
  if (!options.part.empty())
    map.metadata.emplace_back("PART", fmt::format("{}: rows {} to {} of {}", options.part, output.row,
                                                  output.row + output.rows - 1, input.rows()));
  return map;
}

double bytes_of(SampleType type) { return type == SampleType::float32 ? 4 : 2; }

double memory_of(const MapArea& area, double bytes_per_sample, double bytes_per_node) {
  const double read = static_cast<double>(area.read.cols) * area.read.rows,
               computed = static_cast<double>(area.computed.cols) * area.computed.rows;
  return read * bytes_per_sample + computed * bytes_per_node;
}

void print_dry_run(const std::string& output, const std::string& what, double memory, std::optional<double> limit,
                   std::optional<double> seconds) {
  constexpr double kMebi = 1 << 20;
  const std::string in_files =
      limit && memory > *limit ? fmt::format(" (at most {:.0f} at once, the rest in files)", *limit / kMebi) : "";
  fmt::print("{}: {}; about {:.0f} MiB of memory{}{}; nothing written (--dry-run)\n", output, what,
             std::ceil(memory / kMebi), in_files, seconds ? fmt::format(" and {:.1f} s", *seconds) : "");
}

void print_map_summary(const MapInput& input, const RasterOutput& options, const MapArea& area,
                       const std::string& output, const std::function<std::string()>& what,
                       std::chrono::steady_clock::time_point begin) {
  if (options.quiet) return;
  const std::string text = what();
  print_notes(input.notes);
  fmt::print("{}: {} x {} pixels, {}; {:.2f} s\n", output, area.output.cols, area.output.rows, text,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace scarp::cli
