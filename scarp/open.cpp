// SPDX-License-Identifier: MIT
// Terrain::open(), declared in scarp.h.
#include <utility>

#include "scarp/scarp.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/read_raster.h"

namespace scarp {

Terrain Terrain::open(const std::string& path) { return open(path, {}, {}); }

Terrain Terrain::open(const std::string& path, const RasterOptions& raster_options, const FieldOptions& field) {
  Raster raster = read_raster(path, raster_options);
  Georeference georeference = raster.georeference;
  return Terrain(height_field_from(std::move(raster), field), std::move(georeference));
}

}  // namespace scarp
