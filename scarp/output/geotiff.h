// SPDX-License-Identifier: MIT
// Writes maps as GeoTIFF. Requires a build with GDAL (SCARP_GDAL).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scarp/base/replace_file.h"
#include "scarp/output/rgb_view.h"

namespace scarp {

/// Georeference of a map.
struct MapPlace {
  /// Map coordinates of the upper left corner of a pixel, in CRS units: x = m[0] + col*m[1] + row*m[2],
  /// y = m[3] + col*m[4] + row*m[5].
  std::array<double, 6> map_from_pixel{0, 1, 0, 0, 0, -1};
  std::string crs_wkt{};  ///< empty: none
};

/// Writes red, green, blue and opacity (not multiplied into the colours), 8 bits each, with lossless DEFLATE
/// compression, in tiles if a side is longer than 512 pixels. `alpha`: a byte per pixel; empty: all are opaque.
/// `place`: nullopt for a TIFF without georeference. Writes to the temporary file of `file`, and commits it; `path` is
/// only used in messages. Throws Error if the CRS is invalid or writing fails (disk full); then no file remains once
/// `file` is destroyed.
void write_geotiff(ReplaceFile& file, const std::string& path, const RgbView& picture,
                   std::span<const std::uint8_t> alpha, const std::optional<MapPlace>& place);

}  // namespace scarp
