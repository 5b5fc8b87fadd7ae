// SPDX-License-Identifier: MIT
// Writes the points of a scanner as CSV, .npy, PLY or LAS, piece by piece: memory use does not depend on the number of
// points.
//
//   .csv   a header line, then one line per point: time, column, channel, azimuth, elevation, range, x, y, z, object
//   .npy   a one-dimensional structured array with fields of these names (NEP 1, version 1.0): time, x, y, z are
//          float64, azimuth, elevation, range float32, column int64, channel int32, object uint32
//   .ply   binary little-endian, element `vertex`: x, y, z and time are double, the rest as in .npy, column as double
//   .las   LAS 1.4, point data record format 6 (las.h)
//
// Numbers in CSV round-trip exactly. Misses have no range and no position: empty fields in CSV, NaN in .npy; PLY and
// LAS cannot represent them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "scarp/base/vec.h"
#include "scarp/output/las.h"

namespace scarp {

class OutputFile;
class PointFormat;

/// A scanner return, or a miss.
struct ScanPoint {
  dvec3 position{0.0};      ///< in the file's coordinate system
  double time = 0;          ///< seconds
  std::int64_t column = 0;  ///< index of the scan column, from 0
  std::int32_t channel = 0;
  std::uint32_t object = 0;
  float azimuth = 0, elevation = 0;  ///< degrees
  float range = 0;                   ///< metres
  float scan_angle = 0;              ///< degrees, -180 to 180, as LAS defines it
  bool hit = true;
};

enum class PointKind : std::uint8_t { csv, npy, ply, las };
/// Returns the kind that matches the extension; CSV for an empty path. Throws Error for other extensions.
PointKind point_kind_of(const std::string& path);

class PointFile {
 public:
  /// Opens the file immediately; an empty path means standard output. `las` is only used for LAS. Throws Error for
  /// another extension, or if the path is not writable.
  explicit PointFile(const std::string& path, const LasSettings& las = {});
  ~PointFile();

  /// Formats the points on all threads. Throws Error for misses in PLY and LAS, a point that LasSettings cannot
  /// represent, and if writing fails (disk full), as commit() does.
  void add(std::span<const ScanPoint> points);
  /// Completes the file and renames it.
  void commit();

  std::int64_t count() const { return summary_.count; }

 private:
  PointSummary summary_;
  std::unique_ptr<PointFormat> format_;
  std::unique_ptr<OutputFile> file_;
};

}  // namespace scarp
