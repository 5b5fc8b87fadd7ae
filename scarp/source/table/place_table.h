// SPDX-License-Identifier: MIT
// Points and lines from tables and vector files: observers, and ends of lines of sight.
//
//   .csv, .txt, -   a header and one row per place: x,y[,z]; for lines x,y[,z],tx,ty[,tz]. lon,lat (tlon,tlat) instead
//                   of x,y (tx,ty) are longitude and latitude. Other columns are kept as text. Dialect: ray_table.h
//   other files     any vector format of GDAL (GeoJSON, GeoPackage, shapefile): points; first and last vertex of lines.
//                   Fields are kept as text. Places become longitude and latitude, unless the file has no CRS
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
  TablePlace to{};        ///< lines only
  std::int64_t line = 0;  ///< line or feature in the file, from 1
};

struct PlaceTable {
  std::string path;     ///< for messages
  bool lonlat = false;  ///< x and y are longitude and latitude in degrees, WGS 84
  std::vector<PlaceRow> rows;
  TextColumns carried;  ///< the other columns; one row per place

  /// Returns the position of a row for messages: "a.csv: line 8".
  std::string where(std::size_t row) const;
};

enum class PlaceKind : std::uint8_t { points, lines };

/// Throws Error with the line but without the file's name: missing columns, both x and lon, rows with more or fewer
/// fields than the header, fields that are not finite numbers.
PlaceTable parse_place_csv(std::string_view bytes, PlaceKind kind);

/// Reads a file, or CSV from standard input if `path` is "-". Throws Error naming the file: as above, not a vector
/// file, a geometry of another kind, no places.
PlaceTable read_places(const std::string& path, PlaceKind kind);

}  // namespace scarp
