// SPDX-License-Identifier: MIT
// Light properties of materials in .vox files. Attributes are strings, and MagicaVoxel documents no units.
//
//   _type    _diffuse, _metal, _glass, _emit, _blend (metal and glass), _media
//   _metal   fraction of light that is mirrored, 0..1; _weight in files before version 0.99.5, as for all types
//   _rough   roughness, 0..1
//   _emit    light emitted, 0..1; _flux: its power, 0..4
#pragma once

#include "scarp/source/voxel/vox_file.h"

namespace scarp {

/// Light emitted by a colour, relative to that colour under full light: _emit, doubled by each step of _flux, which is
/// limited to 0..10. 0 for all other materials, and for invalid numbers.
float vox_emission(const VoxMaterial& material);
/// Fraction of light that a colour reflects as one sharp ray, 0..1: _metal * (1 - _rough). 0 for all other materials,
/// and for invalid numbers.
float vox_mirror(const VoxMaterial& material);
/// Whether the material is transparent in MagicaVoxel: glass, and blends with glass.
bool is_vox_glass(const VoxMaterial& material);

}  // namespace scarp
