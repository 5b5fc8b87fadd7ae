// SPDX-License-Identifier: MIT
// Maps of a terrain: tasks that compute some of its rows, which are those of the whole map (map_part.h).
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "python/bind/tasks.h"
#include "python/bind/terrain_object.h"
#include "scarp/analysis/map_part.h"
#include "scarp/base/error.h"

namespace scarp::python {

/// Rows as Python passes them: first, and the one after the last, from north.
using RowPair = std::pair<int, int>;

/// Shape of one map of these rows.
inline std::vector<pybind11::ssize_t> shape_of(const TerrainObject& terrain, const RowBand& rows) {
  return {rows.rows(), terrain.field().cols()};
}

/// Shape of several maps of these rows.
inline std::vector<pybind11::ssize_t> shape_of(const TerrainObject& terrain, const RowBand& rows, std::size_t maps) {
  return {static_cast<pybind11::ssize_t>(maps), rows.rows(), terrain.field().cols()};
}

/// Runs map(field, rows, progress) as a task, and returns its result. Throws Error for rows that are not in the field.
template <class Map>
auto map_of(const TerrainObject& terrain, const RowPair& rows, const pybind11::object& progress, const Map& map) {
  require_memory(terrain);
  const RowBand band{rows.first, rows.second};
  return result_of_task(progress, [&](const Progress& report) {
    const auto locks = shared_locks(terrain);
    require_band(terrain.field(), band);
    return map(terrain.field(), band, report);
  });
}

}  // namespace scarp::python
