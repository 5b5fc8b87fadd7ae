// SPDX-License-Identifier: MIT
// Converts a dataset to a Raster, for all readers.
#pragma once

#include <gdal_priv.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/decimate.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Makes GDAL report truncated and damaged files as errors during its lifetime. Otherwise GDAL reads zeros where
/// uncompressed files with their own header end early.
struct StrictReading {
  GdalOption sizes{"RAW_CHECK_FILE_SIZE", "YES"};
  GdalOption jpeg{"GDAL_ERROR_ON_LIBJPEG_WARNING", "YES"};
};

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

/// The properties of a dataset that do not require reading samples.
struct DatasetHeader {
  /// As DatasetReader::read() would return it, without samples; the alternative of `samples` is their type in memory.
  /// Notes are only those about the header.
  Raster raster{};
  SampleEnds stated{};        ///< extremes of the window, in samples, if the file states them
  bool scale_varies = false;  ///< whether the reader may choose the scale by all samples (default_scale.h)
};

/// Reads one band of a dataset, in parts.
class DatasetReader {
 public:
  /// Chooses the band that the options name, or decodes colours if the options declare an encoding, and finds its
  /// position and heights without reading samples. `dataset` must outlive the reader. Throws Error without the file's
  /// name.
  DatasetReader(GDALDataset& dataset, const RasterOptions& options);
  ~DatasetReader();
  DatasetReader(DatasetReader&&) noexcept;
  DatasetReader& operator=(DatasetReader&&) noexcept;

  /// Leaves `path` of the raster empty. Throws Error without the file's name.
  DatasetHeader header() const;

  /// Reads all samples, or a `part` of those that are returned otherwise, from the north-west corner. Scale and lengths
  /// of cells are the same for every part. Leaves `path` of the result empty. Throws Error without the file's name; a
  /// part may be all nodata, and is never decimated.
  Raster read(const std::optional<RasterWindow>& part, GdalSession& session, const Progress& progress) const;

 private:
  struct Band;
  std::unique_ptr<Band> band_;
};

}  // namespace scarp
