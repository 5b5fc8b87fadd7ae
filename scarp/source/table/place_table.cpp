// SPDX-License-Identifier: MIT
#include "scarp/source/table/place_table.h"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/table/column_names.h"
#include "scarp/source/table/csv_rows.h"
#include "scarp/source/table/table_file.h"

namespace scarp {
namespace {

enum Column : std::size_t { x, y, z, tx, ty, tz, lon, lat, tlon, tlat, column_count };
constexpr std::array<std::string_view, column_count> kNames = {"x",  "y",   "z",   "tx",   "ty",
                                                               "tz", "lon", "lat", "tlon", "tlat"};

// The columns of a header; missing columns are `npos`.
struct Header {
  std::array<std::size_t, column_count> at;
  std::vector<std::size_t> carried;
  bool has(Column column) const { return at[column] != std::string_view::npos; }
};

Header header_of(const std::vector<std::string_view>& fields, PlaceKind kind, PlaceTable& table) {
  Header header;
  header.at.fill(std::string_view::npos);
  const std::vector<std::string> names = column_names(fields);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto name = std::find(kNames.begin(), kNames.end(), names[i]);
    if (name == kNames.end() || (kind == PlaceKind::points && name->starts_with('t'))) {
      header.carried.push_back(i);
      table.carried.names.emplace_back(trimmed(fields[i]));
      continue;
    }
    auto& at = header.at[static_cast<std::size_t>(name - kNames.begin())];
    if (at != std::string_view::npos) throw Error(fmt::format("two columns '{}'", *name));
    at = i;
  }
  const bool lines = kind == PlaceKind::lines || kind == PlaceKind::paths;
  const bool plain = header.has(x) && header.has(y) && (!lines || (header.has(tx) && header.has(ty)));
  table.lonlat = header.has(lon) && header.has(lat) && (!lines || (header.has(tlon) && header.has(tlat)));
  if (plain == table.lonlat)
    throw Error(fmt::format("{} (required: {})", plain ? "columns x,y and lon,lat both" : "no columns with places",
                            lines ? "x,y[,z],tx,ty[,tz] or lon,lat[,z],tlon,tlat[,tz]" : "x,y[,z] or lon,lat[,z]"));
  return header;
}

// --- vector files --------------------------------------------------------------------------------------------------

struct TransformDeleter {
  void operator()(OGRCoordinateTransformation* transform) const { OGRCoordinateTransformation::DestroyCT(transform); }
};
using Transform = std::unique_ptr<OGRCoordinateTransformation, TransformDeleter>;

Transform to_lonlat(const OGRSpatialReference& from) {
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return Transform(OGRCreateCoordinateTransformation(&from, &wgs84));
}

TablePlace place_from(double x_at, double y_at, std::optional<double> height, OGRCoordinateTransformation* transform,
                      std::int64_t feature) {
  TablePlace place{x_at, y_at, height};
  if (transform && (!transform->Transform(1, &place.x, &place.y)))
    throw Error(fmt::format("feature {}: ({}, {}) is outside the domain of the file's CRS", feature, x_at, y_at));
  if (!std::isfinite(place.x) || !std::isfinite(place.y)) throw Error(fmt::format("feature {}: not finite", feature));
  return place;
}

std::string_view names_of(PlaceKind kind) {
  return kind == PlaceKind::points  ? "points"
         : kind == PlaceKind::lines ? "lines of two or more vertices"
         : kind == PlaceKind::paths ? "lines of two or more vertices, or polygons"
                                    : "points, lines of two or more vertices, or polygons";
}

bool accepts(PlaceKind kind, OGRwkbGeometryType type) {
  if (type == wkbPoint) return kind == PlaceKind::points || kind == PlaceKind::shapes;
  if (type == wkbLineString) return kind != PlaceKind::points;
  return type == wkbPolygon && (kind == PlaceKind::paths || kind == PlaceKind::shapes);
}

// `vertices`: with those between the ends of lines.
void add_feature(const OGRGeometry& geometry, PlaceKind kind, bool vertices, OGRCoordinateTransformation* transform,
                 std::int64_t feature, std::vector<PlaceRow>& rows) {
  const auto type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbMultiPoint || type == wkbMultiLineString || type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection())
      add_feature(*part, kind, vertices, transform, feature, rows);
    return;
  }
  const auto height = [&](double z_at) { return geometry.Is3D() ? std::optional(z_at) : std::nullopt; };
  const auto vertices_of = [&](const OGRSimpleCurve& curve) {
    std::vector<TablePlace> all;
    for (int i = 0; i < curve.getNumPoints(); ++i)
      all.push_back(place_from(curve.getX(i), curve.getY(i), height(curve.getZ(i)), transform, feature));
    return all;
  };
  if (accepts(kind, type) && type == wkbPoint) {
    const OGRPoint& point = *geometry.toPoint();
    if (point.IsEmpty()) throw Error(fmt::format("feature {}: empty geometry", feature));
    rows.push_back({place_from(point.getX(), point.getY(), height(point.getZ()), transform, feature), {}, feature});
  } else if (accepts(kind, type) && type == wkbLineString && geometry.toLineString()->getNumPoints() >= 2) {
    const std::vector<TablePlace> all = vertices_of(*geometry.toLineString());
    PlaceRow row{all.front(), all.back(), feature};
    row.is_line = true;
    if (vertices) row.between.assign(all.begin() + 1, all.end() - 1);
    rows.push_back(std::move(row));
  } else if (accepts(kind, type) && type == wkbPolygon && !geometry.IsEmpty()) {
    PlaceRow row{{}, {}, feature};
    for (const OGRLinearRing* ring : *geometry.toPolygon()) row.rings.push_back(vertices_of(*ring));
    row.from = row.to = row.rings.front().front();
    rows.push_back(std::move(row));
  } else {
    throw Error(fmt::format("feature {}: is a {} (expected {})", feature, geometry.getGeometryName(), names_of(kind)));
  }
}

