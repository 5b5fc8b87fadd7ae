// SPDX-License-Identifier: MIT
// Tables of rays: CSV, or NumPy arrays.
//
//   id,x,y,z,dx,dy,dz,t_max        columns in any order; required: x,y,z and either a direction dx,dy,dz or a target
//   a,500,200,900,1,0,-0.5,4000    tx,ty,tz; optional: t_min, t_max, start_col, start_row
//   b,510,200,900,1,0,-0.5,        an empty t_min, t_max or start counts as not given
//
// lon,lat and tlon,tlat (or longitude,latitude, ...) may replace x,y and tx,ty. Names are in any case. Other columns
// (here `id`) are kept as text. Separators are commas, semicolons or tabs, whichever comes first in the header outside
// quotes; quotes as in RFC 4180; lines end with LF, CR LF or CR; a UTF-8 byte order mark and blank lines are skipped.
// Numbers have a decimal point.
//
// Arrays are float32 or float64 of shape (N, 6) or (N, 8): x, y, z, dx, dy, dz[, t_min, t_max]; or N structures with
// numeric fields named as above. Other fields are skipped.
//
// Coordinates are kept as in the table: coordinates.h converts them to a field's metres.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/base/text_columns.h"
#include "scarp/base/vec.h"

namespace scarp {

/// Meaning of a row's second triple.
enum class RayAim : std::uint8_t {
  direction,  ///< dx, dy, dz
  target,     ///< tx, ty, tz: the point at t = 1, where the ray ends unless t_max is given
};

/// The kind of a table: rays or cameras. Tables of rays must have the columns z and tz. Tables of cameras may lack them
/// (they are then 0).
enum class RayRows : std::uint8_t { rays, cameras };

/// One ray of the table.
struct RayRow {
  dvec3 origin{0.0};  ///< finite
  dvec3 aim{0.0};     ///< direction, finite and non-zero; or target, finite and different from the origin
  double t_min = 0.0;
  double t_max = std::numeric_limits<double>::infinity();
  RayStart start = RayStart::free;  ///< on_surface if start_col and start_row are given
  Cell start_cell{};
  std::int64_t line = 0;  ///< line in the file, from 1; 0 for files without lines
};

/// A ray that cannot be used.
struct BadRay {
  std::int64_t ray = 0;  ///< index in the table, from 0
  std::string why;       ///< with the file, the line and the ray
};

/// The rays of a table.
struct RayTable {
  std::string path;  ///< as opened, for messages
  RayRows are = RayRows::rays;
  RayAim aim = RayAim::direction;
  bool lonlat = false;                     ///< x and y are from columns lon and lat
  bool has_z = true, has_target_z = true;  ///< whether the columns z and tz exist
  std::vector<RayRow> rows;
  TextColumns carried;                ///< the other columns; one row per ray, also for those in `bad`
  std::vector<BadRay> bad;            ///< rays that are left out of `rows`, in order
  std::vector<std::int64_t> indices;  ///< of the rays in `rows`, if some are left out; otherwise from 0

  std::int64_t index(std::size_t row) const { return indices.empty() ? static_cast<std::int64_t>(row) : indices[row]; }
  /// Moves rays from `rows` to `bad`: those of these indices, in order, which are in `rows`.
  void leave_out(std::span<const BadRay> rays);

  /// Returns the position of a row for messages: "a.csv: line 8 (ray 6)", or (camera 6); line numbers start at 1, the
  /// others at 0.
  std::string where(std::size_t row) const;
};

/// Treatment of invalid rays.
enum class BadRays : std::uint8_t {
  refused,   ///< an error names the first
  left_out,  ///< RayTable::bad
};

/// Throws Error with line and ray but without the file's name: missing columns, duplicate columns, or both direction
/// and target; rows with more or fewer fields than the header, fields that are not finite numbers, zero directions;
/// unclosed quotes; an empty text. A header alone is a table without rays. `bad` is about errors of single rows.
RayTable parse_ray_csv(std::string_view bytes, RayRows are = RayRows::rays, BadRays bad = BadRays::refused);

/// Parses the bytes of a .npy file. Throws Error without the file's name: another type or shape, truncated bytes, and
/// values that parse_ray_csv() rejects.
RayTable parse_ray_npy(std::string_view bytes, RayRows are = RayRows::rays, BadRays bad = BadRays::refused);

/// Reads a file, or standard input if `path` is "-". Detects .npy by its first bytes; everything else is CSV. Throws
/// Error naming the file.
RayTable read_rays(const std::string& path, RayRows are = RayRows::rays, BadRays bad = BadRays::refused);

}  // namespace scarp
