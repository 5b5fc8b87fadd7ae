// SPDX-License-Identifier: MIT
#include "scarp/source/raster/read_raster.h"

#include "scarp/source/raster/opened_raster.h"

namespace scarp {

Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress) {
  return read_tiles({path}, options, progress);
}

Raster read_tiles(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress) {
  return OpenedRaster(inputs, options, progress).read(progress);
}

}  // namespace scarp