OGRwkbGeometryType part_of(OGRwkbGeometryType type) {
  return type == wkbMultiPoint        ? wkbPoint
         : type == wkbMultiLineString ? wkbLineString
         : type == wkbMultiPolygon    ? wkbPolygon
                                      : type;
}

bool may_have(OGRLayer& layer, PlaceKind kind) {
  const auto type = wkbFlatten(layer.GetGeomType());
  if (type == wkbUnknown || type == wkbGeometryCollection) return true;
  return accepts(kind, part_of(type));
}

// The layer of this name, or the first that may have geometries of the kind, with a note if there are others.
OGRLayer& layer_of(GDALDataset& dataset, PlaceKind kind, const std::string& name, std::vector<std::string>& notes) {
  constexpr int kListed = 10;
  std::string all;
  for (int i = 0; i < dataset.GetLayerCount() && i < kListed; ++i)
    all += fmt::format("{}'{}'", i > 0 ? ", " : "", dataset.GetLayer(i)->GetName());
  if (dataset.GetLayerCount() > kListed) all += ", ...";
  if (!name.empty()) {
    if (OGRLayer* layer = dataset.GetLayerByName(name.c_str())) return *layer;
    throw Error(fmt::format("no layer '{}' (layers: {})", name, all));
  }
  OGRLayer* chosen = nullptr;
  for (OGRLayer* layer : dataset.GetLayers())
    if (!chosen && may_have(*layer, kind)) chosen = layer;
  if (!chosen) chosen = dataset.GetLayer(0);
  if (dataset.GetLayerCount() > 1)
    notes.push_back(
        fmt::format("{} layers ({}); '{}' is read (--layer)", dataset.GetLayerCount(), all, chosen->GetName()));
  return *chosen;
}

PlaceTable read_vectors(const std::string& path, PlaceKind kind, const PlaceReading& reading) {
  const GdalSession session;
  const GDALDatasetUniquePtr dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset || dataset->GetLayerCount() == 0)
    throw Error(session.reason("is neither CSV nor a vector format that GDAL can read"));
  PlaceTable table;
  table.vector = true;
  OGRLayer& layer = layer_of(*dataset, kind, reading.layer, table.notes);
  Transform transform;
  if (const OGRSpatialReference* crs = layer.GetSpatialRef()) {
    OGRSpatialReference from(*crs);
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transform = to_lonlat(from);
    if (!transform) throw Error("its CRS cannot be transformed to longitude and latitude");
    table.lonlat = true;
  }
  OGRFeatureDefn& fields = *layer.GetLayerDefn();
  for (int i = 0; i < fields.GetFieldCount(); ++i)
    table.carried.names.emplace_back(fields.GetFieldDefn(i)->GetNameRef());
  std::int64_t number = 0;
  for (const auto& feature : layer) {
    ++number;
    const std::size_t before = table.rows.size();
    try {
      const OGRGeometry* geometry = feature->GetGeometryRef();
      if (!geometry) throw Error(fmt::format("feature {}: has no geometry", number));
      add_feature(*geometry, kind, reading.vertices, transform.get(), number, table.rows);
    } catch (const Error& error) {
      if (!reading.keep_bad) throw;
      table.rows.resize(before);
      table.rows.push_back({{}, {}, number, 0, error.what()});
    }
    for (std::size_t i = before; i < table.rows.size(); ++i)
      for (int k = 0; k < fields.GetFieldCount(); ++k)
        table.carried.cells.emplace_back(feature->IsFieldSetAndNotNull(k) ? feature->GetFieldAsString(k) : "");
  }
  if (session.failed() && !reading.keep_bad) throw Error(session.reason("is damaged"));
  return table;
}

