// SPDX-License-Identifier: MIT
#include "app/cli/picture/drawn_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/raster/coordinates.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {
namespace {

constexpr std::array<std::uint8_t, 3> kDrawn = {190, 20, 30}, kMarked = {235, 0, 140};

// Converts places to pixels of the picture.
class Pixels {
 public:
  Pixels(const DrawnMap& map, bool lonlat)
      : map_(map),
        frame_(map.georeference, map.cols, map.rows,
               lonlat                     ? Coordinates::lonlat
               : map.georeference.present ? Coordinates::map
                                          : Coordinates::local) {}

  // nullopt outside the domain of the CRS.
  std::optional<FigurePoint> of(const TablePlace& place) const {
    std::array points{dvec3(place.x, place.y, 0)};
    if (frame_.to_local(points)) return std::nullopt;
    const auto at = map_.camera.pixel(points[0]);
    return at ? std::optional(FigurePoint{map_.per_pixel * at->x, map_.per_pixel * at->y}) : std::nullopt;
  }
  std::vector<FigurePoint> of(const std::vector<TablePlace>& places) const {
    std::vector<FigurePoint> points;
    for (const TablePlace& place : places)
      if (const auto at = of(place)) points.push_back(*at);
    return points;
  }

 private:
  const DrawnMap& map_;
  CoordinateFrame frame_;
};

// The column of labels; nullopt without one.
std::optional<std::size_t> label_column(const PlaceTable& table, const std::string& label) {
  const std::vector<std::string>& names = table.carried.names;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (lower_case(names[i]) == lower_case(label)) return i;
  return std::nullopt;
}

FigureShape shape_of(const PlaceRow& row, const Pixels& pixels) {
  FigureShape shape;
  shape.colour = kDrawn;
  if (!row.rings.empty()) {
    shape.kind = FigureShapeKind::area;
    for (const auto& ring : row.rings) shape.parts.push_back(pixels.of(ring));
  } else if (row.is_line) {
    shape.kind = FigureShapeKind::line;
    std::vector<TablePlace> places{row.from};
    places.insert(places.end(), row.between.begin(), row.between.end());
    places.push_back(row.to);
    shape.parts.push_back(pixels.of(places));
  } else {
    shape.parts.push_back(pixels.of(std::vector{row.from}));
  }
  return shape;
}

}  // namespace

std::vector<FigureShape> drawn_shapes(const DrawOptions& options, const DrawnMap& map) {
  std::vector<FigureShape> shapes;
  bool labelled = options.label.empty();
  std::string columns;
  for (const std::string& path : options.files) {
    const PlaceTable table = read_places(path, PlaceKind::shapes, {{}, true, false});
    const auto label = label_column(table, options.label);
    labelled |= label.has_value();
    for (const std::string& name : table.carried.names) columns += (columns.empty() ? "" : ", ") + name;
    std::optional<Pixels> pixels;
    try {
      pixels.emplace(map, table.lonlat);
    } catch (const Error& error) {
      throw Error(fmt::format("--draw '{}': {}", path, error.what()));
    }
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      FigureShape shape = shape_of(table.rows[i], *pixels);
      if (label) shape.text = table.carried.at(i, *label);
      if (!shape.parts.front().empty()) shapes.push_back(std::move(shape));
    }
  }
  if (!labelled)
    throw Error(fmt::format("--draw-label '{}': no such column in {} (columns: {})", options.label,
                            fmt::join(options.files, ", "), columns.empty() ? "none" : columns));
  return shapes;
}

std::vector<FigureShape> drawn_marks(const std::vector<DrawnMark>& marks, const DrawnMap& map) {
  std::vector<FigureShape> shapes;
  std::set<std::string> names;
  for (const DrawnMark& mark : marks) {
    const auto at = map.camera.pixel(
        {mark.at.x * map.georeference.cell_x_m, (map.rows - 1 - mark.at.y) * map.georeference.cell_y_m, 0});
    if (!at) continue;
    FigureShape shape;
    shape.parts = {{{map.per_pixel * at->x, map.per_pixel * at->y}}};
    shape.colour = kMarked;
    if (names.insert(mark.name).second) shape.text = mark.name;
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace scarp::cli
