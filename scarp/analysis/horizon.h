// SPDX-License-Identifier: MIT
// Horizons: for every node of a field and an azimuth, the elevation angle up to which the ground hides the sky.
//
//   const scarp::Horizons horizons(field);
//   const auto south = horizons.rows(std::numbers::pi, 0, field.rows());     // radians, rows from north to south
//
// horizon_crossings.h has the definition: the ground is linear where the line of sight crosses a grid line (`crossings`
// of sight.h), and the horizon is the largest slope over all crossings, in floats by one expression. Angles below zero
// are kept: a node on a summit sees down to them. The results depend on no thread, vector width or band of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scarp/analysis/sight.h"
#include "scarp/base/progress.h"
#include "scarp/field/height_field.h"

namespace scarp {

enum class HorizonEngine : std::uint8_t {
  exact,  ///< every crossing, skipped only by proof
  /// Every crossing up to 8 steps away, beyond them one per node, found by hulls of lines (horizon_sweep.h): several
  /// times as fast. 99 of 100 angles are off by less than half a degree on most ground, single ones by more.
  sweep
};

struct HorizonSettings {
  double eye_height = 0;                                          ///< metres above the ground, >= 0, finite
  double max_distance = std::numeric_limits<double>::infinity();  ///< metres; ground farther away does not count; > 0
  SightCurvature curvature{};
  HorizonEngine engine = HorizonEngine::exact;
  /// Bytes for the heights and what is built from them, above 0. If they take more, strips of the ground are copied
  /// from an array of 4 bytes per node, which the caller may keep in a file, and dropped after use. The results are the
  /// same.
  double memory = std::numeric_limits<double>::infinity();
};

/// Nodes [col_begin, col_end) x [row_begin, row_end).
struct NodeRect {
  int col_begin, row_begin, col_end, row_end;
  std::size_t count() const {
    return static_cast<std::size_t>(col_end - col_begin) * static_cast<std::size_t>(row_end - row_begin);
  }
};

/// Horizons of nodes, rows from north to south.
struct HorizonRows {
  /// Radians above the horizontal, -pi/2 to pi/2. NaN on a hole; -pi/2 where the line meets no ground within the field
  /// and the distance.
  std::vector<float> angle;
  /// Metres to the ground that is the horizon; NaN on a hole and without ground. Empty unless requested.
  std::vector<float> distance;
};

class Horizons {
 public:
  /// Copies the heights, as floats, and builds maxima over them: about 9 bytes per node, and 512 per row and column of
  /// the border. The engine sweep keeps two copies, 8 bytes per node. HorizonSettings::memory limits both. Throws Error
  /// for a wrapped field, a side above kMaxSightSide, a setting out of range, and a maximum distance for the engine
  /// sweep; Interrupted.
  explicit Horizons(const HeightField& field, const HorizonSettings& settings = {}, const Progress& progress = {});

  /// Rows [first, last) for an azimuth in radians clockwise from grid north, finite. Runs on all threads. Throws Error
  /// for rows outside the field and for none; Interrupted.
  HorizonRows rows(double azimuth, int first, int last, bool distances = false, const Progress& progress = {}) const;

  /// The same of a block of nodes, in rows of the block. The engine sweep sweeps whole lines. Throws Error for an empty
  /// block and for nodes outside the field; Interrupted.
  HorizonRows block(double azimuth, const NodeRect& nodes, bool distances = false, const Progress& progress = {}) const;

  /// The same heights, shared, with cells of other lengths in metres: for nodes in a part of a field whose cells vary.
  /// Throws Error for lengths that are not finite and above 0.
  Horizons with_cells(double cell_x, double cell_y) const;

  struct State;  ///< private to scarp/analysis

 private:
  friend const State& state_of(const Horizons& horizons);
  explicit Horizons(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

/// The horizon of one place.
struct HorizonView {
  double angle = 0;                ///< radians, as in HorizonRows
  std::optional<double> distance;  ///< metres to the ground that is the horizon; nullopt without ground
};

/// The horizon seen from a place, `col` and `row` in cells, for an azimuth in radians clockwise from grid north: every
/// crossing, one after another, in double. The eye is above the bilinear ground. `cells`: lengths of a column and a row
/// step there in metres, if not those of the field. nullopt outside the field and over holes. Throws Error as Horizons
/// does.
std::optional<HorizonView> horizon_from(const HeightField& field, double col, double row, double azimuth,
                                        const HorizonSettings& settings = {}, const std::optional<dvec2>& cells = {});

/// Throws Error if a member is out of range.
void validate(const HorizonSettings& settings);

}  // namespace scarp
