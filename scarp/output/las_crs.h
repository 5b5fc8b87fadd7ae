// SPDX-License-Identifier: MIT
// Coordinate reference systems in LAS files.
#pragma once

#include <string>

namespace scarp {

/// Converts a CRS in any form that GDAL reads ("EPSG:32610", WKT 2, ...) to WKT 1 (OGC 01-009), which LAS requires;
/// returns an empty text if WKT 1 cannot represent it.
std::string las_wkt(const std::string& crs);

}  // namespace scarp
