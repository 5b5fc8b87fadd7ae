// SPDX-License-Identifier: MIT
// Raw files of samples without a header: .raw and .r16 from game engines, .bil and .flt without their .hdr.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Reads the file as options.raw (which must be set) specifies. Raw files have no georeference: options.bounds and
/// options.crs provide it. Throws as read_gdal_raster() does, and if the file's length does not match the samples; if
/// an offset is given, it ignores bytes after the samples and adds a note.
Raster read_raw(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
