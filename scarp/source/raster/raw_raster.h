// SPDX-License-Identifier: MIT
// Raw files of samples without a header: .raw and .r16 from game engines, .bil and .flt without their .hdr.
#pragma once

#include <string>

#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/opened_dataset.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Opens the file as options.raw (which must be set) specifies. Raw files have no georeference: options.bounds and
/// options.crs provide it. Throws Error without the file's name if it cannot be opened, and if its length does not
/// match the samples; if an offset is given, it ignores bytes after the samples and adds a note.
OpenedDataset open_raw(const std::string& path, const RasterOptions& options, const GdalSession& session);

}  // namespace scarp
