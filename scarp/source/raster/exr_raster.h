// SPDX-License-Identifier: MIT
// Heights from OpenEXR images, as written by displacement and terrain tools: one channel of half, float or uint.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Reads the channel options.channel of the first part, in scan lines or tiles (finest level only). Without a name, it
/// reads the only channel, else Y, else R, and adds a note. The samples are those of the data window. EXR has no
/// georeference: options.bounds and options.crs provide it. Throws as read_gdal_raster() does, and for a missing
/// channel, a subsampled channel, a deep image, or a build without OpenEXR.
Raster read_exr(const std::string& path, const RasterOptions& options, const Progress& progress = {});

/// One channel of a picture, row by row from the top.
struct ExrSamples {
  int width = 0, height = 0;
  std::vector<float> values;
};
/// Reads a channel of the first part unchanged, including infinities and NaN. Throws Error naming the file as
/// read_exr() does.
ExrSamples read_exr_channel(const std::string& path, const std::string& channel);

}  // namespace scarp
