// SPDX-License-Identifier: MIT
// A terrain: a height field with its pyramid, ready for rays.
//
//   const auto terrain = scarp::Terrain::view(heights, cols, rows, {.cell_x = 10, .cell_y = 10});
//   const scarp::Hit hit = scarp::cast(terrain, ray);
//
// A Terrain converts to a Scene with one field. Queries use the march `max-mip`, which is exact. World space is
// right-handed, in metres: x east, y north, z up, with the south-west sample at x = y = 0.
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
struct RasterOptions;  // scarp/source/raster/raster_options.h

/// A height field with its pyramid. Copies are cheap and share their state, edits included. Thread-safe for queries,
/// but not during set_samples() and samples_changed(); to edit while other threads query, use LiveScene
/// (scarp/scene/live_scene.h) or LiveField (scarp/accel/live_field.h).
class Terrain {
 public:
  /// Reads caller-owned memory without copying it: `rows` rows of `cols` samples (std::int16_t, std::uint16_t or
  /// float), from north to south, west to east. The memory must outlive every copy of the terrain. `row_stride` is
  /// the distance between rows in samples, not bytes; 0 means `cols`. If it is negative, `samples` points to the
  /// northernmost row, which is last in memory. HeightFieldSettings describes the settings.
  ///
  /// Builds the pyramid on all threads. Throws Error for a null pointer, fewer than 1 x 1 samples, rows that overlap, a
  /// setting out of range, an infinite sample, or a shared border whose sides differ. NaN samples are holes. Unless
  /// it is periodic, a field of one row or column has no cells: every ray misses.
  ///
  /// `memory`, if not empty, owns the samples: queries throw Error once it is destroyed. The terrain does not keep it
  /// alive.
  template <class T>
  static Terrain view(const T* samples, int cols, int rows, const HeightFieldSettings& settings = {},
                      std::ptrdiff_t row_stride = 0, std::weak_ptr<const void> memory = {});
  /// Takes ownership of cols * rows samples, in the same order. Throws as view() does.
  template <class T>
  static Terrain own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings = {});
  /// Reads an elevation model in any supported format (GeoTIFF, .hgt, .asc, .npy, ...; see doc/user/inputs.md). If
  /// `path` is a folder, reads all rasters in it as one mosaic. Cell sizes are lengths on the ground, or 1 m without a
  /// georeference. Throws Error naming the file if it is missing, damaged, rotated or not a raster. In scarp::scarp,
  /// built with GDAL.
  static Terrain open(const std::string& path);
  /// As above, with options: `raster` (scarp/source/raster/raster_options.h) for band, window, nodata, ...; `field`
  /// (scarp/scene/file/from_raster.h) for exaggeration, surface, wrap, ...
  static Terrain open(const std::string& path, const RasterOptions& raster, const FieldOptions& field);
  /// Takes a height field and builds its pyramid. georeference() returns `georeference`.
  explicit Terrain(HeightField field, Georeference georeference = {});

  /// Overwrites a rectangle of samples that the terrain owns, and updates the pyramid. `row_stride` is the distance
  /// between rows of `samples`, in samples; 0 means rect.cols. T must be the field's sample type. Throws Error,
  /// changing nothing, for a rectangle that is empty or not inside the field, a null pointer, rows that overlap,
  /// another sample type, an infinite sample, a border that would no longer be shared, or a terrain made by view().
  template <class T>
  void set_samples(const SampleRect& rect, const T* samples, std::ptrdiff_t row_stride = 0);
  /// Updates the pyramid after the caller changed these samples in the memory passed to view(). Throws Error for a
  /// rectangle that is empty or not inside the field, an infinite sample, or a border that is no longer shared; in the
  /// last two cases the terrain must not be used until another call succeeds.
  void samples_changed(const SampleRect& rect);

  /// Sets the material of each cell, 0..255: SceneSurface::material of hits on it, in place of the object's. Rows run
  /// from north to south, like the samples. Empty: no materials. Scenes that contain the terrain keep the old materials
  /// until they are combined again. Throws Error unless there is one material for each cell.
  void set_materials(std::vector<std::uint8_t> materials);

  /// Returns the height of the ground at (x, y), in metres; nullopt outside the field and over holes.
  std::optional<double> height(double x, double y) const { return field().height(x, y); }

  const HeightField& field() const;
  const MaxPyramid& pyramid() const;
  /// Returns the terrain as an argument for functions of scarp/march/height. Valid as long as a copy of this terrain
  /// exists.
  HeightTarget target() const { return {&field(), &pyramid()}; }
  /// Returns the position on Earth; Georeference::present is false if it is unknown.
  const Georeference& georeference() const;

  /// Returns the scene of this field alone. After an edit, other scenes that contain it throw Error until they are
  /// combined again; a LiveScene supports edits.
  const Scene& scene() const;
  operator const Scene&() const { return scene(); }

 private:
  struct State;
  void changed(const CellBox& cells);

  std::shared_ptr<State> state_;
};

}  // namespace scarp
