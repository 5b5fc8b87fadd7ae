// SPDX-License-Identifier: MIT
// Maps of sun and sky, in the library's units: metres, radians from grid north.
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "python/bind/maps.h"
#include "python/bind/names.h"
#include "python/bind/terrain_object.h"
#include "scarp/analysis/horizon.h"
#include "scarp/analysis/shadow.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/analysis/sun_disc.h"
#include "scarp/analysis/sun_hours.h"
#include "scarp/base/progress_part.h"
#ifdef SCARP_ERFA
#include "scarp/analysis/sun_position.h"
#ifdef SCARP_PYTHON_FILES
#include "scarp/analysis/local_sun.h"
#include "scarp/source/raster/node_places.h"
#endif
#endif

namespace scarp::python {
namespace {

namespace py = pybind11;

constexpr Named<HorizonEngine> kEngines[] = {{"exact", HorizonEngine::exact}, {"sweep", HorizonEngine::sweep}};
constexpr Named<SkyMeasure> kMeasures[] = {{"sky-fraction", SkyMeasure::sky_fraction},
                                           {"sky-view-factor", SkyMeasure::sky_view_factor},
                                           {"positive-openness", SkyMeasure::positive_openness},
                                           {"negative-openness", SkyMeasure::negative_openness}};

HorizonSettings horizon_settings(double eye_height, double max_distance, double coefficient, double diameter,
                                 const std::string& engine) {
  return {eye_height, max_distance, {coefficient, diameter}, find(kEngines, engine, "engine")};
}

// Shares of the sun's disc, NaN without a sample.
std::vector<float> with_nan(std::vector<float> shares) {
  for (float& share : shares)
    if (share == kNoShare) share = std::numeric_limits<float>::quiet_NaN();
  return shares;
}

// Codes as `scarp shadow` writes them: 0 lit, 1 self-shaded, 2 cast shadow, 255 no sample.
std::vector<Shade> with_nodata(std::vector<Shade> shades) {
  for (Shade& shade : shades)
    if (shade == Shade::hole) shade = Shade{255};
  return shades;
}

// Shares of light in [0, 1], or codes, by functions of the field, a band and the progress.
template <class Shares, class Codes>
py::array light_map(const TerrainObject& terrain, bool fraction, const RowPair& rows, const py::object& progress,
                    const Shares& shares, const Codes& codes) {
  const auto shape = shape_of(terrain, {rows.first, rows.second});
  if (fraction)
    return handed_over<float>(
        map_of(terrain, rows, progress, [&](const auto&... asked) { return with_nan(shares(asked...)); }), shape);
  return handed_over<std::uint8_t>(
      map_of(terrain, rows, progress, [&](const auto&... asked) { return with_nodata(codes(asked...)); }), shape);
}

py::array shadow_map(const TerrainObject& terrain, double azimuth, double altitude, bool fraction, const RowPair& rows,
                     const py::object& progress) {
  const SunDirection sun{azimuth, altitude};
  return light_map(
      terrain, fraction, rows, progress,
      [&](const HeightField& field, const RowBand& band, const Progress& report) {
        return lit_share(field, sun, band, report);
      },
      [&](const HeightField& field, const RowBand& band, const Progress& report) {
        return shadow_rows(field, sun, band, report);
      });
}

#if defined(SCARP_ERFA) && defined(SCARP_PYTHON_FILES)
// The same with the sun of a time, or a fixed direction from true north, at every node.
py::array local_shadow_map(const TerrainObject& terrain, const std::optional<std::string>& time, bool refraction,
                           double azimuth, double altitude, bool fraction, const RowPair& rows,
                           const py::object& progress) {
  const NodePlaces places(terrain.georeference(), terrain.field().cols(), terrain.field().rows());
  LocalSun sun{.refraction = refraction,
               .places = [&](int row, int first_col, std::span<dvec3> nodes) { places.row(row, first_col, nodes); }};
  if (time) {
    sun.time = parse_time(*time);
  } else {
    sun.fixed = SunDirection{azimuth, altitude};
  }
  return light_map(
      terrain, fraction, rows, progress,
      [&](const HeightField& field, const RowBand& band, const Progress& report) {
        return local_lit_share(field, sun, band, report);
      },
      [&](const HeightField& field, const RowBand& band, const Progress& report) {
        return local_shadow(field, sun, band, report);
      });
}
#endif

// Angles in radians of (azimuths, rows, columns) and, with `distances`, metres.
py::tuple horizon_maps(const TerrainObject& terrain, const std::vector<double>& azimuths, double eye_height,
                       double max_distance, double coefficient, double diameter, const std::string& engine,
                       bool distances, const RowPair& rows, const py::object& progress) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  HorizonRows all =
      map_of(terrain, rows, progress, [&](const HeightField& field, const RowBand& band, const Progress& report) {
        const Horizons horizons(field, settings, [&](double) { return report(0); });
        HorizonRows found;
        const auto all_nodes = azimuths.size() * shape_of(terrain, band)[0] * shape_of(terrain, band)[1];
        found.angle.reserve(all_nodes);
        if (distances) found.distance.reserve(all_nodes);
        for (std::size_t i = 0; i < azimuths.size(); ++i) {
          HorizonRows of_one =
              horizons.rows(azimuths[i], band.first, band.last, distances,
                            progress_part(report, static_cast<double>(i), static_cast<double>(azimuths.size())));
          if (azimuths.size() == 1) return of_one;
          found.angle.insert(found.angle.end(), of_one.angle.begin(), of_one.angle.end());
          found.distance.insert(found.distance.end(), of_one.distance.begin(), of_one.distance.end());
        }
        return found;
      });
  const auto shape = shape_of(terrain, {rows.first, rows.second}, azimuths.size());
  py::object metres = py::none();
  if (distances) metres = handed_over<float>(std::move(all.distance), shape);
  return py::make_tuple(handed_over<float>(std::move(all.angle), shape), metres);
}

constexpr std::size_t kPlacesPerSignal = 128;  // numbers of a table between two looks for Ctrl-C

// Horizons of one place, with the lengths of cells there: rows of angle (radians) and distance (NaN without ground);
// None over holes and outside.
py::object horizon_at(const TerrainObject& terrain, double col, double row, const std::vector<double>& azimuths,
                      double eye_height, double max_distance, double coefficient, double diameter, double cell_x,
                      double cell_y) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, "exact");
  std::vector<double> table;
  {
    const Query query(terrain);
    for (const double azimuth : azimuths) {
      if (table.size() % kPlacesPerSignal == 0) check_signals();
      const auto view = horizon_from(terrain.field(), col, row, azimuth, settings, dvec2(cell_x, cell_y));
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
                  const RowPair& rows, const py::object& progress) {
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  std::vector<SkyMeasure> measures;
  for (const std::string& name : names) measures.push_back(find(kMeasures, name, "measure"));
  auto maps =
      map_of(terrain, rows, progress, [&](const HeightField& field, const RowBand& band, const Progress& report) {
        const SkyView sky(field, settings, azimuths, measures, [&](double) { return report(0); });
        return sky.rows(band.first, band.last, report);
      });
  py::list arrays;
  for (auto& map : maps)
    arrays.append(handed_over<float>(std::move(map), shape_of(terrain, {rows.first, rows.second})));
  return arrays;
}

using MomentRow = std::tuple<double, double, double, double>;   // azimuth, altitude, hours, day of year
using Sky = std::tuple<double, double, std::optional<double>>;  // Linke turbidity, albedo, transmittance

std::vector<SunMoment> moments_of(const std::vector<MomentRow>& rows) {
  std::vector<SunMoment> moments;
  for (const auto& [azimuth, altitude, hours, day] : rows) moments.push_back({{azimuth, altitude}, hours, day});
  return moments;
}

// Arrays of hours, the indices of the first and the last moment with sun (-1: none) and, with a sky, beam, diffuse and
// reflected energy.
py::list sun_hours_maps(const TerrainObject& terrain, const std::vector<MomentRow>& suns, double eye_height,
                        double max_distance, double coefficient, double diameter, const std::string& engine,
                        const std::optional<Sky>& sky, const RowPair& rows, const py::object& progress) {
  constexpr int kSkyAzimuths = 64;  // of the sky view factor, as `scarp sunhours`
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  const std::vector<SunMoment> moments = moments_of(suns);
  SunHours found =
      map_of(terrain, rows, progress, [&](const HeightField& field, const RowBand& band, const Progress& report) {
        const Progress preparing = [&](double) { return report(0); };
        const Horizons horizons(field, settings, preparing);
        if (!sky) return sun_hours(horizons, moments, band.first, band.last, nullptr, report);
        const SkyView view(field, settings, kSkyAzimuths, {SkyMeasure::sky_view_factor}, preparing);
        const auto factors = view.rows(band.first, band.last, preparing);
        const auto& [linke, albedo, transmittance] = *sky;
        const ClearSkyGround ground{linke, albedo, factors[0], transmittance};
        return sun_hours(horizons, moments, band.first, band.last, &ground, report);
      });
  const auto shape = shape_of(terrain, {rows.first, rows.second});
  py::list arrays;
  arrays.append(handed_over<float>(std::move(found.hours), shape));
  for (auto* indices : {&found.first, &found.last})
    arrays.append(handed_over<std::int32_t>(std::move(*indices), shape));
  if (!sky) return arrays;
  for (auto* part : {&found.energy.beam, &found.energy.diffuse, &found.energy.reflected})
    arrays.append(handed_over<float>(std::move(*part), shape));
  return arrays;
}

// An array of (moments, rows, columns): 1 in the sun, 0 in the shade, 255 no sample.
py::array sun_mask_maps(const TerrainObject& terrain, const std::vector<MomentRow>& suns, double eye_height,
                        double max_distance, double coefficient, double diameter, const std::string& engine,
                        const RowPair& rows, const py::object& progress) {
  constexpr std::uint8_t kHole = 255;
  const HorizonSettings settings = horizon_settings(eye_height, max_distance, coefficient, diameter, engine);
  const std::vector<SunMoment> moments = moments_of(suns);
  auto codes =
      map_of(terrain, rows, progress, [&](const HeightField& field, const RowBand& band, const Progress& report) {
        const Horizons horizons(field, settings, [&](double) { return report(0); });
        std::vector<std::uint8_t> lit;
        for (std::size_t i = 0; i < moments.size(); ++i) {
          const auto part = progress_part(report, static_cast<double>(i), static_cast<double>(moments.size()));
          for (const float hours : sun_hours(horizons, {&moments[i], 1}, band.first, band.last, nullptr, part).hours)
            lit.push_back(std::isnan(hours) ? kHole : static_cast<std::uint8_t>(hours > 0));
        }
        return lit;
      });
  return handed_over<std::uint8_t>(std::move(codes), shape_of(terrain, {rows.first, rows.second}, moments.size()));
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
             py::arg("rows"), py::arg("progress"));
#if defined(SCARP_ERFA) && defined(SCARP_PYTHON_FILES)
  module.def("local_shadow", &local_shadow_map, py::arg("terrain"), py::arg("time"), py::arg("refraction"),
             py::arg("azimuth"), py::arg("altitude"), py::arg("fraction"), py::arg("rows"), py::arg("progress"));
#endif
  module.def("horizon", &horizon_maps, py::arg("terrain"), py::arg("azimuths"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"),
             py::arg("distances"), py::arg("rows"), py::arg("progress"));
  module.def("horizon_at", &horizon_at, py::arg("terrain"), py::arg("col"), py::arg("row"), py::arg("azimuths"),
             py::arg("eye_height"), py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"),
             py::arg("cell_x"), py::arg("cell_y"));
  module.def("sky_view", &sky_maps, py::arg("terrain"), py::arg("measures"), py::arg("azimuths"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"), py::arg("rows"),
             py::arg("progress"));
  module.def("sun_hours", &sun_hours_maps, py::arg("terrain"), py::arg("moments"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"), py::arg("sky"),
             py::arg("rows"), py::arg("progress"));
  module.def("sun_masks", &sun_mask_maps, py::arg("terrain"), py::arg("moments"), py::arg("eye_height"),
             py::arg("max_distance"), py::arg("coefficient"), py::arg("diameter"), py::arg("engine"), py::arg("rows"),
             py::arg("progress"));
#ifdef SCARP_ERFA
  module.def("sun_positions", &sun_positions, py::arg("times"), py::arg("longitude"), py::arg("latitude"),
             py::arg("height"), py::arg("refraction"));
#endif
}

}  // namespace scarp::python
