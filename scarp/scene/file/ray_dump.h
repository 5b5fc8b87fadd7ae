// SPDX-License-Identifier: MIT
// One ray over one field as text: everything needed to repeat the query elsewhere, bit for bit.
//
//   scarp-rays 1                          first line: what this is, and its version
//   # anything                            lines like this and empty ones are skipped
//   field float32 3 2                     starts a field: type of the samples, columns, rows
//   cell_x 0x1p+0                         the settings, in any order; settings that are left out have their defaults:
//   ...                                   cell_y scale offset exaggeration nodata surface wrap solid
//   row 0x1p+0 nan 0x1.8p+1               the samples, from north to south, one line for each row; or
//   generate ridged 1 0x1p+0 0x0p+0       instead of rows, a procedural DEM: kind, seed, cell in metres, feature size
//   ray                                   starts a ray over the field above; several may follow
//   origin 0x1p+0 0x1p-1 0x1p+3
//   direction 0x0p+0 0x0p+0 -0x1p+0
//   range 0x0p+0 inf                      t_min and t_max
//   start on_surface 0 1                  or: start free, the default
//   expected a hit                        for human readers, as is `answered`
//
// Numbers are decimal or, to the last bit, hexadecimal (C's %a).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/field/height_field.h"
#include "scarp/source/raster/procedural_dem.h"

namespace scarp {

struct RayDump {
  HeightField field;
  /// Set if the samples are a procedural DEM in metres; they are then not written out.
  std::optional<ProceduralDem> generator;
  Ray ray;
  std::string expected;  ///< for human readers: one line; may be empty
  std::string answered;
};

/// Writes the rays into one file; consecutive rays over the same field (or copies of it) share its text. Throws Error
/// if the file cannot be written; then no file is created or changed.
void write_ray_dumps(const std::string& path, std::span<const RayDump> dumps);

/// Reads files written by write_ray_dumps(), or by hand in the same format, with at least one ray. Throws Error naming
/// the file and the line.
std::vector<RayDump> read_ray_dumps(const std::string& path);

}  // namespace scarp
