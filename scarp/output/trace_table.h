// SPDX-License-Identifier: MIT
// Writes recorded marches (base/march_trace.h) as CSV: a row for each step, then one for the result of the ray.
//
//   ray, index, kind, t, t_out, x, y, z, clearance, free, level, col, row, maximum, object, voxel_x, voxel_y, voxel_z,
//   low_x, low_y, low_z, size
//
// kind is name_of(TraceKind), or the status of the ray in its last row. Numbers round-trip to the same double. Values
// that a step lacks are empty.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "scarp/base/march_trace.h"
#include "scarp/base/ray.h"

namespace scarp {

class OutputFile;

class TraceTable {
 public:
  /// Opens the file at once. Throws Error for another extension than .csv, or a path that is not writable.
  explicit TraceTable(const std::string& path);
  ~TraceTable();

  /// Adds a ray with its steps, their positions in the coordinates of the table, and its result, whose position is the
  /// last one. Throws Error if writing fails (disk full), as does the call below.
  void add(std::int64_t ray, std::span<const TraceStep> steps, std::span<const dvec3> positions, const Hit& hit);
  /// Writes the rest of the table and renames the file.
  void commit();

 private:
  std::unique_ptr<OutputFile> file_;
};

}  // namespace scarp
