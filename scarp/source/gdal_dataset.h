// SPDX-License-Identifier: MIT
// The second half of reading: from an open dataset to a Raster. Shared by the readers that open datasets.
#pragma once

#include <gdal_priv.h>

#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Reads the band that the options name. `path` of the result stays empty. Throws Error whose text has no file name.
Raster read_dataset(GDALDataset& dataset, const RasterOptions& options, GdalSession& session, const Progress& progress);

}  // namespace scarp
