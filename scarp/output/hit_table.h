// SPDX-License-Identifier: MIT
// What rays met, as a table: CSV or .npy, written whole or not at all.
//
//   hits      [carried...], ray, status, t, x, y, z, col, row, u, v, nx, ny, nz, wall
//   blocked   [carried...], ray, blocked
//
// CSV: a header and a line per row; numbers have as many digits as bring back the same double; what a row has not (the
// place of a miss) is empty; status is hit, miss, below or exhausted. `carried` are text columns that pass through.
//
// .npy (version 1.0 of the format, NEP 1): a one-dimensional array of structures whose fields are all float64 and named
// as above, without the carried ones; what a row has not is NaN; status is the value of HitStatus: 0 miss, 1 hit, 2
// below, 3 exhausted.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/base/replace_file.h"
#include "scarp/base/text_columns.h"
#include "scarp/base/vec.h"

namespace scarp {

/// "miss", "hit", "below" or "exhausted".
std::string_view name_of(HitStatus status);

/// A row of the table of hits. Of a row that is no hit only ray and status are written, and t, if finite, when it is
/// exhausted.
struct HitRow {
  std::int64_t ray = 0;  ///< from 0
  Hit hit;
  dvec3 position{0.0};  ///< in the coordinates of the table
  dvec3 normal{0.0};    ///< unit length
};

enum class TableKind : std::uint8_t { hits, blocked };

/// A table that grows row by row and becomes a file with commit().
class HitTable {
 public:
  /// `path` ends in .csv or .npy; empty: CSV to standard output. Reserves the place at once. `carried` has a row per
  /// ray and must outlive the table. Throws Error: another ending, a place that cannot be written, a carried column
  /// with the name of one of the table's.
  HitTable(const std::string& path, TableKind kind, const TextColumns& carried);
  ~HitTable();

  /// Throws Error when it cannot be written (disk full), like all below.
  void add(std::span<const HitRow> rows);
  /// blocked[i] is that of ray first_ray + i.
  void add(std::int64_t first_ray, std::span<const std::uint8_t> blocked);
  /// Moves the whole table into its place.
  void commit();

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const;
  };

  void put_header();
  void put(std::int64_t ray, std::span<const double> numbers);
  void flush();
  [[noreturn]] void refuse(std::string_view what) const;

  std::string path_;
  TableKind kind_;
  const TextColumns& carried_;
  bool npy_;
  std::unique_ptr<ReplaceFile> place_;  // null: standard output
  std::unique_ptr<std::FILE, FileCloser> file_;
  std::string text_;  // not yet written
  std::int64_t rows_ = 0;
};

}  // namespace scarp
