// SPDX-License-Identifier: MIT
// Seeded procedural terrain of any size: what is the height at (col, row)?
//
// Gradient noise on an integer lattice, summed over octaves of halving wavelength (fbm), or folded and multiplied into
// ridges (ridged). Between octaves the domain is turned by the angle of the 3-4-5 triangle, so that lattice directions
// do not add up. A height depends on the settings and its (col, row) alone: tiles fit, whatever their size and order.
//
// Bits: hashes are integers, heights use + - * / and comparisons of doubles only (no function of libm, no fused
// multiply-add), so that every machine gets the same.
//
// Source: K. Perlin, "Improving noise", SIGGRAPH 2002; F. K. Musgrave in D. Ebert et al., "Texturing and modeling", 3rd
// ed., 2003, chapter 16 (fBm, ridged multifractal).
// Cost: about 9 octaves at the default wavelength, some 200 ns per sample on one core.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "scarp/base/progress.h"

namespace scarp {

enum class TerrainKind : std::uint8_t {
  fbm,     ///< rolling mountains
  ridged,  ///< sharp crests, smooth valleys
};

/// "fbm" or "ridged".
std::string_view name_of(TerrainKind kind);
/// The kind of that name, or nothing.
std::optional<TerrainKind> terrain_kind(std::string_view name);

inline constexpr int kLargestProceduralSide = 65536;
/// Metres; with it the highest mountains are far from the largest float32.
inline constexpr int kLargestProceduralCell = 1000000;

struct ProceduralDem {
  int cols = 1025;         ///< samples, 1..65536
  int rows = 1025;         ///< samples, 1..65536
  std::uint64_t seed = 1;  ///< any
  TerrainKind kind = TerrainKind::fbm;
  double cell_m = 30;     ///< metres from sample to sample, > 0, <= 1000000; relief is in proportion: slopes stay
  double wavelength = 0;  ///< of the largest features, in cells, >= 2; 0: min(1024, half the longer side)
};

/// Throws Error when a setting is out of its range.
void validate(const ProceduralDem& settings);

/// Writes the heights in metres of the rectangle [col, col + cols) x [row, row + rows) to out[r * stride + c]. The
/// settings must be valid; the rectangle may reach beyond their size.
void fill_rectangle(const ProceduralDem& settings, int col, int row, int cols, int rows, float* out,
                    std::ptrdiff_t stride);

/// All heights, rows from north to south, on all threads. Throws Error (settings), Interrupted.
std::vector<float> generate_dem(const ProceduralDem& settings, const Progress& progress = {});

}  // namespace scarp
