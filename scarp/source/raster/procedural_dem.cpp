// SPDX-License-Identifier: MIT
#include "scarp/source/raster/procedural_dem.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr double kFinestWavelength = 2;  // in cells; shorter waves would be noise between adjacent samples
constexpr double kLargestWavelength = kLargestProceduralSide;
constexpr int kMostOctaves = 16;  // from 65,536 to 2 cells
constexpr int kRowsPerPiece = 8;

// Amplitude ratio of successive octaves: 0.5 gives all octaves the same slope; lower values emphasise large features.
constexpr double kFbmGain = 0.47;
constexpr double kRidgedGain = 0.46;

// Heights per metre of wavelength, chosen so that mean slopes are about 20 degrees at the default feature size.
constexpr double kFbmRelief = 0.20;
constexpr double kFbmBase = 0.11;  // lifts most valleys above 0
constexpr double kRidgedRelief = 0.11;

constexpr double kNoiseToUnit = 1.5;  // |noise| beyond 0.67 is rare
constexpr double kRidgedFocus = 2.0;  // Musgrave's gain: how quickly a fold reveals the next octave

// Mixes all bits (the finaliser of SplitMix64; S. Vigna 2015, after G. Steele et al., OOPSLA 2014).
constexpr std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Twelve directions on the circle, all of exactly the same length: those of the 3-4-5 triangle and of the axes.
constexpr double kGradients[12][2] = {{1, 0},  {0.8, 0.6},   {0.6, 0.8},   {0, 1},  {-0.6, 0.8}, {-0.8, 0.6},
                                      {-1, 0}, {-0.8, -0.6}, {-0.6, -0.8}, {0, -1}, {0.6, -0.8}, {0.8, -0.6}};

struct Point {
  double x, y;
};

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Perlin's gradient noise: 0 at lattice points, between -0.71 and 0.71, features as wide as the lattice. Neighbouring
// samples mostly share a lattice square, so its gradients are cached.
class GradientNoise {
 public:
  void reseed(std::uint64_t seed) { seed_ = seed; }

  double at(Point p) {
    const std::int64_t ix = floor_of(p.x), iy = floor_of(p.y);
    if (ix != ix_ || iy != iy_ || !north_west_) {
      ix_ = ix;
      iy_ = iy;
      north_west_ = gradient(ix, iy);
      north_east_ = gradient(ix + 1, iy);
      south_west_ = gradient(ix, iy + 1);
      south_east_ = gradient(ix + 1, iy + 1);
    }
    const double dx = p.x - static_cast<double>(ix), dy = p.y - static_cast<double>(iy);
    const double u = fade(dx), v = fade(dy);
    const double nw = slope(north_west_, dx, dy), ne = slope(north_east_, dx - 1, dy);
    const double sw = slope(south_west_, dx, dy - 1), se = slope(south_east_, dx - 1, dy - 1);
    const double north = nw + u * (ne - nw), south = sw + u * (se - sw);
    return north + v * (south - north);
  }

 private:
  static std::int64_t floor_of(double x) {
    const auto i = static_cast<std::int64_t>(x);
    return i - (x < static_cast<double>(i) ? 1 : 0);
  }
  static double slope(const double* gradient, double dx, double dy) { return gradient[0] * dx + gradient[1] * dy; }
  const double* gradient(std::int64_t ix, std::int64_t iy) const {
    const std::uint64_t hash = mix(mix(seed_ + static_cast<std::uint64_t>(ix)) + static_cast<std::uint64_t>(iy));
    return kGradients[(hash >> 32) * 12 >> 32];
  }

  std::uint64_t seed_ = 0;
  std::int64_t ix_ = 0;
  std::int64_t iy_ = 0;
  const double* north_west_ = nullptr;
  const double* north_east_ = nullptr;
  const double* south_west_ = nullptr;
  const double* south_east_ = nullptr;
};

// The settings and values derived from them, for one thread.
class ProceduralTerrain {
 public:
  explicit ProceduralTerrain(const ProceduralDem& s) : kind_(s.kind) {
    wavelength_ = s.feature_size > 0 ? s.feature_size
                                     : std::max(kFinestWavelength, std::min(1024.0, std::max(s.cols, s.rows) / 2.0));
    for (double w = wavelength_; w >= kFinestWavelength && octaves_ < kMostOctaves; w /= 2) {
      noise_[octaves_].reseed(mix(s.seed * kMostOctaves + static_cast<std::uint64_t>(octaves_) + 1));
      ++octaves_;
    }
    metres_ = wavelength_ * s.cell_m;
  }

