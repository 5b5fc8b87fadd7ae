// SPDX-License-Identifier: MIT
#include "scarp/source/read_raster.h"

#include "scarp/source/gdal_raster.h"
#include "scarp/source/npy.h"

namespace scarp {

Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress) {
  return is_npy_path(path) ? read_npy(path, options, progress) : read_gdal_raster(path, options, progress);
}

}  // namespace scarp
