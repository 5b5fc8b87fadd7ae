// SPDX-License-Identifier: MIT
// Coordinate systems, in builds with GDAL: lengths on the ground and positions on Earth.
#include <cpl_conv.h>
#include <ogr_spatialref.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "python/bind/bind.h"
#include "scarp/base/error.h"
#include "scarp/base/georeference.h"
#include "scarp/source/raster/coordinates.h"
#include "scarp/source/raster/metric_plane.h"
#include "scarp/source/raster/raster_place.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

using MapFromNode = std::array<double, 6>;

Georeference georeference_of(const MapFromNode& map_from_node, const std::string& crs) {
  Georeference georeference;
  georeference.present = true;
  georeference.map_from_node = map_from_node;
  georeference.crs_wkt = crs;
  // Replaced unless the CRS is neither geographic nor projected.
  georeference.cell_x_m = map_from_node[1];
  georeference.cell_y_m = -map_from_node[5];
  return georeference;
}

// WKT of any text that GDAL accepts.
std::string wkt_of(const std::string& text) {
  OGRSpatialReference crs;
  const char* const no_network[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (crs.SetFromUserInput(text.c_str(), no_network) != OGRERR_NONE)
    throw Error("crs: '" + text + "' is unknown (expected EPSG:32610, WKT or PROJ text)");
  char* wkt = nullptr;
  crs.exportToWkt(&wkt);
  const std::unique_ptr<char, void (*)(void*)> owner(wkt, [](void* memory) { CPLFree(memory); });
  return wkt;
}

// The plane in metres around a sample: lengths of a column and a row step, azimuth of grid north in radians, error in
// cells.
py::tuple ground_plane(const MapFromNode& map_from_node, const std::string& crs, int cols, int rows, double col,
                       double row, double reach) {
  const MetricPlane plane = MetricPlanes(georeference_of(map_from_node, crs), cols, rows).around({col, row}, reach);
  return py::make_tuple(plane.cell_x, plane.cell_y, plane.grid_north_azimuth, plane.error_cells);
}

// The same along a line between two samples.
py::tuple line_plane(const MapFromNode& map_from_node, const std::string& crs, int cols, int rows,
                     std::pair<double, double> from, std::pair<double, double> to) {
  const MetricPlane plane = MetricPlanes(georeference_of(map_from_node, crs), cols, rows)
                                .along({from.first, from.second}, {to.first, to.second});
  return py::make_tuple(plane.cell_x, plane.cell_y, plane.grid_north_azimuth, plane.error_cells);
}

// Whether the CRS is in degrees, the diameter of its body in metres, whether that is the Earth, metres per map unit of
// other CRS, and metres per vertical unit (0: none).
py::tuple crs_of(const std::string& crs) {
  const Georeference georeference = georeference_of({0, 1, 0, 0, 0, -1}, crs);
  const Body body = body_of(georeference);
  OGRSpatialReference parsed;
  double map_unit = 1, vertical_unit = 0;
  if (parsed.importFromWkt(crs.c_str()) == OGRERR_NONE) {
    if (parsed.IsProjected() || parsed.IsLocal()) map_unit = parsed.GetLinearUnits();
    vertical_unit = vertical_unit_of(parsed).first;
  }
  return py::make_tuple(is_geographic(georeference), 2 * body.semi_major, body.earth, map_unit, vertical_unit);
}

// Longitude and latitude of a sample in degrees (WGS 84); None if it has none.
std::optional<std::pair<double, double>> lonlat(const MapFromNode& map_from_node, const std::string& crs, int cols,
                                                int rows, double col, double row) {
  const Georeference georeference = georeference_of(map_from_node, crs);
  const CoordinateFrame frame(georeference, cols, rows, Coordinates::lonlat);
  std::array points{dvec3(col * georeference.cell_x_m, (rows - 1 - row) * georeference.cell_y_m, 0)};
  if (frame.from_local(points)) return std::nullopt;
  return std::pair(points[0].x, points[0].y);
}

// Column and row of a place on Earth; None if it has none.
std::optional<std::pair<double, double>> node_of_lonlat(const MapFromNode& map_from_node, const std::string& crs,
                                                        int cols, int rows, double longitude, double latitude) {
  const Georeference georeference = georeference_of(map_from_node, crs);
  const CoordinateFrame frame(georeference, cols, rows, Coordinates::lonlat);
  std::array points{dvec3(longitude, latitude, 0)};
  if (frame.to_local(points)) return std::nullopt;
  return std::pair(points[0].x / georeference.cell_x_m, rows - 1 - points[0].y / georeference.cell_y_m);
}

}  // namespace

void bind_crs(py::module_& module) {
  module.def("wkt_of", &wkt_of, py::arg("text"));
  module.def("ground_plane", &ground_plane, py::arg("map_from_node"), py::arg("crs"), py::arg("cols"), py::arg("rows"),
             py::arg("col"), py::arg("row"), py::arg("reach"));
  module.def("line_plane", &line_plane, py::arg("map_from_node"), py::arg("crs"), py::arg("cols"), py::arg("rows"),
             py::arg("from_node"), py::arg("to_node"));
  module.def("crs_of", &crs_of, py::arg("crs"));
  module.def("node_of_lonlat", &node_of_lonlat, py::arg("map_from_node"), py::arg("crs"), py::arg("cols"),
             py::arg("rows"), py::arg("longitude"), py::arg("latitude"));
  module.def("lonlat", &lonlat, py::arg("map_from_node"), py::arg("crs"), py::arg("cols"), py::arg("rows"),
             py::arg("col"), py::arg("row"));
}

}  // namespace scarp::python
