// SPDX-License-Identifier: MIT
// Private to the station: a map as a dataset of GDAL.
#pragma once

#include <gdal_priv.h>

#include <string>

#include "scarp/output/raster_map.h"

namespace scarp {

/// Returns a dataset in memory that refers to the samples of the map. `coloured`: with the colour table of its classes.
/// Throws Error naming `path` if the CRS is invalid.
GDALDatasetUniquePtr dataset_of(const RasterMap& map, const std::string& path, bool coloured);

}  // namespace scarp