bool is_text(const std::string& path) {
  const std::string extension = extension_of(path);
  return path == "-" || extension == ".csv" || extension == ".txt" || extension == ".tsv";
}

// The places of a row. Throws Error naming the line.
PlaceRow place_row(const CsvRows& rows, const Header& header, std::size_t width, PlaceKind kind, bool degrees) {
  const auto& fields = rows.fields();
  const std::int64_t line = rows.line();
  if (fields.size() != width)
    throw Error(fmt::format("line {}: {} fields (the header has {})", line, fields.size(), width));
  const auto number = [&](Column column) { return finite_field(fields[header.at[column]], kNames[column], line); };
  const auto height = [&](Column column) {
    return header.has(column) && !trimmed(fields[header.at[column]]).empty() ? std::optional(number(column))
                                                                             : std::nullopt;
  };
  PlaceRow row{{number(degrees ? lon : x), number(degrees ? lat : y), height(z)}, {}, line};
  row.is_line = kind == PlaceKind::lines || kind == PlaceKind::paths;
  if (row.is_line) row.to = {number(degrees ? tlon : tx), number(degrees ? tlat : ty), height(tz)};
  return row;
}

}  // namespace

std::string PlaceTable::where(std::size_t row, bool target) const {
  const PlaceRow& one = rows[row];
  return fmt::format("{}: {} {}", path, is_text(path) ? "line" : "feature",
                     target && one.to_line > 0 ? one.to_line : one.line);
}

PlaceTable pairs_of(const PlaceTable& points) {
  const std::size_t count = points.rows.size(), pairs = count * (count - 1) / 2, columns = points.carried.names.size();
  constexpr std::size_t kMostPairs = std::size_t{1} << 22, kMostPoints = std::size_t{1} << 16;
  if (count < 2) throw Error("--pairs: one point makes no pair (give at least two)");
  if (count > kMostPoints || pairs > kMostPairs)
    throw Error(fmt::format("--pairs: {} points make more than {} pairs (split the table)", count, kMostPairs));
  PlaceTable table;
  table.path = points.path;
  table.lonlat = points.lonlat;
  table.vector = points.vector;
  table.notes = points.notes;
  table.carried.names = {"from", "to"};
  for (const char* end : {"_from", "_to"})
    for (const std::string& name : points.carried.names) table.carried.names.push_back(name + end);
  table.rows.reserve(pairs);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      const PlaceRow &a = points.rows[i], &b = points.rows[k];
      table.rows.push_back({a.from, b.from, a.line, b.line, a.bad.empty() ? b.bad : a.bad});
      for (const std::size_t end : {i, k}) table.carried.cells.push_back(fmt::format("{}", end + 1));
      for (const std::size_t end : {i, k})
        for (std::size_t c = 0; c < columns; ++c) table.carried.cells.push_back(points.carried.at(end, c));
    }
  }
  return table;
}

PlaceTable parse_place_csv(std::string_view bytes, PlaceKind kind, bool keep_bad) {
  CsvRows rows(bytes);
  if (!rows.next()) throw Error("is empty (expected a header and places)");
  PlaceTable table;
  const std::size_t width = rows.fields().size();
  const Header header = header_of(rows.fields(), kind, table);
  while (rows.next()) {
    try {
      table.rows.push_back(place_row(rows, header, width, kind, table.lonlat));
    } catch (const Error& error) {
      if (!keep_bad) throw;
      table.rows.push_back({{}, {}, rows.line(), 0, error.what()});
    }
    for (const std::size_t i : header.carried)
      table.carried.cells.emplace_back(i < rows.fields().size() ? rows.fields()[i] : std::string_view());
  }
  return table;
}

PlaceTable read_places(const std::string& path, PlaceKind kind, const PlaceReading& reading) {
  try {
    const bool text = is_text(path);
    if (text && !reading.layer.empty()) throw Error("is a table without layers (leave out --layer)");
    PlaceTable table =
        text ? parse_place_csv(table_bytes(path), kind, reading.keep_bad) : read_vectors(path, kind, reading);
    table.path = path;
    for (std::string& note : table.notes) note = fmt::format("{}: {}", path, note);
    for (PlaceRow& row : table.rows)
      if (!row.bad.empty()) row.bad = fmt::format("{}: {}", path, row.bad);
    if (table.rows.empty())
      throw Error(fmt::format("contains no {}", kind == PlaceKind::points  ? "points"
                                                : kind == PlaceKind::lines ? "lines"
                                                : kind == PlaceKind::paths ? "lines or polygons"
                                                                           : "points, lines or polygons"));
    return table;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
