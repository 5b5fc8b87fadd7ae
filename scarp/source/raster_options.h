// SPDX-License-Identifier: MIT
// What the caller knows about a raster file that the file does not say, or says wrongly. One struct for all readers.
#pragma once

#include <optional>
#include <string>

#include "scarp/source/raw_format.h"
#include "scarp/source/terrain_rgb.h"

namespace scarp {

/// A rectangle of samples, in columns and rows of the file as it is stored.
struct RasterWindow {
  int col = 0;   ///< >= 0
  int row = 0;   ///< >= 0
  int cols = 0;  ///< >= 1
  int rows = 0;  ///< >= 1
};

/// The outer edges of a raster (of its pixels, not of its samples), in units of its CRS.
struct MapBounds {
  double west = 0;
  double south = 0;
  double east = 0;   ///< > west
  double north = 0;  ///< > south
};

/// The heights that the least and the greatest sample stand for.
struct HeightRange {
  double low = 0;
  double high = 1;  ///< > low
};

/// How to read a raster. Every member may stay as it is; those that are set win over the file.
struct RasterOptions {
  int band = 0;                        ///< counts from 1; 0: the only one
  std::optional<RasterWindow> window;  ///< default: all; must lie inside the raster
  std::optional<double> nodata;        ///< sample value that marks a hole, any double; NaN: only NaN is one
  std::optional<double> scale;   ///< height = sample * scale + offset, in `unit`; finite, not 0; default: the file's
  std::optional<double> offset;  ///< in `unit`; finite; default: the file's
  /// Instead of scale and offset, in `unit`: the heights of 0 and of the greatest value of an unsigned sample type
  /// (65535 of UInt16), or of 0 and 1 in float samples. Signed samples have no such range.
  std::optional<HeightRange> height_range;
  std::string unit;                 ///< vertical unit: "m", "ft", "us-ft", ...; default: the file's, else metres
  std::string crs;                  ///< anything GDAL takes: "EPSG:4326", WKT, PROJ text; default: the file's
  std::optional<MapBounds> bounds;  ///< of the whole file, before `window`; default: the file's geotransform
  HeightEncoding encoding = HeightEncoding::none;  ///< of heights in the colours of 3 or 4 Byte bands
  std::optional<RawFormat> raw;  ///< the file is bare samples, whatever its name; default: by name and content
  std::string channel;           ///< name of the channel of an EXR; default: the only one, else Y, else R
  std::string key;               ///< name of the array in a .npz; default: the only one of heights
};

}  // namespace scarp
