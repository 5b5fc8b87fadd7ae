// SPDX-License-Identifier: MIT
// Heights encoded in colours as a GDAL dataset with one float band, at the same position. Decodes block by block on
// reading.
#pragma once

#include <gdal_priv.h>

#include "scarp/source/raster/terrain_rgb.h"

namespace scarp {

class DecodedDataset final : public GDALDataset {
 public:
  /// Wraps `colours`, which must outlive it: three byte bands, red, green, blue, and optionally alpha (0: a hole).
  /// Throws Error without the file's name for other bands or a palette.
  DecodedDataset(GDALDataset& colours, HeightEncoding encoding);

  CPLErr GetGeoTransform(double* map) override { return colours_.GetGeoTransform(map); }
  const OGRSpatialReference* GetSpatialRef() const override { return colours_.GetSpatialRef(); }
  int GetGCPCount() override { return colours_.GetGCPCount(); }

 private:
  GDALDataset& colours_;
};

}  // namespace scarp
