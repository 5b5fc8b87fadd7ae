// SPDX-License-Identifier: MIT
// Terrain functions: small immutable trees of settings that describe a procedural terrain.
//
//   auto hills = make_function(Fractal{.wavelength = 2000, .height = 400});
//   auto bay = make_function(Minimum{hills, make_function(Plane{.height = 0})});
//
// Trees may share nodes. Lengths and heights are metres, angles radians. make_function() rejects settings out of range,
// so every Function is valid.
#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "scarp/base/vec.h"
#include "scarp/field/noise.h"

namespace scarp {

struct FunctionNode;
using Function = std::shared_ptr<const FunctionNode>;

/// Maximum of every setting (lengths, heights, factors), so that nothing overflows.
inline constexpr double kMostMetres = 0x1p30;
/// Maximum depth of a tree.
inline constexpr int kDeepestFunction = 256;

/// height + slope_x * x + slope_y * y.
struct Plane {
  double height = 0;
  double slope_x = 0, slope_y = 0;  ///< metres per metre
};

/// Sum of amplitude * sin(2 pi (x cos(towards) + y sin(towards)) / wavelength + phase).
struct Sine {
  double amplitude = 1;
  double wavelength = 100;  ///< > 0
  double towards = 0;       ///< direction, counter-clockwise from east
  double phase = 0;
};
/// Sum of sine waves.
struct Sines {
  std::vector<Sine> waves;  ///< at least one
};

inline constexpr int kMostOctaves = 24;

/// Octaves per purpose, 1..kMostOctaves: normals may be finer than the marched surface. Each count is a different
/// surface: with different counts for march and shadow, hits and occlusion may disagree.
struct Octaves {
  int march = 9;
  int shadow = 9;
  int normal = 12;
};

/// How octaves are combined.
enum class FractalForm : std::uint8_t {
  fbm,     ///< sum of octaves
  ridged,  ///< each octave is folded at 0 into ridges and weighted by the previous ones
};

/// Octaves of noise, each rotated against the previous one. Source: F. K. Musgrave in D. Ebert et al., "Texturing and
/// modeling", 3rd ed., 2003, chapter 16; damping as in I. Quilez, "Elevated", 2009.
struct Fractal {
  FractalForm form = FractalForm::fbm;
  NoiseKind noise = NoiseKind::perlin;
  std::uint64_t seed = 1;
  double wavelength = 1000;  ///< of the first octave, > 0
  double height = 200;       ///< amplitude of the first octave, >= 0
  double gain = 0.5;         ///< amplitude ratio of successive octaves, 0 < gain <= 1
  double lacunarity = 2;     ///< wavelength ratio of successive octaves, 1..8
  dvec2 turn{0.8, 0.6};      ///< rotation from one octave to the next: cosine and sine of the angle
  double damping = 0;        ///< k >= 0: octaves are weighted by 1 / (1 + k |d|^2), where d is the sum of the noise
                             ///< gradients
  double focus = 2;          ///< for ridged: how quickly a ridge reveals the next octave, > 0
  Octaves octaves{};
};

/// base at (x + shift_x(x, y), y + shift_y(x, y)).
struct Warp {
  Function base, shift_x, shift_y;
};

/// Steps of equal height, flat except for the last part of each.
struct Terraces {
  Function base;
  double step = 10;   ///< metres, > 0
  double rise = 0.3;  ///< fraction of a step in which the ground rises to the next, 0 < rise <= 1
};

/// 1 within `inner` of the centre, 0 beyond `outer`, with a quintic fade between.
struct RadialMask {
  dvec2 centre{0.0};
  double inner = 0;     ///< >= 0
  double outer = 1000;  ///< > inner
};

/// factor_a * a + factor_b * b + offset.
struct Sum {
  Function a, b;
  double factor_a = 1, factor_b = 1, offset = 0;
};
/// a * b.
struct Product {
  Function a, b;
};
/// The smaller of a and b.
struct Minimum {
  Function a, b;
};
/// The larger of a and b.
struct Maximum {
  Function a, b;
};
/// The minimum, rounded where both are within `radius` of each other; lower than both there by at most radius / 4.
struct SmoothMinimum {
  Function a, b;
  double radius = 10;  ///< metres, > 0
};

using FunctionShape =
    std::variant<Plane, Sines, Fractal, Warp, Terraces, RadialMask, Sum, Product, Minimum, Maximum, SmoothMinimum>;

/// An immutable node of a terrain function.
struct FunctionNode {
  FunctionShape shape;
  int depth;  ///< 1: a leaf
};

/// Throws Error for a setting out of range (by name), a missing operand, or a tree deeper than kDeepestFunction.
Function make_function(FunctionShape shape);

}  // namespace scarp
