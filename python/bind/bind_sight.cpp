// SPDX-License-Identifier: MIT
// Maps and lines of what observers see, in the library's units: nodes, metres, radians from grid north.
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "python/bind/maps.h"
#include "python/bind/names.h"
#include "python/bind/terrain_object.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/observer_count.h"
#include "scarp/analysis/profile.h"
#include "scarp/analysis/viewshed.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

// Codes of the map `visible`, as `scarp viewshed` writes them.
constexpr std::uint8_t kHidden = 0, kVisible = 1, kNoCode = 255;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// An observer: a node, its settings, and the cells around it.
struct Observer {
  int col, row;
  double height;
  bool above_sea;
  double first_azimuth, last_azimuth;
  double cell_x, cell_y;
};
using ObserverRow = std::tuple<int, int, double, bool, double, double, double, double>;

// Settings that all observers share.
struct Limits {
  double target_height, coefficient, diameter, min_distance, max_distance, low_pitch, high_pitch;
};

ViewshedSettings settings_of(const Observer& observer, const Limits& limits) {
  ViewshedSettings settings;
  if (observer.above_sea) {
    settings.observer_z = observer.height;
  } else {
    settings.observer_height = observer.height;
  }
  settings.target_height = limits.target_height;
  settings.curvature = {limits.coefficient, limits.diameter};
  settings.min_distance = limits.min_distance;
  settings.max_distance = limits.max_distance;
  settings.first_azimuth = observer.first_azimuth;
  settings.last_azimuth = observer.last_azimuth;
  settings.low_pitch = limits.low_pitch;
  settings.high_pitch = limits.high_pitch;
  return settings;
}

// The observers of one map over their fields.
struct Observers {
  std::vector<HeightField> fields{};
  std::vector<Node> nodes{};
  std::vector<ViewshedSettings> settings{};

  Observers(const TerrainObject& terrain, const std::vector<Observer>& observers, const Limits& limits) {
    const HeightFieldSettings& own = terrain.field().settings();
    for (const Observer& one : observers) {
      const bool same = one.cell_x == own.cell_x && one.cell_y == own.cell_y;
      fields.push_back(same ? terrain.field() : terrain.field_with_cells(one.cell_x, one.cell_y));
      nodes.push_back({one.col, one.row});
      settings.push_back(settings_of(one, limits));
    }
  }
  std::size_t count() const { return nodes.size(); }
  std::vector<Viewpoint> views() const {
    std::vector<Viewpoint> all;
    for (std::size_t i = 0; i < count(); ++i) all.emplace_back(fields[i], nodes[i], settings[i]);
    return all;
  }
};

// Codes, in the memory that the library filled: a second array would take longer than all conversions.
std::vector<Seen> visible(const Observers& observers, const RowBand& rows, const Progress& progress) {
  if (observers.count() == 1) {
    static_assert(static_cast<std::uint8_t>(Seen::hidden) == kHidden &&
                  static_cast<std::uint8_t>(Seen::visible) == kVisible);
    auto seen = viewshed_rows(observers.fields[0], observers.nodes[0], observers.settings[0], rows, progress);
    for (Seen& code : seen) code = code > Seen::visible ? Seen{kNoCode} : code;
    return seen;
  }
  std::vector<Seen> codes;
  const auto counts = observer_count_rows(observers.views(), rows, progress);
  codes.resize(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    codes[i] = Seen{counts[i] == kCountHole || counts[i] == kCountOutOfRange ? kNoCode
                    : counts[i] > 0                                          ? kVisible
                                                                             : kHidden};
  return codes;
}

std::vector<std::uint16_t> count(const Observers& observers, const RowBand& rows, const Progress& progress) {
  auto counts = observer_count_rows(observers.views(), rows, progress);
  for (std::uint16_t& number : counts)
    if (number == kCountOutOfRange) number = kCountHole;
  return counts;
}

std::vector<float> least(const Observers& observers, HeightDatum datum, const RowBand& rows, const Progress& progress) {
  std::vector<float> pixels;
  for (std::size_t k = 0; k < observers.count(); ++k) {
    const HeightField& field = observers.fields[k];
    const auto heights =
        least_visible_rows(field, observers.nodes[k], observers.settings[k], rows,
                           progress_part(progress, static_cast<double>(k), static_cast<double>(observers.count())));
    const Viewpoint view(field, observers.nodes[k], observers.settings[k]);
    if (pixels.empty()) pixels.assign(heights.size(), kNothing);
    const int cols = field.cols();
    parallel_for(rows.rows(), 16, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin * cols); i < static_cast<std::size_t>(end * cols); ++i) {
        const Node node{static_cast<int>(i % static_cast<std::size_t>(cols)),
                        rows.first + static_cast<int>(i / static_cast<std::size_t>(cols))};
        pixels[i] = std::fmin(pixels[i], least_height(view.ground(), node, heights[i], datum));  // replaces NaN
      }
    });
  }
  return pixels;
}

std::vector<float> angles(const Observers& observers, const RowBand& rows, const Progress& progress) {
  std::vector<float> pixels;
  for (std::size_t k = 0; k < observers.count(); ++k) {
    const auto codes =
        viewshed_rows(observers.fields[k], observers.nodes[k], observers.settings[k], rows,
                      progress_part(progress, static_cast<double>(k), static_cast<double>(observers.count())));
    const auto of_one =
        sight_angles(Viewpoint(observers.fields[k], observers.nodes[k], observers.settings[k]), codes, rows.first);
    if (pixels.empty()) pixels.assign(of_one.size(), kNothing);
    for (std::size_t i = 0; i < of_one.size(); ++i) pixels[i] = std::fmax(pixels[i], of_one[i]);  // replaces NaN
  }
  return pixels;
}

