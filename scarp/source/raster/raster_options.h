// SPDX-License-Identifier: MIT
// Reading options: properties that a raster file does not state, or states wrongly. One struct for all readers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "scarp/source/raster/raw_format.h"
#include "scarp/source/raster/terrain_rgb.h"

namespace scarp {

/// A rectangle of samples, in columns and rows of the file as stored.
struct RasterWindow {
  int col = 0;   ///< >= 0
  int row = 0;   ///< >= 0
  int cols = 0;  ///< >= 1
  int rows = 0;  ///< >= 1

  bool operator==(const RasterWindow&) const = default;
};

/// Outer edges of a raster (of its pixels, not its samples), in units of its CRS.
struct MapBounds {
  double west = 0;
  double south = 0;
  double east = 0;   ///< > west
  double north = 0;  ///< > south

  bool operator==(const MapBounds&) const = default;
};

/// Heights of the smallest and the largest sample value.
struct HeightRange {
  double low = 0;
  double high = 1;  ///< > low

  bool operator==(const HeightRange&) const = default;
};

/// Value of RasterOptions::crs that discards the file's CRS: map units are then metres.
inline constexpr std::string_view kNoCrs = "none";

/// Reduces rasters with more than `above` samples to at most about `samples` samples, for pictures (decimate.h).
struct Decimation {
  std::int64_t above = 64'000'000;    ///< > 0
  std::int64_t samples = 16'000'000;  ///< at least 4, at most `above`

  bool operator==(const Decimation&) const = default;
};

/// How to read a raster. Members that are set override the file.
struct RasterOptions {
  int band = 0;                        ///< counts from 1; 0: the only one
  std::optional<RasterWindow> window;  ///< must lie inside the raster; default: everything
  std::optional<double> nodata;        ///< sample value of a hole, any double; NaN: only NaN is a hole
  std::optional<double> scale;   ///< height = sample * scale + offset, in `unit`; finite, not 0; default: the file's
  std::optional<double> offset;  ///< in `unit`; finite; default: the file's
  /// Replaces scale and offset, in `unit`: heights of 0 and of the largest value of an unsigned sample type (65535 for
  /// UInt16), or of 0 and 1 for float samples. Not for signed samples.
  std::optional<HeightRange> height_range;
  std::string unit;  ///< vertical unit: "m", "ft", "us-ft", ...; default: the file's, else metres
  /// Any text that GDAL accepts ("EPSG:4326", WKT, PROJ), or kNoCrs; default: the file's, else EPSG:4326 if all bounds
  /// fit degrees, else none.
  std::string crs;
  std::optional<MapBounds> bounds;  ///< of the whole file, before `window`; default: the file's geotransform
  HeightEncoding encoding = HeightEncoding::none;  ///< of heights in the colours of 3 or 4 Byte bands
  std::optional<RawFormat> raw;          ///< headerless samples, regardless of the name; default: by name and content
  std::string channel;                   ///< channel of an EXR; default: the only one, else Y, else R
  std::string key;                       ///< array in a .npz; default: the only one with heights
  std::optional<Decimation> decimation;  ///< default: all samples
  /// Bytes of memory that may be used at once, if operator new returns other memory for arrays beyond them. Rasters are
  /// then not refused for their size, but for blocks that take more than a quarter of it.
  std::optional<double> memory;

  bool operator==(const RasterOptions&) const = default;
};

}  // namespace scarp
