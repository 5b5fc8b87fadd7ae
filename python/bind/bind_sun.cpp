// SPDX-License-Identifier: MIT
// Maps of sun and sky, in the library's units: metres, radians from grid north.
#include <pybind11/stl.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "python/bind/names.h"
#include "python/bind/tasks.h"
#include "python/bind/terrain_object.h"
#include "scarp/analysis/horizon.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/shadow.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/analysis/sun_disc.h"
#include "scarp/analysis/sun_hours.h"
#include "scarp/base/progress_part.h"
#ifdef SCARP_ERFA
#include "scarp/analysis/sun_position.h"
#endif

namespace scarp::python {
namespace {

namespace py = pybind11;

constexpr Named<HorizonEngine> kEngines[] = {{"exact", HorizonEngine::exact}, {"sweep", HorizonEngine::sweep}};
constexpr Named<SkyMeasure> kMeasures[] = {{"sky-fraction", SkyMeasure::sky_fraction},
                                           {"sky-view-factor", SkyMeasure::sky_view_factor},
                                           {"positive-openness", SkyMeasure::positive_openness},
                                           {"negative-openness", SkyMeasure::negative_openness}};

std::vector<py::ssize_t> shape_of(const TerrainObject& terrain) {
  return {terrain.field().rows(), terrain.field().cols()};
}

// Runs a map of a terrain as a task.
template <class Map>
auto map_of(const TerrainObject& terrain, const py::object& progress, const Map& map) {
  require_memory(terrain);
  return result_of_task(progress, [&](const Progress& report) {
    const auto locks = shared_locks(terrain);
    return map(terrain.field(), report);
  });
}

HorizonSettings horizon_settings(double eye_height, double max_distance, double coefficient, double diameter,
                                 const std::string& engine) {
  return {eye_height, max_distance, {coefficient, diameter}, find(kEngines, engine, "engine")};
}

// Codes as `scarp shadow` writes them: 0 lit, 1 self-shaded, 2 cast shadow, 255 no sample.
py::array shadow_map(const TerrainObject& terrain, double azimuth, double altitude, bool fraction,
                     const py::object& progress) {
  const SunDirection sun{azimuth, altitude};
  if (fraction)
    return handed_over<float>(map_of(terrain, progress,
                                     [&](const HeightField& field, const Progress& report) {
                                       auto shares = lit_share(field, sun, {0, field.rows()}, report);
                                       for (float& share : shares)
                                         if (share == kNoShare) share = std::numeric_limits<float>::quiet_NaN();
                                       return shares;
                                     }),
                              shape_of(terrain));
  return handed_over<std::uint8_t>(map_of(terrain, progress,
                                          [&](const HeightField& field, const Progress& report) {
                                            auto shades = shadow(field, sun, report);
                                            for (Shade& shade : shades)
                                              if (shade == Shade::hole) shade = Shade{255};
                                            return shades;
                                          }),
                                   shape_of(terrain));
}

// Angles in radians of (azimuths, rows, columns) and, with `distances`, metres.
py::tuple horizon_maps(const TerrainObject& terrain, const std::vector<double>& azimuths, double eye_height,
                       double max_distance, double coefficient, double diameter, const std::string& engine,
                       bool distances, const py::object& progress) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  HorizonRows all = map_of(terrain, progress, [&](const HeightField& field, const Progress& report) {
    const Horizons horizons(field, settings, [&](double) { return report(0); });
    HorizonRows rows;
    for (std::size_t i = 0; i < azimuths.size(); ++i) {
      HorizonRows of_one =
          horizons.rows(azimuths[i], 0, field.rows(), distances,
                        progress_part(report, static_cast<double>(i), static_cast<double>(azimuths.size())));
      if (azimuths.size() == 1) return of_one;
      rows.angle.insert(rows.angle.end(), of_one.angle.begin(), of_one.angle.end());
      rows.distance.insert(rows.distance.end(), of_one.distance.begin(), of_one.distance.end());
    }
    return rows;
  });
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(azimuths.size()), terrain.field().rows(),
                                       terrain.field().cols()};
  py::object metres = py::none();
  if (distances) metres = handed_over<float>(std::move(all.distance), shape);
  return py::make_tuple(handed_over<float>(std::move(all.angle), shape), metres);
}

