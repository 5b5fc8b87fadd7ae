// SPDX-License-Identifier: MIT
// Raw files of samples without a header: .raw and .r16 of game engines, .bil and .flt whose .hdr is lost.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Reads the file as options.raw (which must be set) specifies. Raw files have no georeference: options.bounds and
/// options.crs provide it. Throws as read_gdal_raster() does, and if the file's length does not match the samples; with
/// an offset given, it ignores bytes after the samples, with a note.
Raster read_raw(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
