// SPDX-License-Identifier: MIT
// Terrain functions in JSON: one object per node of function_node.h, whose settings are its keys, lengths in metres.
//
//   5                                                            a plane at this height
//   "hills"                                                      the function with that name
//   {"type": "plane", "height": 0, "slope": [0.1, 0]}
//   {"type": "sines", "waves": [{"amplitude": 20, "wavelength": 700, "towards": 17, "phase": 0}]}
//   {"type": "fbm", "noise": "perlin", "seed": 1, "wavelength": 1000, "height": 200, "gain": 0.5, "lacunarity": 2,
//    "turn": 36.87, "damping": 0, "octaves": 9}              octaves also {"march": 9, "shadow": 9, "normal": 12}
//   {"type": "ridged", ..., "focus": 2}
//   {"type": "warp", "base": F, "shift_x": F, "shift_y": F}
//   {"type": "terraces", "base": F, "step": 10, "rise": 0.3}
//   {"type": "mask", "centre": [0, 0], "inner": 0, "outer": 1000}
//   {"type": "sum", "of": [F, F, ...], "factors": [1, -0.5, ...], "offset": 0}
//   {"type": "product" | "minimum" | "maximum", "of": [F, F, ...]}
//   {"type": "smooth-minimum", "of": [F, F], "radius": 10}
//
// All keys except type and operands have the defaults of function_node.h. Angles are in degrees; `towards` counts from
// east, counter-clockwise.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "scarp/field/function_node.h"

namespace scarp {

/// Returns the function with this name, used at a position in the file. Throws Error naming the position if there is
/// none.
using FunctionByName = std::function<Function(const std::string& name, std::string_view path)>;

/// `path` is the position of `json` in its file, as a JSON pointer. Without `by_name`, names are those of
/// example_functions.h. Throws Error naming the position and the expected value.
Function function_from_json(const nlohmann::json& json, std::string_view path, const FunctionByName& by_name = {});

}  // namespace scarp
