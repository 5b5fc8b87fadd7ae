// SPDX-License-Identifier: MIT
// Light properties of materials in .vox files. Their attributes are texts, and MagicaVoxel documents no units.
//
//   _type    _diffuse, _metal, _glass, _emit, _blend (metal and glass), _media
//   _metal   fraction of light that is mirrored, 0..1; _weight in files before version 0.99.5, as for all types
//   _rough   roughness, 0..1
//   _emit    light emitted, 0..1; _flux: its power, 0..4
#pragma once

#include "scarp/source/voxel/vox_file.h"

namespace scarp {

/// Light that a colour emits, in units of itself under full light: _emit, doubled by each step of _flux, which is
/// limited to 0..10. 0 for all other materials, and for invalid numbers.
float vox_emission(const VoxMaterial& material);
/// Fraction of light that a colour mirrors as one sharp ray, 0..1: _metal * (1 - _rough). 0 likewise.
float vox_mirror(const VoxMaterial& material);
/// Whether it is transparent in MagicaVoxel: glass, and blends with glass.
bool is_vox_glass(const VoxMaterial& material);

}  // namespace scarp
