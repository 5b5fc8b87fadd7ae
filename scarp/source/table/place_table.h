// SPDX-License-Identifier: MIT
// Points and lines from tables and vector files: observers, and ends of lines of sight.
//
//   .csv, .txt, -   a header and one row per place: x,y[,z]; for lines x,y[,z],tx,ty[,tz]. lon,lat (tlon,tlat) instead
//                   of x,y (tx,ty), or longitude,latitude (tlongitude,tlatitude), are longitude and latitude. Names
//                   are in any case. Other columns are kept as text. Dialect: ray_table.h
//   other files     any vector format of GDAL (GeoJSON, GeoPackage, shapefile): points; first and last vertex of lines;
//                   rings of polygons.
//                   Fields are kept as text. Places become longitude and latitude, unless the file has no CRS.
//                   Without the name of a layer, the first that may have geometries of the kind is read
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scarp/base/text_columns.h"
#include "scarp/base/vec.h"

namespace scarp {

/// A place in the table; z only if the table has it.
struct TablePlace {
  double x = 0, y = 0;
  std::optional<double> z{};
};

struct PlaceRow {
  TablePlace from;
  TablePlace to{};                               ///< lines only
  std::int64_t line = 0;                         ///< line or feature in the file, from 1
  std::int64_t to_line = 0;                      ///< of the target, if it is from another line or feature
  std::string bad{};                             ///< why the row has no places, with its line; empty: it has
  std::vector<TablePlace> between{};             ///< vertices between the ends of a line, if read
  std::vector<std::vector<TablePlace>> rings{};  ///< of a polygon: closed, of even-odd inside
  bool is_line = false;
};

struct PlaceTable {
  std::string path;     ///< for messages
  bool lonlat = false;  ///< x and y are longitude and latitude in degrees, WGS 84
  bool vector = false;  ///< z is that of geometries in a vector file, not a column
  std::vector<PlaceRow> rows;
  TextColumns carried;             ///< the other columns; one row per place
  std::vector<std::string> notes;  ///< for users: the layer that was read, if there are several

  /// Returns the position of a row, or of its target, for messages: "a.csv: line 8".
  std::string where(std::size_t row, bool target = false) const;
};

/// Geometries to read: points, lines, lines and polygons, or all of them. Tables of text have no polygons; as shapes
/// they are points.
enum class PlaceKind : std::uint8_t { points, lines, paths, shapes };

/// Returns the lines between all pairs of the points, each pair once. The other columns are `from` and `to`, the
/// numbers of the points, from 1, and the points' columns, with the suffixes _from and _to. Throws Error for fewer than
/// two points, or more than 2^22 pairs.
PlaceTable pairs_of(const PlaceTable& points);

struct PlaceReading {
  std::string layer{};    ///< of vector files; empty: chosen
  bool vertices = false;  ///< of lines of vector files: read also those between the ends
  bool keep_bad = false;  ///< rows without valid places are kept, with `bad`; otherwise they are errors
};

/// Throws Error with the line but without the file's name: missing columns, both x and lon; and unless `keep_bad`, rows
/// with more or fewer fields than the header, fields that are not finite numbers.
PlaceTable parse_place_csv(std::string_view bytes, PlaceKind kind, bool keep_bad = false);

/// Reads a file, or CSV from standard input if `path` is "-". Throws Error naming the file: as above, not a vector
/// file, no such layer, no places, and unless `keep_bad`, a geometry of another kind.
PlaceTable read_places(const std::string& path, PlaceKind kind, const PlaceReading& reading = {});

}  // namespace scarp
