// SPDX-License-Identifier: MIT
// The reader of a Scarp that was built without OpenEXR.
#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/exr_raster.h"

namespace scarp {

Raster read_exr(const std::string& path, const RasterOptions&, const Progress&) {
  throw Error(fmt::format(
      "raster '{}': this Scarp was built without OpenEXR; build it with -D SCARP_OPENEXR=ON, or convert the image",
      path));
}

}  // namespace scarp
