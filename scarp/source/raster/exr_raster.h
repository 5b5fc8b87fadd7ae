// SPDX-License-Identifier: MIT
// Heights from OpenEXR images, as written by displacement and terrain tools: one channel of half, float or uint.
#pragma once

#include <string>
#include <vector>

#include "scarp/source/raster/raster_options.h"

namespace scarp {

struct OpenedDataset;

/// Opens the channel options.channel of the first part, in scan lines or tiles (finest level only). Without a name, it
/// opens the only channel, else Y, else R, and adds a note. The samples are those of the data window. EXR has no
/// georeference: options.bounds and options.crs provide it. Throws Error without the file's name if it cannot be
/// opened, and for a missing channel, a subsampled channel, a deep image, or a build without OpenEXR.
OpenedDataset open_exr_raster(const std::string& path, const RasterOptions& options);

/// One channel of a picture, row by row from the top.
struct ExrSamples {
  int width = 0, height = 0;
  std::vector<float> values;
};
/// Reads a channel of the first part unchanged, including infinities and NaN. Throws as open_exr_raster() does, with
/// the file's name.
ExrSamples read_exr_channel(const std::string& path, const std::string& channel);

}  // namespace scarp
