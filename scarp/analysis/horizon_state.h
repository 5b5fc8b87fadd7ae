// SPDX-License-Identifier: MIT
// Private to scarp/analysis: what Horizons keeps, shared by the questions about the sky.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/horizon_ground.h"
#include "scarp/analysis/horizon_scan.h"
#include "scarp/analysis/horizon_sweep.h"
#include "scarp/analysis/horizon_tiles.h"

namespace scarp {

/// Memory of strips, which threads wait for and use again.
class StripMemory {
 public:
  explicit StripMemory(double bytes) : bytes_(bytes) {}
  double bytes() const { return bytes_; }
  void take(double bytes);
  void give(double bytes);
  /// An array that a strip has left, or none.
  LargeVector<float> spare();
  void keep(LargeVector<float> array);

 private:
  const double bytes_;
  double used_ = 0;
  std::vector<LargeVector<float>> spares_;
  std::mutex mutex_;
  std::condition_variable given_;
};

/// Heights as an engine needs them.
struct HorizonRelief {
  /// `sign`: 1, or -1 for the ground upside down. `eye_height`: metres above the ground. `memory`: that of
  /// HorizonSettings. Throws Error if it is not enough for the coarse maxima; Interrupted.
  HorizonRelief(const HeightField& field, HorizonEngine engine, int sign, float eye_height, double memory,
                const Progress& progress);

  std::optional<HorizonGround> ground;                // exact
  std::optional<HorizonHeights> heights, transposed;  // sweep
  // Instead of these, if they take more than `memory`: strips are made from tiles.
  std::optional<HorizonTiles> tiles;
  std::shared_ptr<const HorizonGround::CoarseMaxima> coarse;  // exact
  std::unique_ptr<StripMemory> strips;
  float eye;

  /// Copies the heights of nodes of a row of the field, as floats.
  void copy_heights(int col, int row, int count, float* to) const;
};

struct Horizons::State {
  HeightField field;
  HorizonSettings settings;
  dvec2 cells;  ///< lengths in metres, which may differ from those of the field
  std::shared_ptr<const HorizonRelief> relief;

  HorizonCrossings crossings(double azimuth) const {
    return HorizonCrossings(field, azimuth, settings.max_distance, settings.curvature, cells);
  }
};

const Horizons::State& state_of(const Horizons& horizons);

/// horizon_from() for an eye at a height, over nodes of any source, lowered by curvature; nullopt: a hole. `cells`:
/// their lengths in metres.
HorizonView horizon_over(const HeightField& field, const dvec2& cells, double col, double row, double azimuth,
                         double eye, double max_distance, const std::function<std::optional<double>(Node)>& lowered);

/// The slopes of the horizons of a block of nodes in one of the azimuths, rows of the block's width.
struct HorizonBlock {
  NodeRect nodes;
  std::size_t azimuth;  ///< index
  const float* slopes;
  const std::int32_t* entries;  ///< for distances; -1 without ground
  const float* distances;       ///< of entries; horizontal metres
};

/// Throws Error if there is less than `bytes` of `memory` for something of a field.
void require_strip_memory(const char* what, int cols, int rows, double bytes, double memory);

using HorizonBody = std::function<void(const HorizonBlock&)>;

/// Throws Error for a rectangle without nodes and one that is not inside the field.
void require_nodes(const HeightField& field, const NodeRect& nodes);

/// Finds the horizons of a block of nodes for each azimuth (radians from grid north), on all threads: body(block) for
/// blocks that cover all nodes for each azimuth; those of a node come in the order of the azimuths, one at a time.
/// `relief` is that of the state, or the same upside down. Throws as require_nodes() does; Interrupted.
void for_each_horizon(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                      const NodeRect& nodes, const HorizonBody& body, const Progress& progress);

/// for_each_horizon() by strips, each in memory of its own while it is used. Throws Error if a strip needs more memory
/// than there is.
void scan_strips(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                 const NodeRect& nodes, const HorizonBody& body, const Progress& progress);
void sweep_strips(const Horizons::State& state, const HorizonRelief& relief, std::span<const double> azimuths,
                  const NodeRect& nodes, const HorizonBody& body, const Progress& progress);

/// The lines of a sweep that matter for a block of nodes.
struct SweptNodes {
  std::size_t azimuth;
  bool transposed;
  NodeRect inner;  ///< in the rows and columns of the heights
  int visits;      ///< rows nearer than the nodes hide nothing in them
  int first_line, strips;

  SweptNodes(std::size_t azimuth, bool transposed, const SweepTable& table, int rows, const NodeRect& nodes);
  int line(std::int64_t strip) const { return first_line + static_cast<int>(strip) * kSweptLines; }
};

/// Sweeps kSweptLines lines. `long_rows`: passes on pieces of rows that are longer.
void sweep_lines(const HorizonHeights& heights, const SweepTable& table, float eye, const SweptNodes& swept,
                 std::int64_t strip, const HorizonBody& body, bool long_rows);

}  // namespace scarp