// Horizons of one place: rows of angle (radians) and distance (NaN without ground); None over holes and outside.
py::object horizon_at(const TerrainObject& terrain, double col, double row, const std::vector<double>& azimuths,
                      double eye_height, double max_distance, double coefficient, double diameter) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, "exact");
  std::vector<double> table;
  {
    const Query query(terrain);
    for (const double azimuth : azimuths) {
      const auto view = horizon_from(terrain.field(), col, row, azimuth, settings);
      if (!view) break;
      table.push_back(view->angle);
      table.push_back(view->distance.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  if (table.size() != 2 * azimuths.size()) return py::none();
  const auto count = static_cast<py::ssize_t>(azimuths.size());
  return handed_over<double>(std::move(table), {count, 2});
}

// One array per measure; openness in radians.
py::list sky_maps(const TerrainObject& terrain, const std::vector<std::string>& names, int azimuths, double eye_height,
                  double max_distance, double coefficient, double diameter, const std::string& engine,
                  const py::object& progress) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  std::vector<SkyMeasure> measures;
  for (const std::string& name : names) measures.push_back(find(kMeasures, name, "measure"));
  auto maps = map_of(terrain, progress, [&](const HeightField& field, const Progress& report) {
    const SkyView sky(field, settings, azimuths, measures, [&](double) { return report(0); });
    return sky.rows(0, field.rows(), report);
  });
  py::list arrays;
  for (auto& map : maps) arrays.append(handed_over<float>(std::move(map), shape_of(terrain)));
  return arrays;
}

using MomentRow = std::tuple<double, double, double, double>;  // azimuth, altitude, hours, day of year

py::array sun_hours_map(const TerrainObject& terrain, const std::vector<MomentRow>& rows, double eye_height,
                        double max_distance, double coefficient, double diameter, const std::string& engine,
                        const py::object& progress) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  std::vector<SunMoment> moments;
  for (const auto& [azimuth, altitude, hours, day] : rows) moments.push_back({{azimuth, altitude}, hours, day});
  return handed_over<float>(map_of(terrain, progress,
                                   [&](const HeightField& field, const Progress& report) {
                                     const Horizons horizons(field, settings, [&](double) { return report(0); });
                                     return sun_hours(horizons, moments, 0, field.rows(), nullptr, report).hours;
                                   }),
                            shape_of(terrain));
}

#ifdef SCARP_ERFA
// Azimuth from true north and altitude in radians.
std::vector<std::pair<double, double>> sun_positions(const std::vector<std::string>& times, double longitude,
                                                     double latitude, double height, bool refraction) {
  std::vector<std::pair<double, double>> positions;
  for (const std::string& time : times) {
    const SunPosition sun = sun_position(parse_time(time), {longitude, latitude, height}, refraction);
    positions.emplace_back(sun.azimuth, sun.altitude);
  }
  return positions;
}
#endif

}  // namespace

void bind_sun(py::module_& module) {
  module.def("shadow", &shadow_map, py::arg("terrain"), py::arg("azimuth"), py::arg("altitude"), py::arg("fraction"),
             py::arg("progress"));
  module.def("horizon", &horizon_maps, py::arg("terrain"), py::arg("azimuths"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"),
             py::arg("distances"), py::arg("progress"));
  module.def("horizon_at", &horizon_at, py::arg("terrain"), py::arg("col"), py::arg("row"), py::arg("azimuths"),
             py::arg("eye_height"), py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"));
  module.def("sky_view", &sky_maps, py::arg("terrain"), py::arg("measures"), py::arg("azimuths"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"),
             py::arg("progress"));
  module.def("sun_hours", &sun_hours_map, py::arg("terrain"), py::arg("moments"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"),
             py::arg("progress"));
#ifdef SCARP_ERFA
  module.def("sun_positions", &sun_positions, py::arg("times"), py::arg("longitude"), py::arg("latitude"),
             py::arg("height"), py::arg("refraction"));
#endif
}

}  // namespace scarp::python
