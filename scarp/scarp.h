// SPDX-License-Identifier: MIT
// The door for programs. One include, and a few lines per task:
//
//   #include "scarp/scarp.h"
//
//   // Caller-owned heights, without a copy; builds the pyramid.
//   auto terrain = scarp::Terrain::view(heights, cols, rows, {.cell_x = 10, .cell_y = 10});
//   scarp::Hit hit = scarp::cast(terrain, ray);              // the closest hit of a ray
//   bool hidden = scarp::occluded(terrain, ray);             // whether anything blocks it
//   scarp::cast(terrain, rays, hits);                        // a batch, on all threads
//   terrain.samples_changed({.col = 9, .row = 9, .cols = 3, .rows = 2});
//
//   auto voxels = scarp::Voxels::copy(indices, {64, 64, 32}, {.palette = colours});
//   auto scene = scarp::combine({{terrain}, {voxels, {.origin = {300, 200, 120}}}});
//
//   scarp::render(scarp::Terrain::open("dem.tif"), "dem.png");
//
// scarp::core contains all of this except Terrain::open() and render(), which read and write files and are in
// scarp::scarp: a program that links only scarp::core gets "undefined reference to scarp::render" from the linker.
// Errors are exceptions of type scarp::Error. Whatever takes a Scene takes a Terrain or Voxels.
#pragma once

#include <string>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/ray.h"
#include "scarp/field/distance_field.h"
#include "scarp/field/height_function.h"
#include "scarp/scene/cast.h"
#include "scarp/scene/combine.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/terrain.h"
#include "scarp/scene/voxels.h"

namespace scarp {

struct PictureSettings;  // scarp/render/frame/picture.h
struct ViewSettings;     // scarp/render/camera/camera.h

/// Renders a scene to a PNG file, seen from the south and above, framed to show all of it; a terrain alone stands on a
/// plinth, as in `scarp render`. Throws Error for a scene that has nothing to see or no end (then call render_picture()
/// with a Camera), and for a path that cannot be written; nothing is left there then. In scarp::scarp.
void render(const Scene& scene, const std::string& path);
/// The same; the sun stands where it does in true compass directions, by the terrain's georeference.
void render(const Terrain& terrain, const std::string& path);
/// The same with settings: size, light, materials, water, ...; compass direction, height and distance of the eye.
/// Throws Error naming a setting out of range.
void render(const Scene& scene, const std::string& path, const PictureSettings& picture, const ViewSettings& view);

}  // namespace scarp
