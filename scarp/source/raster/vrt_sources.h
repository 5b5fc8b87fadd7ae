// SPDX-License-Identifier: MIT
// Checks the sources of virtual rasters, because GDAL's read errors rarely name the faulty file.
#pragma once

#include <gdal_priv.h>

namespace scarp {

/// Throws Error (without the file's name) naming the first source of the band that is missing, empty or a Git LFS
/// pointer. Accepts bands that are not virtual.
void check_vrt_sources(GDALRasterBand& band);

}  // namespace scarp
