// SPDX-License-Identifier: MIT
// The two halves of reading, shared by all readers: opening a dataset by name, and converting it to a Raster.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Makes GDAL report truncated and damaged files as errors during its lifetime. Otherwise GDAL reads zeros where
/// uncompressed files with their own header end early.
struct StrictReading {
  GdalOption sizes{"RAW_CHECK_FILE_SIZE", "YES"};
  GdalOption jpeg{"GDAL_ERROR_ON_LIBJPEG_WARNING", "YES"};
};

/// Returns whether GDAL reads the dataset as an ESRI ASCII grid.
bool is_ascii_grid(GDALDataset& dataset);

/// Opens any raster that GDAL reads. ESRI ASCII grids get a type that suits all their samples. Requires a StrictReading
/// on the stack. Throws Error without the file's name.
GDALDatasetUniquePtr open_gdal_raster(const std::string& path, const GdalSession& session);

/// Returns the files of the dataset, including those that a virtual raster names.
std::vector<std::string> files_of(GDALDataset& dataset);

/// Returns the number of the height band: `wanted`, or the only band if `wanted` is 0. Throws Error without the file's
/// name.
int height_band(GDALDataset& dataset, int wanted);

/// Converts the height range, if any, to a scale and offset for samples of this type. Throws Error without the file's
/// name: an empty range, signed samples, or a scale that is also set.
void settle_height_range(RasterOptions& options, GDALDataType type, bool signed_byte);

/// Returns whether the dataset is a picture: bands of red, green and blue, or a palette.
bool is_picture(GDALDataset& dataset);

/// Returns whether the dataset is georeferenced.
bool has_place(GDALDataset& dataset);

/// Reads the band that the options name, or decodes colours if the options declare an encoding. Leaves `path` of the
/// result empty. Throws Error without the file's name.
Raster read_dataset(GDALDataset& dataset, const RasterOptions& options, GdalSession& session, const Progress& progress);

}  // namespace scarp
