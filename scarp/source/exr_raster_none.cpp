// SPDX-License-Identifier: MIT
// The reader in builds without OpenEXR.
#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/exr_raster.h"

namespace scarp {

Raster read_exr(const std::string& path, const RasterOptions&, const Progress&) {
  throw Error(fmt::format(
      "{}: this build of Scarp does not read EXR (build with -D SCARP_OPENEXR=ON, or convert the image)", path));
}

}  // namespace scarp
