// SPDX-License-Identifier: MIT
#include "scarp/output/las_crs.h"

#include <ogr_spatialref.h>

#include <memory>

#include "scarp/output/gdal_writing.h"

namespace scarp {

std::string las_wkt(const std::string& crs) {
  const GdalWriting quiet;
  OGRSpatialReference reference;
  if (reference.SetFromUserInput(crs.c_str()) != OGRERR_NONE) return {};
  const char* const options[] = {"FORMAT=WKT1_GDAL", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  const OGRErr error = reference.exportToWkt(&text, options);
  const std::unique_ptr<char, decltype(&::VSIFree)> owner(text, ::VSIFree);
  return error == OGRERR_NONE && text ? std::string(text) : std::string();
}

}  // namespace scarp
