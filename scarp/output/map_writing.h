// SPDX-License-Identifier: MIT
// Private to the station: writes a dataset of GDAL as a map.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "scarp/base/progress.h"

namespace scarp {

struct MapFormat {
  std::string driver;
  std::vector<std::string> creation_options{};  ///< NAME=VALUE
  bool floats = false;                          ///< the samples
  bool classes = false;                         ///< whether samples are codes of classes
  bool sparse = false;                          ///< whether a GeoTIFF may omit tiles of nodata
  double bytes = 0;                             ///< of all samples, for messages
};

/// Writes `source` to `path`, completely or not at all. Throws as write_raster_map().
void write_dataset(const std::string& path, GDALDataset& source, const MapFormat& format, const Progress& progress);

}  // namespace scarp
