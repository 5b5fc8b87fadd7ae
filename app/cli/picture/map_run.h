// SPDX-License-Identifier: MIT
// The course of a subcommand that computes a map, from its options to the written file:
//
//   MapRun                    checks the options and the output, and opens the raster
//   set_area() ...            optional: the pixels to write and the samples that they depend on, by default all
//   begin()                   prints the cost (--dry-run) or reads the samples
//   write()                   computes the rows, writes raster and preview, and prints the summary
//
// The subcommand describes the map as a function of a band of rows (MapRecipe::compute), and write() calls it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/options/memory_options.h"
#include "app/cli/picture/drawn_shapes.h"
#include "app/cli/picture/raster_output.h"
#include "app/cli/progress.h"
#include "scarp/analysis/map_part.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress.h"
#include "scarp/output/raster_map.h"

namespace scarp::cli {

class MapJournal;
struct JournalStrip;

/// Options of a subcommand that computes a map.
struct MapCommand : MapOptions {
  RasterOutput raster_output;
  MemoryOptions memory;
};

/// Declares the options of every map, and the function that the subcommand runs after their effect was checked.
/// `excludes`: options with which the output is not a map.
void add_map_command(Command& command, MapCommand& options, std::function<void()> run,
                     const std::vector<std::string>& excludes = {});

/// A band with its pixels, rows from north to south.
struct ComputedBand {
  std::string name;  ///< band description
  std::string unit;  ///< "m"; empty: none
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> pixels;
  double nodata = 0;
  std::vector<MapClass> classes{};  ///< of Byte bands; empty: none
  double scale = 1, offset = 0;     ///< as MapBand
};

/// Nodata of bands of numbers.
inline constexpr double kNoNumber = -9999;
/// Returns a band of numbers, in which nodata replaces NaN.
ComputedBand number_band(std::string name, std::string unit, std::vector<float> pixels, double nodata = kNoNumber);

/// A map, when its samples have been read.
struct MapRecipe {
  std::string method;
  Metadata metadata;
  std::string ramp;  ///< colours of the preview
  /// Returns the bands of some rows of the samples that were read: the same bands for any rows, with those of the
  /// whole map, bit by bit. The rows may be none. Finds the field by MapInput, which may hold other samples in the next
  /// call.
  std::function<std::vector<ComputedBand>(const RowBand& rows, const Progress& progress)> compute;
  /// Returns the result in words, over all rows computed. Not called with --quiet.
  std::function<std::string()> summary;
  /// Numbers of the summary that compute() updates, which --resume keeps.
  std::vector<double*> totals{};
  /// Whether strips of rows take together about as long as all rows at once. If a map is beyond the limit of memory, it
  /// is then computed by strips, which use it place by place.
  bool has_cheap_strips = false;
  int rows_of_strip = 1;  ///< least, of these
  /// A file for each band, in place of the output; empty: all bands are in the output.
  std::vector<std::string> files{};
  std::vector<DrawnMark> marks{};  ///< on the preview, in columns and rows of the raster
  /// All that the pixels depend on besides the raster and the typed words, for map_identity().
  std::vector<std::string> inputs{};
  /// Writes other outputs, after the map: --resume keeps the rows until then. Throws Error.
  std::function<void()> write_more{};
};

class MapRun {
 public:
  /// Throws Error for an output that is an input or cannot be written, with samples of this type ("Float32"), and for
  /// an input that is not a raster. `options` and `command` must outlive the run.
  MapRun(MapCommand& options, const Command& command, std::string_view sample_type);

  MapInput& input() { return input_; }

  /// The output covers `whole`, or its --part, and depends on the samples of `read`; pixels outside of `read` are
  /// nodata.
  void set_area(const RasterWindow& whole, const RasterWindow& read);

  /// A --part depends only on these rows of the raster, as a function of its own. After set_area().
  void set_rows(const std::function<RowBand(const RowBand& output)>& rows);

  /// For horizons: the output depends on its rows and on ground up to `metres` away, which may be infinite.
  void set_reach(double metres);

  /// Reads the samples. With --dry-run, prints size, memory and time instead, and returns false.
  /// `more_bytes`: per sample that is read, of other rasters.
  bool begin(double bytes_per_pixel, double seconds_per_pixel, double more_bytes = 0);

  /// Bytes for what the map is computed from besides the samples. After begin().
  double working_memory() const;

  /// The rows of the samples that were read which write() computes.
  RowBand rows() const { return area_.rows(); }

  /// Computes and writes the map. Throws Error naming the file; Interrupted.
  void write(const MapRecipe& recipe);

 private:
  std::vector<ComputedBand> compute(const MapRecipe& recipe, std::optional<MapJournal>& journal);
  int strips_of(const MapRecipe& recipe) const;
  std::vector<JournalStrip> finished_strips(const MapRecipe& recipe, MapJournal& journal);
  std::vector<ComputedBand> finished_bands(const MapRecipe& recipe, const std::vector<JournalStrip>& done);
  std::string identity(const MapRecipe& recipe) const;

  MapCommand& options_;
  const Command& command_;
  ThreadLimit threads_;
  std::unique_ptr<MemoryLimit> memory_;
  std::optional<SilentProgress> silence_;  // with --quiet
  std::chrono::steady_clock::time_point start_;
  MapInput input_;
  MapArea area_;
  double needed_ = 0;  // bytes
};

}  // namespace scarp::cli
