// SPDX-License-Identifier: MIT
// Heights in colours, seen by GDAL as a dataset of one float band that lies where the colours lie. Decoded block by
// block, as it is read.
#pragma once

#include <gdal_priv.h>

#include "scarp/source/terrain_rgb.h"

namespace scarp {

class DecodedDataset final : public GDALDataset {
 public:
  /// Over `colours`, which must outlive it: three bands of bytes, red, green, blue, and perhaps alpha (0: a hole).
  /// Throws Error whose text has no file name: other bands, a palette.
  DecodedDataset(GDALDataset& colours, HeightEncoding encoding);

  CPLErr GetGeoTransform(double* map) override { return colours_.GetGeoTransform(map); }
  const OGRSpatialReference* GetSpatialRef() const override { return colours_.GetSpatialRef(); }
  int GetGCPCount() override { return colours_.GetGCPCount(); }

 private:
  GDALDataset& colours_;
};

}  // namespace scarp
