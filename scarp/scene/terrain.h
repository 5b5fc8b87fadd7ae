// SPDX-License-Identifier: MIT
// A terrain: a height field with its pyramid, ready for rays.
//
//   const auto terrain = scarp::Terrain::view(heights, cols, rows, {.cell_x = 10, .cell_y = 10});
//   const scarp::Hit hit = scarp::cast(terrain, ray);
//
// A terrain is a scene of one field: it can be passed wherever a Scene is expected. Rays are answered by `max-mip`,
// which is exact. World space is right-handed, in metres: the south-west sample is at x = y = 0, x east, y north, z up.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/base/georeference.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/height_target.h"
#include "scarp/scene/scene.h"

namespace scarp {

struct FieldOptions;   // scarp/scene/file/from_raster.h
struct RasterOptions;  // scarp/source/raster_options.h

/// A height field with its pyramid. Copies are cheap and are the same terrain. May be queried from many threads at
/// once, but not during set_samples() and samples_changed() (accel/live_field.h edits a field between the queries of
/// others).
class Terrain {
 public:
  /// Reads caller-owned memory without copying it: `rows` rows of `cols` samples (std::int16_t, std::uint16_t or
  /// float), from north to south, west to east. The memory must outlive every copy of the terrain. `row_stride`:
  /// samples, not bytes, from one row to the next; negative for rows from south to north (`samples` is the last row
  /// then); 0: `cols`. Settings: cell size in metres, scale and offset of samples, nodata, surface, wrap; see
  /// HeightFieldSettings.
  ///
  /// Builds the pyramid, on all threads. Throws Error for a null pointer, fewer than 1 x 1 samples, rows that overlap,
  /// a setting out of range, an infinite sample. NaN is a hole. 1 x N samples have no cells: every ray misses.
  template <class T>
  static Terrain view(const T* samples, int cols, int rows, const HeightFieldSettings& settings = {},
                      std::ptrdiff_t row_stride = 0);
  /// Takes ownership of cols * rows samples, in the same order. Throws as view() does.
  template <class T>
  static Terrain own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings = {});
  /// Reads an elevation model in any supported format (GeoTIFF, .hgt, .asc, .npy, ...; doc/user/inputs.md); a folder
  /// stands for the tiles in it. Cells have their size on the ground; without a georeference they are 1 m. In
  /// scarp::scarp, built with GDAL. Throws Error naming the file: missing, not a raster, damaged, rotated.
  static Terrain open(const std::string& path);
  /// The same with options: band, window, nodata, ...; exaggeration, surface, wrap.
  static Terrain open(const std::string& path, const RasterOptions& raster, const FieldOptions& field);
  /// Builds the pyramid of a field. `georeference`: its place on Earth, for georeference().
  explicit Terrain(HeightField field, Georeference georeference = {});

  /// Overwrites a rectangle of samples of a terrain that owns them, and updates the pyramid. `row_stride` as in view();
  /// 0: rect.cols. T must be the field's sample type. Throws Error, changing nothing, for a rectangle that is not
  /// inside the field, a null pointer, another sample type, an infinite sample, or a terrain made by view().
  template <class T>
  void set_samples(const SampleRect& rect, const T* samples, std::ptrdiff_t row_stride = 0);
  /// Updates the pyramid after the caller changed these samples in the memory of view(). Throws Error for a rectangle
  /// that is not inside the field, or for an infinite sample; the terrain must not be used until another call succeeds.
  void samples_changed(const SampleRect& rect);

  /// z of the ground at (x, y), metres; nullopt outside the field and over holes.
  std::optional<double> height(double x, double y) const { return field().height(x, y); }

  const HeightField& field() const;
  const MaxPyramid& pyramid() const;
  /// The terrain for functions of march/height. Refers to this terrain.
  HeightTarget target() const { return {&field(), &pyramid()}; }
  /// Place on Earth and cell size; `present` is false if there is none.
  const Georeference& georeference() const;

  /// The scene of this field alone. Scenes that were combined from it before an edit must be combined again.
  const Scene& scene() const;
  operator const Scene&() const { return scene(); }

 private:
  struct State;
  void changed(const CellBox& cells);

  std::shared_ptr<State> state_;
};

}  // namespace scarp
