// SPDX-License-Identifier: MIT
// Procedural terrain as a GeoTIFF that may be far larger than memory.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/procedural_dem.h"

namespace scarp {

/// Writes the terrain to `path`: float32 metres, tiles of 256 x 256, compressed without loss (deflate), BigTIFF where
/// needed. Strips of 256 rows are made on all threads and written one after the other, so memory holds few of them.
///
/// It lies around latitude 0, longitude 0 on a Transverse Mercator of scale 1 whose origin is the terrain's centre, so
/// that there the map's metres are the ground's and north is up.
///
/// The file appears whole or not at all. Throws Error (settings, folder, disk full), Interrupted.
void write_procedural_dem(const std::string& path, const ProceduralDem& settings, const Progress& progress = {});

}  // namespace scarp
