// SPDX-License-Identifier: MIT
// Heights in OpenEXR images, as displacement and terrain tools write them: one channel of half, float or uint.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Reads the channel options.channel of the first part, scan lines or tiles (of these the finest level); with no name
/// the only channel, else Y, else R, which a note says. The samples are those of the data window. There is no
/// georeference: options.bounds and options.crs give it. Throws as read_gdal_raster() does, and: no such channel,
/// subsampled, deep; a Scarp that was built without OpenEXR.
Raster read_exr(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
