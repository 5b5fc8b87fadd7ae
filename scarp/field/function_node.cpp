// SPDX-License-Identifier: MIT
#include "scarp/field/function_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kShortestWave = 0x1p-20;

[[noreturn]] void refuse(std::string_view what, double value, std::string_view range) {
  throw Error(fmt::format("terrain function: {} is {} (must be {})", what, value, range));
}

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) refuse(what, value, range);
}

void require_finite(std::string_view what, double value) {
  require(std::abs(value) <= kMostMetres, what, value, "between -2^30 and 2^30");
}

void require_length(std::string_view what, double value) {
  require(value >= kShortestWave && value <= kMostMetres, what, value, "between 2^-20 and 2^30");
}

void require_octaves(std::string_view what, int octaves) {
  require(octaves >= 1 && octaves <= kMostOctaves, what, octaves, "1 to 24");
}

int depth_of(std::string_view what, const Function& operand) {
  if (!operand) throw Error(fmt::format("terrain function: {} is missing (must be a function)", what));
  return operand->depth;
}

// Validates the settings of a node; returns the depth below it.
struct Check {
  int operator()(const Plane& p) const {
    require_finite("plane height", p.height);
    require_finite("plane slope x", p.slope_x);
    require_finite("plane slope y", p.slope_y);
    return 0;
  }
  int operator()(const Sines& s) const {
    if (s.waves.empty()) throw Error("terrain function: sines without waves (at least one required)");
    for (const Sine& wave : s.waves) {
      require_finite("sine amplitude", wave.amplitude);
      require_length("sine wavelength", wave.wavelength);
      require_finite("sine direction", wave.towards);
      require_finite("sine phase", wave.phase);
    }
    return 0;
  }
  int operator()(const Fractal& f) const {
    require_length("fractal wavelength", f.wavelength);
    require(f.height >= 0 && f.height <= kMostMetres, "fractal height", f.height, "between 0 and 2^30");
    require(f.gain > 0 && f.gain <= 1, "fractal gain", f.gain, "above 0 and at most 1");
    require(f.lacunarity >= 1 && f.lacunarity <= 8, "fractal lacunarity", f.lacunarity, "1 to 8");
    const double turn = length(f.turn);
    require(std::abs(turn - 1) <= 0x1p-20, "length of the fractal turn", turn, "1 (cosine and sine of an angle)");
    require(f.damping >= 0 && f.damping <= kMostMetres, "fractal damping", f.damping, "between 0 and 2^30");
    require(f.focus > 0 && f.focus <= kMostMetres, "fractal focus", f.focus, "above 0 and at most 2^30");
    require_octaves("fractal octaves of the march", f.octaves.march);
    require_octaves("fractal octaves of the shadow", f.octaves.shadow);
    require_octaves("fractal octaves of the normal", f.octaves.normal);
    const int most = std::max({f.octaves.march, f.octaves.shadow, f.octaves.normal});
    const double finest = f.wavelength / std::pow(f.lacunarity, most - 1);
    require(finest >= kShortestWave, "wavelength of the finest fractal octave", finest, "at least 2^-20");
    return 0;
  }
  int operator()(const Warp& w) const {
    return std::max(
        {depth_of("warp base", w.base), depth_of("warp shift x", w.shift_x), depth_of("warp shift y", w.shift_y)});
  }
  int operator()(const Terraces& t) const {
    require_length("terrace step", t.step);
    require(t.rise >= kShortestWave && t.rise <= 1, "terrace rise", t.rise, "between 2^-20 and 1");
    return depth_of("terrace base", t.base);
  }
  int operator()(const RadialMask& m) const {
    require_finite("mask centre x", m.centre.x);
    require_finite("mask centre y", m.centre.y);
    require(m.inner >= 0 && m.inner <= kMostMetres, "mask inner radius", m.inner, "between 0 and 2^30");
    require(m.outer - m.inner >= kShortestWave && m.outer <= kMostMetres, "mask outer radius", m.outer,
            "above the inner one and at most 2^30");
    return 0;
  }
  int operator()(const Sum& s) const {
    require_finite("sum factor a", s.factor_a);
    require_finite("sum factor b", s.factor_b);
    require_finite("sum offset", s.offset);
    return both("sum", s.a, s.b);
  }
  int operator()(const Product& p) const { return both("product", p.a, p.b); }
  int operator()(const Minimum& m) const { return both("minimum", m.a, m.b); }
  int operator()(const Maximum& m) const { return both("maximum", m.a, m.b); }
  int operator()(const SmoothMinimum& m) const {
    require_length("smooth minimum radius", m.radius);
    return both("smooth minimum", m.a, m.b);
  }
  static int both(std::string_view what, const Function& a, const Function& b) {
    return std::max(depth_of(fmt::format("{} operand a", what), a), depth_of(fmt::format("{} operand b", what), b));
  }
};

}  // namespace

Function make_function(FunctionShape shape) {
  const int depth = 1 + std::visit(Check{}, shape);
  if (depth > kDeepestFunction) {
    throw Error(fmt::format("terrain function: nested {} deep (limited to {})", depth, kDeepestFunction));
  }
  return std::make_shared<const FunctionNode>(FunctionNode{std::move(shape), depth});
}

}  // namespace scarp
