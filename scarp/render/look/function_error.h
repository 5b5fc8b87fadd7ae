// SPDX-License-Identifier: MIT
// Where a march over a terrain function is wrong: the verdicts and colours of error_look.h, on ground without an end.
//
// The truth is `lipschitz-local`, which passes no crossing. That is not left to trust: one pixel in 64 is judged by
// interval bisection as well (function_exhaustive.h), and contradictions are counted.
#pragma once

#include "scarp/march/function/function_table.h"
#include "scarp/render/look/error_look.h"

namespace scarp {

struct FunctionErrorSettings {
  double share = 0.01;   ///< hits agree within this share of the distance, >= 0
  double reach = 20000;  ///< metres that rays are followed; > 0, finite
  int width = 1280;      ///< pixels of the camera's picture
  int height = 720;
};

struct FunctionErrorPicture {
  Image image;
  ErrorCounts counts;               ///< tolerance_m is 0: it goes with the distance
  std::int64_t judged = 0;          ///< pixels that intervals decided
  std::int64_t contradictions = 0;  ///< of those, where lipschitz-local says otherwise: none, or there is a bug
};

/// `march` is a row of function_marches(). Throws Error for settings out of their range, Interrupted when progress asks
/// for it.
FunctionErrorPicture render_function_error(const HeightFunction& function, const FunctionMarchEntry& march,
                                           const MarchSettings& march_settings, const Camera& camera,
                                           const FunctionErrorSettings& settings, const Progress& progress = {});

}  // namespace scarp
