// SPDX-License-Identifier: MIT
// The parts of the module, one per file.
#pragma once

#include <pybind11/pybind11.h>

#include "python/bind/scene_object.h"

namespace scarp::python {

void bind_queries(pybind11::module_& module, pybind11::class_<SceneObject>& base);
void bind_terrain(pybind11::module_& module);
void bind_fans(pybind11::module_& module);
void bind_sight(pybind11::module_& module);
void bind_sun(pybind11::module_& module);
void bind_voxels(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_crs(pybind11::module_& module);
void bind_picture(pybind11::module_& module);

}  // namespace scarp::python
