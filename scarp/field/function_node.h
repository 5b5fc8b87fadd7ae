// SPDX-License-Identifier: MIT
// What a procedural terrain is made of: a small tree of plain settings, read by whoever evaluates it.
//
//   auto hills = make_function(Fractal{.wavelength = 2000, .height = 400});
//   auto bay = make_function(Minimum{hills, make_function(Plane{.height = 0})});
//
// A node never changes; trees may share nodes. Lengths and heights are metres, angles radians. What is out of range is
// refused by make_function(), so that a Function that exists is good.
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

/// Settings above this are refused (lengths, heights, factors alike), so that nothing overflows.
inline constexpr double kMostMetres = 0x1p30;
/// Nodes under one another.
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
  double towards = 0;       ///< from east, counter-clockwise
  double phase = 0;
};
struct Sines {
  std::vector<Sine> waves;  ///< at least one
};

inline constexpr int kMostOctaves = 24;

/// Octaves by what they are for, 1..kMostOctaves: normals may be finer than the surface that is marched. Each number is
/// a surface of its own: with other ones for march and shadow, what a ray meets and whether it is blocked may differ.
struct Octaves {
  int march = 9;
  int shadow = 9;
  int normal = 12;
};

enum class FractalForm : std::uint8_t {
  fbm,     ///< sum of octaves
  ridged,  ///< each octave folded at 0 into crests, and shown only where those before are high
};

/// Octaves of noise, each turned against that before. Source: F. K. Musgrave in D. Ebert et al., "Texturing and
/// modeling", 3rd ed., 2003, chapter 16; damping as in I. Quilez, "Elevated", 2009.
struct Fractal {
  FractalForm form = FractalForm::fbm;
  NoiseKind noise = NoiseKind::perlin;
  std::uint64_t seed = 1;
  double wavelength = 1000;  ///< of the first octave, > 0
  double height = 200;       ///< amplitude of the first octave, >= 0
  double gain = 0.5;         ///< amplitude of an octave in proportion to that before, above 0, at most 1
  double lacunarity = 2;     ///< wavelength of an octave over that of the next, 1..8
  dvec2 turn{0.8, 0.6};      ///< from octave to octave: cosine and sine of the angle
  double damping = 0;        ///< k: octaves count 1 / (1 + k |d|^2), d the sum of the noise's gradients; >= 0
  double focus = 2;          ///< of ridged: how soon a crest lets the next octave show, > 0
  Octaves octaves{};
};

/// base at (x + shift_x(x, y), y + shift_y(x, y)).
struct Warp {
  Function base, shift_x, shift_y;
};

/// Steps of the same height, flat but for the last part of each.
struct Terraces {
  Function base;
  double step = 10;   ///< metres, > 0
  double rise = 0.3;  ///< share of a step in which the ground climbs to the next, above 0, at most 1
};

/// 1 within `inner` of the centre, 0 beyond `outer`, the quintic fade between.
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
struct Product {
  Function a, b;
};
struct Minimum {
  Function a, b;
};
struct Maximum {
  Function a, b;
};
/// The minimum, rounded where both are closer than `radius`; lower than both there, by at most radius / 4.
struct SmoothMinimum {
  Function a, b;
  double radius = 10;  ///< metres, > 0
};

using FunctionShape =
    std::variant<Plane, Sines, Fractal, Warp, Terraces, RadialMask, Sum, Product, Minimum, Maximum, SmoothMinimum>;

struct FunctionNode {
  FunctionShape shape;
  int depth;  ///< 1: no node under it
};

/// Throws Error naming the setting that is out of range, a missing operand, or more nodes under one another than
/// kDeepestFunction.
Function make_function(FunctionShape shape);

}  // namespace scarp
