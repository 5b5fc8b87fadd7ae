// SPDX-License-Identifier: MIT
// Rays from a table: CSV, or an array of NumPy's.
//
//   id,x,y,z,dx,dy,dz,t_max        columns in any order; x,y,z and either a direction dx,dy,dz or a target tx,ty,tz
//   a,500,200,900,1,0,-0.5,4000    must be there; t_min, t_max, start_col, start_row may be
//   b,510,200,900,1,0,-0.5,        an empty t_min, t_max or start is one that was not given
//
// Other columns (here `id`) are kept as text. Commas, semicolons or tabs separate, whichever the header has first
// outside of quotes; quotes as in RFC 4180; lines end with LF, CR LF or CR; a byte order mark of UTF-8 and blank lines
// are passed over. Numbers have a decimal point.
//
// An array holds float32 or float64, (N, 6) or (N, 8): x, y, z, dx, dy, dz[, t_min, t_max]; or N structures with fields
// of the names above, numbers all of them. Its other fields are passed over.
//
// Coordinates are those of the table: coordinates.h turns them into metres of a field.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/base/text_columns.h"
#include "scarp/base/vec.h"

namespace scarp {

/// What a row tells of where its ray goes.
enum class RayAim : std::uint8_t {
  direction,  ///< dx, dy, dz
  target,     ///< tx, ty, tz: the point at t = 1, where the ray ends unless t_max says otherwise
};

/// One ray as the table has it.
struct RayRow {
  dvec3 origin{0.0};  ///< finite
  dvec3 aim{0.0};     ///< direction, finite and not zero; or target, finite and not the origin
  double t_min = 0.0;
  double t_max = std::numeric_limits<double>::infinity();
  RayStart start = RayStart::free;  ///< on_surface where start_col and start_row are given
  Cell start_cell{};
  std::int64_t line = 0;  ///< of the file, from 1; 0: it has no lines
};

struct RayTable {
  std::string path;  ///< as opened, for messages
  RayAim aim = RayAim::direction;
  std::vector<RayRow> rows;
  TextColumns carried;  ///< the other columns; a row per ray

  /// For messages: "rays 'a.csv': line 8 (ray 6)"; lines count from 1, rays from 0.
  std::string where(std::size_t row) const;
};

/// Throws Error whose text has no file name, but line and ray: a header without the columns, twice the same one or both
/// aims; rows of another length than the header, what is no number or not finite, a direction of zero; quotes that do
/// not close; nothing at all. A header alone is a table without rays.
RayTable parse_ray_csv(std::string_view bytes);

/// The same for the bytes of a .npy file. Throws Error (no file name): another type or shape, bytes cut off, and what
/// parse_ray_csv() does not let pass in rows.
RayTable parse_ray_npy(std::string_view bytes);

/// Reads a file, or standard input where `path` is "-". What begins as .npy does is read as such, all else as CSV.
/// Throws Error naming the file.
RayTable read_rays(const std::string& path);

}  // namespace scarp
