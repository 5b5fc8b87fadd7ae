// SPDX-License-Identifier: MIT
// Shapes in scene files: an object with one key that names its type, and an optional material:
//
//   {"sphere": {"radius": 1, "at": [0, 0, 2]}, "material": "red"}
//   {"box": {"half": [1, 2, 0.5], "round": 0.1, "at": ..}}          {"plane": {"normal": [0, 0, 1], "height": 0}}
//   {"capsule": {"from": [..], "to": [..], "radius": 1}}
//   {"cylinder": {"radius": 1, "half_height": 2, "at": ..}}
//   {"cone": {"radius": 1, "height": 2, "top": 0, "at": ..}}         {"torus": {"radius": 2, "tube": 0.5, "at": ..}}
//   {"ellipsoid": {"radii": [3, 2, 1], "at": ..}}                    {"ground": "name of a field of the scene"}
//   {"translate": [x, y, z], "of": SHAPE}                            {"scale": 2, "of": SHAPE}
//   {"rotate": {"axis": [0, 0, 1], "degrees": 30}, "of": SHAPE}
//   {"repeat": {"period": [4, 4, 0], "count": [3, 3, 0]}, "of": SHAPE}      count 0: unlimited
//   {"union": [SHAPE, ..], "smooth": 0.3}    {"intersection": [SHAPE, ..]}    {"subtract": [FROM, WHAT, ..]}
//
// Lengths are metres. An inner material overrides an outer one.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scarp/field/distance_field.h"

namespace scarp {

/// Lookups of shapes in their scene. Both may be empty: then a material or a ground is an error. They throw Error for
/// unknown names; `path` is the position of the name.
struct ShapeNames {
  std::function<int(const std::string& name, const std::string& path)> material;
  std::function<Shape(const nlohmann::json& ground, const std::string& path)> ground;
};

/// `path` is the JSON pointer of `json` in its file, "/objects/2/shape". Throws Error for the first mistake, with its
/// position: "/objects/2/shape/sphere/radius: expected > 0, got -1".
Shape shape_from_json(const nlohmann::json& json, const std::string& path, const ShapeNames& names = {});
/// The same, compiled.
DistanceField distance_field_from_json(const nlohmann::json& json, const std::string& path,
                                       const ShapeNames& names = {});

}  // namespace scarp
