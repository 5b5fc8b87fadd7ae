// SPDX-License-Identifier: MIT
// The class Terrain of the module.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "python/bind/bind.h"
#include "python/bind/names.h"
#include "python/bind/terrain_object.h"
#include "scarp/base/error.h"
#include "scarp/base/vertical_unit.h"
#ifdef SCARP_PYTHON_FILES
#include "scarp/scarp.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/raster_options.h"
#include "scarp/source/raster/read_raster.h"
#endif

namespace scarp::python {
namespace {

namespace py = pybind11;

constexpr Named<Surface> kSurfaces[] = {{"bilinear", Surface::bilinear}, {"triangles", Surface::triangles}};
constexpr Named<Wrap> kWraps[] = {
    {"none", Wrap::none}, {"periodic", Wrap::periodic}, {"shared_border", Wrap::shared_border}};

using MapFromNode = std::array<double, 6>;

std::unique_ptr<TerrainObject> over_array(const py::array& heights, bool south_up, double cell_x, double cell_y,
                                          double scale, double offset, double exaggeration,
                                          std::optional<double> nodata, const std::string& surface,
                                          const std::string& wrap, bool solid,
                                          const std::optional<MapFromNode>& map_from_node, const std::string& crs,
                                          double grid_north) {
  Georeference georeference;
  georeference.present = map_from_node.has_value();
  if (map_from_node) georeference.map_from_node = *map_from_node;
  georeference.crs_wkt = crs;
  georeference.cell_x_m = cell_x;
  georeference.cell_y_m = cell_y;
  georeference.grid_north_azimuth = grid_north;
  return std::make_unique<TerrainObject>(heights, south_up,
                                         HeightFieldSettings{.cell_x = cell_x,
                                                             .cell_y = cell_y,
                                                             .scale = scale,
                                                             .offset = offset,
                                                             .exaggeration = exaggeration,
                                                             .nodata = nodata,
                                                             .surface = find(kSurfaces, surface, "surface"),
                                                             .wrap = find(kWraps, wrap, "wrap"),
                                                             .solid = solid},
                                         std::move(georeference));
}

// An array over the samples of a field, without a copy; `owner` keeps them alive.
py::array heights_of(const HeightField& field, const py::object& owner) {
  return field.visit([&]<class T>(const SampleGrid<T>& grid) -> py::array {
    py::array_t<T> view({grid.rows, grid.cols},
                        {grid.row_stride * static_cast<py::ssize_t>(sizeof(T)), static_cast<py::ssize_t>(sizeof(T))},
                        grid.data, owner);
    view.attr("setflags")(py::arg("write") = false);
    return view;
  });
}

#ifdef SCARP_PYTHON_FILES
std::unique_ptr<TerrainObject> open_file(const std::string& path, int band, std::optional<double> nodata,
                                         const std::string& crs, const std::string& unit,
                                         std::optional<std::array<int, 4>> window, double exaggeration,
                                         const std::string& surface, const std::string& wrap, bool solid) {
  RasterOptions raster;
  raster.band = band;
  raster.nodata = nodata;
  raster.crs = crs;
  raster.unit = unit;
  if (window) raster.window = RasterWindow{(*window)[0], (*window)[1], (*window)[2], (*window)[3]};
  FieldOptions options;
  options.exaggeration = exaggeration;
  options.surface = find(kSurfaces, surface, "surface");
  options.wrap = find(kWraps, wrap, "wrap");
  options.solid = solid;
  const py::gil_scoped_release release;
  Raster read = read_raster(path, raster);
  Georeference georeference = read.georeference;
  return std::make_unique<TerrainObject>(height_field_from(std::move(read), options), std::move(georeference));
}
#endif

}  // namespace

void bind_terrain(py::module_& module) {
  module.def("metres_per_vertical_unit", &metres_per_vertical_unit, py::arg("name"));
  py::class_<TerrainObject, SceneObject> terrain(module, "Terrain");
  terrain
      .def(py::init(&over_array), py::arg("heights"), py::arg("south_up"), py::arg("cell_x"), py::arg("cell_y"),
           py::arg("scale"), py::arg("offset"), py::arg("exaggeration"), py::arg("nodata"), py::arg("surface"),
           py::arg("wrap"), py::arg("solid"), py::arg("map_from_node"), py::arg("crs"), py::arg("grid_north"))
      .def_property_readonly("_array", &TerrainObject::array)
      .def_property_readonly(
          "_heights",
          [](const py::object& self) { return heights_of(self.cast<const TerrainObject&>().field(), self); })
      .def_property_readonly("_settings",
                             [](const TerrainObject& self) {
                               const HeightFieldSettings& s = self.field().settings();
                               return py::make_tuple(s.cell_x, s.cell_y, s.scale, s.offset, s.exaggeration, s.nodata,
                                                     name_in(kSurfaces, s.surface), name_in(kWraps, s.wrap), s.solid);
                             })
      .def_property_readonly("_georeference",
                             [](const TerrainObject& self) {
                               const Georeference& g = self.georeference();
                               return py::make_tuple(g.present, g.map_from_node, g.crs_wkt, g.grid_north_azimuth);
                             })
      .def_property_readonly("_range",
                             [](const TerrainObject& self) {
                               using Ends = std::pair<std::optional<double>, std::optional<double>>;
                               const py::gil_scoped_release release;
                               const auto locks = shared_locks(self);  // edits change it
                               const HeightField& field = self.field();
                               return field.all_nodata() ? Ends() : Ends(field.min_height(), field.max_height());
                             })
      .def("_samples_changed",
           [](TerrainObject& self, int col, int row, int cols, int rows) {
             self.samples_changed({col, row, cols, rows});
           })
      .def("_set_samples", [](TerrainObject& self, int col, int row, const py::array& samples) {
        self.set_samples({col, row, static_cast<int>(samples.shape(1)), static_cast<int>(samples.shape(0))}, samples);
      });
#ifdef SCARP_PYTHON_FILES
  terrain.def(py::init(&open_file), py::arg("path"), py::arg("band"), py::arg("nodata"), py::arg("crs"),
              py::arg("unit"), py::arg("window"), py::arg("exaggeration"), py::arg("surface"), py::arg("wrap"),
              py::arg("solid"));
#endif
}

}  // namespace scarp::python