  float height(int col, int row) {
    const double sum = kind_ == TerrainKind::fbm ? fbm(start(col, row)) : ridged(start(col, row));
    return static_cast<float>(sum * metres_);
  }

 private:
  // Offset from the lattice: otherwise every octave would be zero at (0, 0).
  Point start(int col, int row) const { return {col / wavelength_ + 0.3125, row / wavelength_ + 0.6875}; }
  // The next octave: half the wavelength, rotated by the angle of the 3-4-5 triangle.
  static Point next(Point p) { return {2 * (0.8 * p.x - 0.6 * p.y), 2 * (0.6 * p.x + 0.8 * p.y)}; }

  double fbm(Point p) {
    double sum = kFbmBase, amplitude = kFbmRelief;
    for (std::size_t octave = 0; octave < octaves_; ++octave, p = next(p), amplitude *= kFbmGain) {
      sum += amplitude * noise_[octave].at(p);
    }
    return sum;
  }

  // Each octave is sharpest where it is zero, and is weighted by the previous ones: ridges fork, valleys stay smooth.
  double ridged(Point p) {
    double sum = 0, amplitude = kRidgedRelief, weight = 1;
    for (std::size_t octave = 0; octave < octaves_; ++octave, p = next(p), amplitude *= kRidgedGain) {
      const double fold = std::max(0.0, 1 - kNoiseToUnit * std::abs(noise_[octave].at(p)));
      const double ridge = fold * fold * weight;
      sum += amplitude * ridge;
      weight = std::min(1.0, kRidgedFocus * ridge);
    }
    return sum;
  }

  TerrainKind kind_;
  double wavelength_ = 0;
  double metres_ = 0;
  std::size_t octaves_ = 0;
  std::array<GradientNoise, kMostOctaves> noise_;
};

}  // namespace

std::string_view name_of(TerrainKind kind) { return kind == TerrainKind::fbm ? "fbm" : "ridged"; }

std::optional<TerrainKind> terrain_kind(std::string_view name) {
  for (const TerrainKind kind : {TerrainKind::fbm, TerrainKind::ridged}) {
    if (name_of(kind) == name) return kind;
  }
  return {};
}

void validate(const ProceduralDem& s) {
  const auto side = [](int n) { return n >= 1 && n <= kLargestProceduralSide; };
  if (!side(s.cols) || !side(s.rows)) {
    throw Error(fmt::format("procedural terrain: {} x {} samples (must be 1 x 1 to {} x {})", s.cols, s.rows,
                            kLargestProceduralSide, kLargestProceduralSide));
  }
  if (!(s.cell_m > 0 && s.cell_m <= kLargestProceduralCell)) {
    throw Error(fmt::format("procedural terrain: cells of {} m (must be above 0 and at most {} m)", s.cell_m,
                            kLargestProceduralCell));
  }
  if (s.feature_size != 0 && !(s.feature_size >= kFinestWavelength && s.feature_size <= kLargestWavelength)) {
    throw Error(fmt::format("procedural terrain: feature size of {} cells (must be {} to {}, or 0 for the default)",
                            s.feature_size, kFinestWavelength, kLargestWavelength));
  }
}

void fill_rectangle(const ProceduralDem& settings, int col, int row, int cols, int rows, float* out,
                    std::ptrdiff_t stride) {
  ProceduralTerrain terrain(settings);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) out[r * stride + c] = terrain.height(col + c, row + r);
  }
}

std::vector<float> generate_dem(const ProceduralDem& settings, const Progress& progress) {
  validate(settings);
  std::vector<float> heights(static_cast<std::size_t>(settings.cols) * static_cast<std::size_t>(settings.rows));
  parallel_for(
      settings.rows, kRowsPerPiece,
      [&](std::int64_t begin, std::int64_t end) {
        fill_rectangle(settings, 0, static_cast<int>(begin), settings.cols, static_cast<int>(end - begin),
                       heights.data() + begin * settings.cols, settings.cols);
      },
      progress);
  return heights;
}

}  // namespace scarp
