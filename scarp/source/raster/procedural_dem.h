// SPDX-License-Identifier: MIT
// Seeded procedural terrain of any size: a height for each (col, row).
//
// Gradient noise on an integer lattice, summed over octaves of halving wavelength (fbm), or folded and multiplied into
// ridges (ridged). Each octave rotates the domain by the angle of the 3-4-5 triangle, so that lattice directions do not
// add up. A height depends only on the settings and its (col, row): tiles match for any size and order.
//
// Bit-identical on all machines: hashes are integers, heights use only + - * / and comparisons of doubles (no libm
// functions, no fused multiply-add).
//
// Source: K. Perlin, "Improving noise", SIGGRAPH 2002; F. K. Musgrave in D. Ebert et al., "Texturing and modeling", 3rd
// ed., 2003, chapter 16 (fBm, ridged multifractal). Cost: about 9 octaves at the default feature size, some 200 ns per
// sample on one core.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "scarp/base/progress.h"

namespace scarp {

/// Kinds of procedural terrain.
enum class TerrainKind : std::uint8_t {
  fbm,     ///< rolling mountains
  ridged,  ///< sharp crests, smooth valleys
};

/// Returns "fbm" or "ridged".
std::string_view name_of(TerrainKind kind);
/// Returns the kind with that name, or nullopt.
std::optional<TerrainKind> terrain_kind(std::string_view name);

inline constexpr int kLargestProceduralSide = 65536;
/// Maximum cell size, metres; even the highest mountains are then far below the largest float32.
inline constexpr int kLargestProceduralCell = 1000000;

/// Settings of a procedural terrain.
struct ProceduralDem {
  int cols = 1025;         ///< samples, 1..65536
  int rows = 1025;         ///< samples, 1..65536
  std::uint64_t seed = 1;  ///< any
  TerrainKind kind = TerrainKind::fbm;
  double cell_m =
      30;  ///< sample spacing in metres, > 0, <= 1000000; relief is proportional to it, so slopes stay the same
  double feature_size = 0;  ///< wavelength of the first octave, in cells, >= 2; 0: min(1024, half the longer side)
};

/// Throws Error for a setting out of range.
void validate(const ProceduralDem& settings);

/// Writes the heights in metres of the rectangle [col, col + cols) x [row, row + rows) to out[r * stride + c]. The
/// settings must be valid; the rectangle may extend beyond their size.
void fill_rectangle(const ProceduralDem& settings, int col, int row, int cols, int rows, float* out,
                    std::ptrdiff_t stride);

/// Returns all heights, rows from north to south, computed on all threads. Throws Error for invalid settings, and
/// Interrupted.
std::vector<float> generate_dem(const ProceduralDem& settings, const Progress& progress = {});

}  // namespace scarp
