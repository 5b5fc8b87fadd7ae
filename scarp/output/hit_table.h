// SPDX-License-Identifier: MIT
// Writes tables of ray query results as CSV or .npy.
//
//   hits         [carried...], ray, status, t, x, y, z, col, row, u, v, nx, ny, nz, wall
//   scene_hits   the same, then object, kind, material, triangle, part, voxel_x, voxel_y, voxel_z, face
//   blocked      [carried...], ray, blocked
//
// CSV: a header line, then one line per row. Numbers round-trip to the same double. Values that a row lacks (the
// position of a miss, the cell of a voxel) are empty. status is hit, miss, below or exhausted; kind and face are also
// words (HitKind, VoxelFace). `carried` are text columns that are copied unchanged. Rays that were not traced have the
// status invalid, or no value of blocked.
//
// .npy (format version 1.0, NEP 1): a one-dimensional structured array of float64 fields with the names above, without
// the carried columns. Missing values are NaN. Words are the values of their enumerations: status is 0 miss, 1 hit, 2
// below, 3 exhausted, 4 invalid.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/base/text_columns.h"
#include "scarp/base/vec.h"

namespace scarp {

class OutputFile;

/// Returns "miss", "hit", "below" or "exhausted".
std::string_view name_of(HitStatus status);

/// The kind of field that was hit.
enum class HitKind : std::uint8_t { heights, function, shape, voxels, mesh };
/// Returns the kind with this name, as returned by SceneField::kind(); nullopt for other names.
std::optional<HitKind> find_hit_kind(std::string_view name);

/// A row of a table of hits. For rows that are not hits, only ray and status are written, and a finite t if exhausted.
struct HitRow {
  std::int64_t ray = 0;  ///< index of the ray, from 0
  Hit hit;
  dvec3 position{0.0};  ///< in the table's coordinate system
  dvec3 normal{0.0};    ///< unit length

  // Only scene_hits writes these.
  HitKind kind = HitKind::heights;
  std::optional<std::uint32_t> material{};  ///< nullopt: the field's own colours
};

enum class TableKind : std::uint8_t {
  hits,        ///< on one height field
  scene_hits,  ///< on any field
  blocked,
};

/// A table that is written row by row and becomes visible as a file with commit().
class HitTable {
 public:
  /// `path` ends in .csv or .npy; an empty path writes CSV to standard output. Opens the file immediately. `carried`
  /// has one row per ray and must outlive the table. Throws Error for another extension, a path that is not writable,
  /// or a carried column whose name the table uses.
  HitTable(const std::string& path, TableKind kind, const TextColumns& carried);
  ~HitTable();

  /// Throws Error if writing fails (disk full), as do the calls below.
  void add(std::span<const HitRow> rows);
  /// Adds results of occlusion queries: blocked[i] belongs to ray first_ray + i.
  void add(std::int64_t first_ray, std::span<const std::uint8_t> blocked);
  /// Adds a ray that was not traced.
  void add_invalid(std::int64_t ray);
  /// Writes the rest of the table and renames the file.
  void commit();

 private:
  void put_header();
  void put(std::int64_t ray, std::span<const double> numbers);

  TableKind kind_;
  const TextColumns& carried_;
  bool npy_;
  std::unique_ptr<OutputFile> file_;
  std::string text_;  // of one row
  std::int64_t rows_ = 0;
};

}  // namespace scarp
