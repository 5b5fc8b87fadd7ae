// SPDX-License-Identifier: MIT
// A terrain of Python: a height field over the memory of an array, or read from a file. Its pyramid is built by the
// first query that needs one: maps do not.
#pragma once

#include <pybind11/pybind11.h>

#include <mutex>
#include <optional>
#include <string>

#include "python/bind/scene_object.h"
#include "scarp/base/georeference.h"
#include "scarp/field/height_field.h"
#include "scarp/scene/terrain.h"

namespace scarp::python {

class TerrainObject : public SceneObject {
 public:
  /// Over an array, which it keeps alive. Throws as samples_of() and HeightField::view() do.
  TerrainObject(const pybind11::array& heights, bool south_up, const HeightFieldSettings& settings,
                Georeference georeference);
  /// Takes a field that owns its samples.
  TerrainObject(HeightField field, Georeference georeference);

  const Scene& scene() const override { return terrain().scene(); }
  /// Builds the pyramid if there is none.
  const Terrain& terrain() const;
  const HeightField& field() const { return field_; }
  /// Returns a field over the same samples with other cells.
  HeightField field_with_cells(double cell_x, double cell_y) const;
  const Georeference& georeference() const { return georeference_; }
  /// The array given to the constructor; None if the terrain owns its samples.
  pybind11::object array() const;

  /// Rebuilds what depends on samples that the caller changed in the array. Throws as Terrain::samples_changed() does.
  void samples_changed(const SampleRect& rect);
  /// Overwrites samples, of the array or owned by the terrain. `samples` has the field's type and the shape of the
  /// rectangle; the array is writable. Throws as Terrain::set_samples() does, and changes nothing then.
  void set_samples(const SampleRect& rect, const pybind11::array& samples);

 private:
  template <class Change>
  void edit(const Change& change);

  HeightField field_;
  Georeference georeference_;
  mutable std::once_flag built_;
  mutable std::optional<Terrain> terrain_;
};

}  // namespace scarp::python
