// SPDX-License-Identifier: MIT
// Files of bare samples without a header: the .raw and .r16 of game engines, the .bil and .flt whose .hdr is lost.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Reads the file as options.raw (which must be there) says. Such files have no georeference: options.bounds and
/// options.crs give it. Throws as read_gdal_raster() does, and for files whose length is not that of the samples; with
/// an offset given, bytes behind the samples are left out with a note.
Raster read_raw(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