enum class Mode : std::uint8_t { visible, count, dem, ground, angle };
constexpr Named<Mode> kModes[] = {{"visible", Mode::visible},
                                  {"count", Mode::count},
                                  {"dem", Mode::dem},
                                  {"ground", Mode::ground},
                                  {"angle", Mode::angle}};

py::array viewshed_map(const TerrainObject& terrain, const std::vector<ObserverRow>& places, double target_height,
                       double coefficient, double diameter, double min_distance, double max_distance, double low_pitch,
                       double high_pitch, const std::string& mode_name, const RowPair& rows,
                       const py::object& progress) {
  const Mode mode = find(kModes, mode_name, "mode");
  const Limits limits{target_height, coefficient, diameter, min_distance, max_distance, low_pitch, high_pitch};
  std::vector<Observer> observers;
  for (const ObserverRow& place : places) observers.push_back(std::make_from_tuple<Observer>(place));
  if (observers.empty()) throw Error("viewshed: no observer");
  const auto shape = shape_of(terrain, {rows.first, rows.second});
  const auto of_observers = [&](const auto& map) {
    return map_of(terrain, rows, progress, [&](const HeightField&, const RowBand& band, const Progress& report) {
      return map(Observers(terrain, observers, limits), band, report);
    });
  };
  switch (mode) {
    case Mode::visible:
      return handed_over<std::uint8_t>(of_observers(visible), shape);
    case Mode::count:
      return handed_over<std::uint16_t>(of_observers(count), shape);
    case Mode::angle:
      return handed_over<float>(of_observers(angles), shape);
    case Mode::dem:
    case Mode::ground:
      break;
  }
  const HeightDatum datum = mode == Mode::dem ? HeightDatum::sea : HeightDatum::ground;
  return handed_over<float>(of_observers([&](const Observers& all, const RowBand& band, const Progress& report) {
                              return least(all, datum, band, report);
                            }),
                            shape);
}

// A line between two places, in columns and rows.
struct Line {
  SightEnd from, to;
  SightCurvature curvature;
  dvec2 cells;

  Line(double from_col, double from_row, double from_height, bool from_sea, double to_col, double to_row,
       double to_height, bool to_sea, double coefficient, double diameter, double cell_x, double cell_y)
      : from{from_col, from_row, from_height, from_sea ? HeightDatum::sea : HeightDatum::ground},
        to{to_col, to_row, to_height, to_sea ? HeightDatum::sea : HeightDatum::ground},
        curvature{coefficient, diameter},
        cells(cell_x, cell_y) {}
};

template <class... Numbers>
py::tuple sight(const TerrainObject& terrain, Numbers... numbers) {
  LineOfSight line;
  {
    const Query query(terrain);
    const Line of(numbers...);
    line = line_of_sight(terrain.field(), of.from, of.to, of.curvature, nullptr, of.cells);
  }
  py::object obstruction = py::none();
  if (line.obstruction)
    obstruction =
        py::make_tuple(line.obstruction->along, line.obstruction->col, line.obstruction->row, line.obstruction->height);
  return py::make_tuple(line.visible, obstruction, line.distance, line.eye, line.target, line.clearance,
                        line.clearance_along);
}

// Columns of the table: along, distance, col, row, ground, drop, sight, visible, after_hole.
template <class... Numbers>
py::array_t<double> profile_table(const TerrainObject& terrain, Numbers... numbers) {
  std::vector<double> table;
  {
    const Query query(terrain);
    const Line of(numbers...);
    for (const ProfilePoint& p : profile(SightLine(terrain.field(), of.from, of.to, of.curvature, of.cells)))
      table.insert(table.end(), {p.along, p.distance, p.col, p.row, p.ground, p.drop, p.sight, p.visible ? 1.0 : 0.0,
                                 p.after_hole ? 1.0 : 0.0});
  }
  constexpr py::ssize_t kColumns = 9;
  const auto points = static_cast<py::ssize_t>(table.size()) / kColumns;
  return handed_over<double>(std::move(table), {points, kColumns});
}

}  // namespace

void bind_sight(py::module_& module) {
  module.def(
      "row_band",
      [](int rows, int part, int parts) {
        const RowBand band = row_band(rows, part, parts);
        return py::make_tuple(band.first, band.last);
      },
      py::arg("rows"), py::arg("part"), py::arg("parts"));
  module.def("viewshed", &viewshed_map, py::arg("terrain"), py::arg("observers"), py::arg("target_height"),
             py::arg("coefficient"), py::arg("diameter"), py::arg("min_distance"), py::arg("max_distance"),
             py::arg("low_pitch"), py::arg("high_pitch"), py::arg("mode"), py::arg("rows"), py::arg("progress"));
  using LineOf = py::tuple (*)(const TerrainObject&, double, double, double, bool, double, double, double, bool, double,
                               double, double, double);
  module.def("line_of_sight", static_cast<LineOf>(&sight));
  using ProfileOf = py::array_t<double> (*)(const TerrainObject&, double, double, double, bool, double, double, double,
                                            bool, double, double, double, double);
  module.def("profile", static_cast<ProfileOf>(&profile_table));
}

}  // namespace scarp::python
