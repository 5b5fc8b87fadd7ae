// SPDX-License-Identifier: MIT
// Virtual rasters fail when samples of theirs are asked for, and say little of which file is to blame.
#pragma once

#include <gdal_priv.h>

namespace scarp {

/// Throws Error (without the file's name) naming the first source of the band that is not there, empty or a Git LFS
/// pointer. Nothing where the band is not virtual.
void check_vrt_sources(GDALRasterBand& band);

}  // namespace scarp
