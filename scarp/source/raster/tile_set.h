// SPDX-License-Identifier: MIT
// Several files as one dataset: an in-memory GDAL virtual raster, read tile by tile.
//
// Tiles must have the same CRS, cell size, type, nodata value, scale and vertical unit, and be whole cells apart;
// nothing is resampled. Where they overlap, the later one wins, except for its holes. Uncovered samples are holes,
// marked by the tiles' nodata value; tiles without one become floating-point, with NaN in the gaps: any value of their
// own type might be a height, which only a scan of all samples could rule out.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Returns whether `path` is a folder of files, and not a GDAL raster stored as a folder.
bool is_tile_folder(const std::string& path);

/// Returns the rasters in a folder, by name, without subfolders. Unless the options declare an encoding, it skips
/// pictures (files with colours but no georeference), so that an image rendered from a folder into the same folder does
/// not become a tile. Notes list what was skipped. Throws Error "folder: ..." if none remain.
std::vector<std::string> rasters_in(const std::string& folder, const RasterOptions& options,
                                    std::vector<std::string>& notes);

struct TileSet {
  GDALDatasetUniquePtr dataset;
  GDALDataType type = GDT_Unknown;  ///< sample type of the files; the dataset's type may be wider
};

/// Opens one dataset over all files (at least one); its only band (with an encoding, its bands) is the one that the
/// options select. Notes state the number of tiles and the extent of gaps. Throws Error "file: ..." if a file cannot be
/// opened or does not match the first.
TileSet open_tile_set(const std::vector<std::string>& files, const RasterOptions& options, const GdalSession& session,
                      std::vector<std::string>& notes);

}  // namespace scarp
