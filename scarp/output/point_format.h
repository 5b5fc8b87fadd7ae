// SPDX-License-Identifier: MIT
// Private to the station: the formats of PointFile.
#pragma once

#include <memory>
#include <string>

#include "scarp/output/point_file.h"

namespace scarp {

class PointFormat {
 public:
  virtual ~PointFormat() = default;

  /// Returns the bytes before the points. Their number does not depend on the summary, because they are rewritten at
  /// the end.
  virtual std::string header(const PointSummary& summary) const = 0;
  /// Appends a point. Called concurrently. Throws Error without the path for a point that the format cannot represent.
  virtual void append(std::string& out, const ScanPoint& point) const = 0;
};

std::unique_ptr<PointFormat> csv_points();
std::unique_ptr<PointFormat> npy_points();
std::unique_ptr<PointFormat> ply_points();
std::unique_ptr<PointFormat> las_points(const LasSettings& settings);

/// Throws Error for a miss, which the format cannot represent.
void require_hit(const ScanPoint& point);

}  // namespace scarp
