// SPDX-License-Identifier: MIT
// The reader in builds without OpenEXR.
#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/raster/exr_raster.h"

namespace scarp {

namespace {

Error no_exr(const std::string& path) {
  return Error(fmt::format(
      "{}: this build of Scarp does not read EXR (build with -D SCARP_OPENEXR=ON, or convert the image)", path));
}

}  // namespace

Raster read_exr(const std::string& path, const RasterOptions&, const Progress&) { throw no_exr(path); }
ExrSamples read_exr_channel(const std::string& path, const std::string&) { throw no_exr(path); }

}  // namespace scarp
