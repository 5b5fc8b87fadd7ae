// SPDX-License-Identifier: MIT
// Writes computed maps as rasters in any format that GDAL can write. Requires a build with GDAL (SCARP_GDAL).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/output/geotiff.h"

namespace scarp {

/// A class in a band of codes.
struct MapClass {
  int code = 0;
  std::string name;                      ///< "visible"
  std::array<std::uint8_t, 4> colour{};  ///< red, green, blue, opacity
};

/// One band, rows from north to south. The samples must outlive write_raster_map().
struct MapBand {
  std::string name;  ///< band description
  std::string unit;  ///< "m"; empty: none
  std::variant<std::span<const std::uint8_t>, std::span<const std::uint16_t>, std::span<const float>> samples;
  std::optional<double> nodata{};
  std::vector<MapClass> classes{};  ///< colour table of Byte bands; empty: none
  double scale = 1, offset = 0;     ///< the value in `unit` is sample * scale + offset; stored with the band
};

/// A rectangle of pixels of a map, in columns and rows.
struct MapPart {
  int col = 0, row = 0, cols = 0, rows = 0;
};

/// A map, and the format to write it in.
struct RasterMap {
  int cols = 0, rows = 0;
  std::vector<MapBand> bands;  ///< at least one
  /// The pixels that the bands' samples hold, inside the map, if not all. All others are nodata, which the bands must
  /// have. May have no rows.
  std::optional<MapPart> part{};
  std::optional<MapPlace> place{};
  std::vector<std::pair<std::string, std::string>> metadata{};  ///< of the dataset
  std::string driver = "GTiff";                                 ///< GDAL's short name
  std::vector<std::string> creation_options{};                  ///< NAME=VALUE; override the defaults
};

/// Throws Error without a file's name if GDAL lacks the driver, or if the driver cannot write rasters, or samples of
/// this type ("Float32"), or does not accept one of the creation options NAME=VALUE. For programs with long
/// computations before they write.
void require_raster_driver(const std::string& driver, const std::vector<std::string>& creation_options = {},
                           std::string_view sample_type = "Byte");

/// Returns the driver for a file name: GTiff for .tif, otherwise the driver for the extension. Throws Error naming the
/// file if there is none.
std::string raster_driver_of(const std::string& path);

/// The format of a merged map.
struct MergedFormat {
  std::string driver = "GTiff";                 ///< GDAL's short name
  std::vector<std::string> creation_options{};  ///< NAME=VALUE
};

/// Joins bands of rows of one map, in any order, into one raster, as if it had been written at once: the files must
/// have metadata PART "I/N: rows FIRST to LAST of ROWS", and otherwise the same metadata, bands, columns and place.
/// They may have metadata RUN, any text that is the same for all parts of a map; the result has neither. Reads a few
/// rows of a few files at a time. Throws Error naming the file: not a part, a part of another map, parts that are
/// missing or given twice; and as write_raster_map().
void merge_raster_maps(const std::string& path, const std::vector<std::string>& parts, const MergedFormat& format,
                       const Progress& progress = {});

/// Writes the map to `path`, completely or not at all, with all files that the format needs. GTiff and COG files are
/// tiled and compressed (DEFLATE) unless options say otherwise. Throws Error naming the file: an invalid option, a
/// format that cannot store the map, failed writing (disk full).
void write_raster_map(const std::string& path, const RasterMap& map, const Progress& progress = {});

}  // namespace scarp
