// SPDX-License-Identifier: MIT
// The reader in builds without OpenEXR.
#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/raster/exr_raster.h"
#include "scarp/source/raster/opened_dataset.h"

namespace scarp {

namespace {

constexpr const char* kNoExr =
    "this build of Scarp does not read EXR (build with -D SCARP_OPENEXR=ON, or convert the image)";

}  // namespace

OpenedDataset open_exr_raster(const std::string&, const RasterOptions&) { throw Error(kNoExr); }
ExrSamples read_exr_channel(const std::string& path, const std::string&) {
  throw Error(fmt::format("{}: {}", path, kNoExr));
}

}  // namespace scarp
