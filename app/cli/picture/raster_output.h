// SPDX-License-Identifier: MIT
// Maps as georeferenced rasters: the options, and the metadata of every file.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/options/draw_options.h"
#include "app/cli/options/map_input.h"
#include "scarp/analysis/map_part.h"
#include "scarp/output/raster_map.h"

namespace scarp::cli {

/// The format of a raster to write.
struct FormatOptions {
  std::string driver;                 ///< empty: by the extension; "polygons": a vector file
  std::vector<std::string> creation;  ///< NAME=VALUE
};

struct RasterOutput : FormatOptions {
  std::string part;     ///< I/N, or "auto" before settle_output(); empty: all
  std::string preview;  ///< picture; empty: none
  DrawOptions draw;     ///< on the preview
  bool dry_run = false, quiet = false, resume = false;
};

/// Declares --of and --co. `excludes`: options with which the output is not a raster; `common`: as Option::common.
void add_format_options(Command& command, FormatOptions& options, const std::vector<std::string>& excludes = {},
                        bool common = false);
/// Declares --dry-run.
void add_dry_run_option(Command& command, bool& dry_run, const std::vector<std::string>& excludes = {},
                        bool common = false);
/// Declares all of these, --part, --resume and --preview.
void add_raster_output_options(Command& command, RasterOutput& options, const std::vector<std::string>& excludes = {});

/// Throws Error, before hours of work, for formats and files that cannot be written, formats that cannot store samples
/// of this type ("Float32"), and for files that are inputs. Sets the driver: names of vector files select polygons, for
/// maps of codes and counts.
void settle_output(RasterOutput& options, const MapOptions& map, std::string_view sample_type);

/// The place of a raster's pixels; nullopt without a georeference.
std::optional<MapPlace> map_place(const Georeference& georeference);

/// Writes a map as settle_output() has chosen: a raster, or polygons. Throws Error naming the file; Interrupted.
void write_map(const RasterOutput& options, const std::string& output, const RasterMap& map);

/// The nodes that an output covers.
struct MapArea {
  RasterWindow whole;     ///< the output without --part
  RasterWindow output;    ///< pixels of the output, in columns and rows of the raster
  RasterWindow read;      ///< samples to read
  RasterWindow computed;  ///< pixels to compute, in both; all others are nodata; no rows if there are none

  /// The computed rows of the samples that are read.
  RowBand rows() const { return {computed.row - read.row, computed.row - read.row + computed.rows}; }
};

/// Returns the area of --part of an output that covers `whole`, or all of the raster, if `read` is read. Throws Error.
MapArea map_area(const MapInput& input, const RasterOutput& options, const RasterWindow& whole,
                 const RasterWindow& read);

/// Returns a map with the input's georeference, without bands, whose samples are those of the computed area. `method`
/// and the pairs are written to the metadata.
RasterMap map_of(const MapInput& input, const RasterOutput& options, const MapArea& area, const std::string& method,
                 std::vector<std::pair<std::string, std::string>> metadata);

/// Bytes of a sample in memory.
double bytes_of(SampleType type);
/// Estimated memory of a map in bytes: of each sample read, and of each node computed.
double memory_of(const MapArea& area, double bytes_per_sample, double bytes_per_node);

/// Prints the requirements of a run: `what` it writes, memory in bytes, of which `limit` may be used, and seconds, if
/// they are known.
void print_dry_run(const std::string& output, const std::string& what, double memory, std::optional<double> limit,
                   std::optional<double> seconds);

/// Unless quiet, prints the notes and the last line: output, size, the text of `what`, seconds.
void print_map_summary(const MapInput& input, const RasterOutput& options, const MapArea& area,
                       const std::string& output, const std::function<std::string()>& what,
                       std::chrono::steady_clock::time_point begin);

}  // namespace scarp::cli
