// SPDX-License-Identifier: MIT
// Blocks of a raster for maps of horizons and shadows, each with the cell lengths and the north at its middle:
//
//   projected rasters   blocks in which the lengths of cells change by little, and for azimuths also grid north against
//                       true north
//   degrees             strips of rows, in which a step along the columns has nearly the same length; north is up
//   a sun per pixel     also blocks in which the zenith turns by little
//
// Blocks count from the raster's north-west sample: every part of a map has those of the whole. The engine `sweep` has
// one block, because each block would need sweeps over the whole raster.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/horizon_options.h"

namespace scarp::cli {

struct HorizonFrame {
  NodeRect nodes;     ///< of the part that was read
  dvec2 cells;        ///< lengths in metres
  double grid_north;  ///< azimuth of grid north, radians
  dvec2 middle;       ///< of the block, in columns and rows of the raster
};

/// Properties of blocks that a map depends on, each in addition to those before it.
enum class FrameUse : std::uint8_t { lengths, north, suns };

class HorizonFrames {
 public:
  /// Before samples are read. `plane_error`: that of MapOptions. Throws Error if samples within the reach of `horizon`
  /// are displaced by more.
  HorizonFrames(MapInput& input, const HorizonInput& horizon, double plane_error, FrameUse use);

  /// The blocks that cover rows of the part that was read.
  std::vector<HorizonFrame> of(MapInput& input, const RowBand& rows) const;

  /// Columns and rows of a block.
  int cols() const { return cols_; }
  int rows() const { return rows_; }

  /// Whether one block covers the raster.
  bool single() const { return single_; }

  /// BLOCKS: their size and what it costs, if there is more than one.
  Metadata metadata() const;

 private:
  void divide_degrees(MapInput& input, const HorizonInput& horizon, double plane_error);
  void divide_by_lengths(MapInput& input, const HorizonInput& horizon, double plane_error);
  void divide_by_north(MapInput& input, bool swept);

  int cols_, rows_;  // of a block
  bool geographic_ = false, single_ = true;
  std::optional<double> north_off_;  // radians between a corner of a block and its middle; nullopt: not a property
};

/// Calls body(frame, progress) for each frame, on all threads at once.
void for_each_frame(const std::vector<HorizonFrame>& frames,
                    const std::function<void(const HorizonFrame&, const Progress&)>& body, const Progress& progress);

/// Copies the values of a frame to their places in those of `rows`, `cols` a row.
template <class T>
void paste(const std::vector<T>& values, const HorizonFrame& frame, const RowBand& rows, int cols, std::vector<T>& to) {
  const int width = frame.nodes.col_end - frame.nodes.col_begin;
  for (int row = frame.nodes.row_begin; row < frame.nodes.row_end; ++row) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(row - frame.nodes.row_begin) * width;
    const auto at = static_cast<std::ptrdiff_t>(row - rows.first) * cols + frame.nodes.col_begin;
    std::copy(from, from + width, to.begin() + at);
  }
}

}  // namespace scarp::cli
