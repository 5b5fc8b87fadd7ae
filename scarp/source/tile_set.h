// SPDX-License-Identifier: MIT
// Several files as one dataset: GDAL's virtual raster, in memory, read tile by tile.
//
// The tiles must be of one kind: CRS, cell size, type, nodata value, scale and vertical unit the same, and whole cells
// apart; nothing is resampled. Where they overlap the later one wins, except with its holes. What no tile covers is a
// hole, marked by the tiles' nodata value; tiles that have none become floating-point, with NaN in the gaps: a value of
// their own type might be a height, which only a look at all samples could tell.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Whether this is a folder of files, and no raster of GDAL's that is stored as one.
bool is_tile_folder(const std::string& path);

/// The rasters in a folder, by name; subfolders are not searched. Pictures are left out, by which those are meant that
/// have colours and no place, unless the options call colours heights: what was rendered from a folder into it is no
/// tile of the next time. What is left out is said in notes. Throws Error "raster 'folder': ..." when there is none.
std::vector<std::string> rasters_in(const std::string& folder, const RasterOptions& options,
                                    std::vector<std::string>& notes);

struct TileSet {
  GDALDatasetUniquePtr dataset;
  GDALDataType type = GDT_Unknown;  ///< of the samples in the files; that of the dataset may be wider
};

/// One dataset of all files, of which there must be one; its only band (with an encoding, its bands) is that of the
/// options. Notes tell what was put together, and how much of it are gaps. Throws Error "raster 'file': ..." when a
/// file cannot be opened or does not go with the first.
TileSet open_tile_set(const std::vector<std::string>& files, const RasterOptions& options, const GdalSession& session,
                      std::vector<std::string>& notes);

}  // namespace scarp
