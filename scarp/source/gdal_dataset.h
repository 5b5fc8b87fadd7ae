// SPDX-License-Identifier: MIT
// The two halves of reading: from a name to an open dataset, from there to a Raster. Shared by the readers.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// While it lives, GDAL calls what is cut off or damaged an error. Formats without compression and with a header of
/// their own would be filled up with zeros where the file ends early.
struct StrictReading {
  GdalOption sizes{"RAW_CHECK_FILE_SIZE", "YES"};
  GdalOption jpeg{"GDAL_ERROR_ON_LIBJPEG_WARNING", "YES"};
};

/// Opens any raster of GDAL's; on the stack there must be a StrictReading. Throws Error whose text has no file name.
GDALDatasetUniquePtr open_gdal_raster(const std::string& path, const GdalSession& session);

/// The files that it is made of, with those that a virtual raster names.
std::vector<std::string> files_of(GDALDataset& dataset);

/// The band of heights: `wanted`, or with 0 the only one. Throws Error whose text has no file name.
int height_band(GDALDataset& dataset, int wanted);

/// Turns the height range, if there is one, into the scale and offset that it means for samples of this type. Throws
/// Error whose text has no file name: an empty range, signed samples, another scale beside it.
void settle_height_range(RasterOptions& options, GDALDataType type, bool signed_byte);

/// Whether it has colours for people to look at: bands of red, green and blue, or a palette.
bool is_picture(GDALDataset& dataset);

/// Whether it says where it lies on a map.
bool has_place(GDALDataset& dataset);

/// Reads the band that the options name, or the colours that they call an encoding. `path` of the result stays empty.
/// Throws Error whose text has no file name.
Raster read_dataset(GDALDataset& dataset, const RasterOptions& options, GdalSession& session, const Progress& progress);

}  // namespace scarp
