// SPDX-License-Identifier: MIT
// LAS 1.4: point clouds as 32-bit integers, with a scale and an offset per coordinate.
//
//   header (375 bytes), WKT of the CRS if known, description of the extra bytes, then 40 bytes per point:
//   point data record format 6 (X, Y, Z, return 1 of 1, scan angle, GPS time) and the extra bytes
//   channel (uint16), range (float, metres) and object (uint32)
//
// GPS times are the times of the scan, in seconds of the GPS week (global encoding bit 0 is 0). Counts of the legacy
// fields are 0, as the format requires from point format 6 on. Source: ASPRS, "LAS Specification 1.4 - R15", 2019.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "scarp/base/vec.h"

namespace scarp {

/// Properties of a file that do not follow from its points.
struct LasSettings {
  dvec3 scale{0.001};   ///< size of a step, > 0
  dvec3 offset{0.0};    ///< coordinates that the integer 0 stands for
  std::string crs_wkt;  ///< WKT 1, as LAS requires (las_wkt() in las_crs.h); empty: none
};

/// Returns integer offsets, and steps that are powers of ten, with which 32 bits can hold the box from low to high with
/// a quarter of it to spare on each side. Steps are about a millimetre, or the next larger ones that suffice.
/// `millimetre` is the length of a millimetre in the units of each coordinate.
LasSettings las_settings(const dvec3& low, const dvec3& high, const dvec3& millimetre = dvec3(0.001));

/// Number and bounds of points.
struct PointSummary {
  std::int64_t count = 0;
  dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

}  // namespace scarp
