// SPDX-License-Identifier: MIT
#include "field/terrain_functions.h"

namespace scarp::test {

std::vector<NamedFunction> terrain_functions() {
  std::vector<NamedFunction> all;
  const auto add = [&](const char* name, FunctionShape shape, bool smooth) {
    all.push_back({name, make_function(std::move(shape)), smooth});
  };
  Fractal fractal{.octaves = {5, 4, 7}};
  add("perlin fbm", fractal, true);
  fractal.noise = NoiseKind::value;
  add("value fbm", fractal, true);
  fractal.noise = NoiseKind::simplex;
  add("simplex fbm", fractal, true);
  fractal.form = FractalForm::ridged;
  add("simplex ridged", fractal, false);
  fractal.noise = NoiseKind::perlin;
  fractal.damping = 0.5;
  fractal.octaves = {2, 2, 2};
  add("ridged and damped", fractal, false);
  add("damped fbm", Fractal{.noise = NoiseKind::value, .damping = 1, .octaves = {3, 3, 3}}, true);

  const Function hills = make_function(Fractal{.seed = 9, .octaves = {4, 4, 4}});
  const Function shift = make_function(Fractal{.seed = 5, .wavelength = 3000, .height = 300, .octaves = {2, 2, 2}});
  const Function slope = make_function(Plane{10, 0.01, -0.02});
  add("plane", Plane{3, -0.25, 0.5}, true);
  add("sines", Sines{{{50, 700, 0.3, 0}, {20, 220, 1.3, 1}, {5, 60, 2, 2}}}, true);
  add("warp", Warp{hills, shift, make_function(Sum{shift, slope, -0.5, 2, 7})}, true);
  add("terraces", Terraces{hills, 40, 0.4}, true);
  add("island", Product{hills, make_function(RadialMask{{100, 200}, 500, 3000})}, true);
  add("minimum", Minimum{hills, slope}, false);
  add("maximum", Maximum{hills, slope}, false);
  add("smooth minimum", SmoothMinimum{hills, slope, 30}, true);
  return all;
}

}  // namespace scarp::test
