// SPDX-License-Identifier: MIT
// Coordinate reference systems in LAS files.
#pragma once

#include <string>

namespace scarp {

/// Returns a CRS, given in any form that GDAL reads ("EPSG:32610", WKT 2, ...), as WKT 1 (OGC 01-009), which LAS
/// requires; empty if WKT 1 cannot represent it.
std::string las_wkt(const std::string& crs);

}  // namespace scarp
