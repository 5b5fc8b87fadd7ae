// SPDX-License-Identifier: MIT
// All rays of a camera or a scanner over a terrain.
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "python/bind/terrain_object.h"
#include "scarp/scene/cast_from.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

using Three = std::array<double, 3>;

dvec3 vector_of(const Three& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// The arrays t, status, col, row, u, v and, if computed, the three components of normals, each (rows, columns).
py::list arrays_of(FanAnswers&& answers) {
  const std::vector<py::ssize_t> shape{answers.rows, answers.columns};
  py::list arrays;
  arrays.append(handed_over<float>(std::move(answers.t), shape));
  arrays.append(handed_over<std::uint8_t>(std::move(answers.status), shape));
  arrays.append(handed_over<std::int32_t>(std::move(answers.col), shape));
  arrays.append(handed_over<std::int32_t>(std::move(answers.row), shape));
  arrays.append(handed_over<float>(std::move(answers.u), shape));
  arrays.append(handed_over<float>(std::move(answers.v), shape));
  if (answers.nx.empty()) return arrays;
  arrays.append(handed_over<float>(std::move(answers.nx), shape));
  arrays.append(handed_over<float>(std::move(answers.ny), shape));
  arrays.append(handed_over<float>(std::move(answers.nz), shape));
  return arrays;
}

template <class Instrument>
py::list answered(const TerrainObject& terrain, const Instrument& instrument, int rows, bool normals) {
  FanAnswers answers;
  {
    const Query query(terrain);
    answers = FanAnswers(instrument.columns, rows, normals);
    cast_from(terrain.terrain(), instrument, answers);
  }
  return arrays_of(std::move(answers));
}

}  // namespace

void bind_fans(py::module_& module) {
  module.def(
      "cast_from_camera",
      [](const TerrainObject& terrain, const Three& eye, const Three& forward, const Three& up, int columns, int rows,
         double tan_half_width, double t_min, double t_max, bool normals) {
        const PinholeCamera camera{vector_of(eye), vector_of(forward), vector_of(up), columns,
                                   rows,           tan_half_width,     t_min,         t_max};
        return answered(terrain, camera, rows, normals);
      },
      py::arg("terrain"), py::arg("eye"), py::arg("forward"), py::arg("up"), py::arg("columns"), py::arg("rows"),
      py::arg("tan_half_width"), py::arg("t_min"), py::arg("t_max"), py::arg("normals"));
  module.def(
      "cast_from_scanner",
      [](const TerrainObject& terrain, const Three& eye, std::vector<double> elevations, int columns,
         double first_azimuth, double azimuth_step, double t_min, double t_max, bool normals) {
        const auto rows = static_cast<int>(elevations.size());
        const Scanner scanner{vector_of(eye), std::move(elevations), columns, first_azimuth, azimuth_step, t_min,
                              t_max};
        return answered(terrain, scanner, rows, normals);
      },
      py::arg("terrain"), py::arg("eye"), py::arg("elevations"), py::arg("columns"), py::arg("first_azimuth"),
      py::arg("azimuth_step"), py::arg("t_min"), py::arg("t_max"), py::arg("normals"));
}

}  // namespace scarp::python
