// SPDX-License-Identifier: MIT
// The main header. It covers the common tasks with a few lines each:
//
//   #include "scarp/scarp.h"
//
//   // Caller-owned heights, without a copy; builds the pyramid.
//   auto terrain = scarp::Terrain::view(heights, cols, rows, {.cell_x = 10, .cell_y = 10});
//   scarp::Hit hit = scarp::cast(terrain, ray);              // the ray's closest hit
//   bool hidden = scarp::occluded(terrain, ray);             // whether anything blocks it
//   scarp::cast(terrain, rays, hits);                        // a batch, on all threads
//   scarp::cast_from(terrain, camera, answers);              // all rays of a camera or a scanner
//   terrain.samples_changed({.col = 9, .row = 9, .cols = 3, .rows = 2});
//
//   auto voxels = scarp::Voxels::copy(indices, {64, 64, 32}, {.palette = colours});
//   auto scene = scarp::combine({{terrain}, {voxels, {.origin = {300, 200, 120}}}});
//
//   scarp::render(scarp::Terrain::open("dem.tif"), "dem.png");
//
// scarp::core implements all of this except Terrain::open() and render(). These read and write files and are in
// scarp::scarp; a program that calls them but links only scarp::core fails to link (undefined reference to
// scarp::render). Errors are exceptions of type scarp::Error. A Terrain or Voxels converts to a Scene.
// After an edit of a field, scenes that contain it throw Error until they are built again; LiveScene
// (scarp/scene/live_scene.h) supports edits of objects and fields, also while other threads query it.
#pragma once

#include <string>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/ray.h"
#include "scarp/field/distance_field.h"
#include "scarp/field/height_function.h"
#include "scarp/scene/cast.h"
#include "scarp/scene/cast_from.h"
#include "scarp/scene/combine.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/terrain.h"
#include "scarp/scene/voxels.h"

namespace scarp {

struct PictureSettings;  // scarp/render/frame/picture.h
struct ViewSettings;     // scarp/render/camera/camera.h

/// Renders a scene to a PNG file, seen from the south and above, framed to show all of it. A terrain alone stands on a
/// plinth, as in `scarp render`, and has a haze of 0.1; other scenes have none. Throws Error if nothing is visible, if
/// all objects are unbounded or terrain wraps (then call render_picture() with a Camera), or if the file cannot be
/// written; an existing file is then unchanged. In scarp::scarp.
void render(const Scene& scene, const std::string& path);
/// As above; compass directions of the eye and the sun follow the terrain's georeference.
void render(const Terrain& terrain, const std::string& path);
/// As above, with settings: `picture` for size, light, materials, water, ...; `view` for compass azimuth, elevation and
/// distance of the eye. Ignores the georeference of a terrain: set PictureSettings::grid_north_azimuth. The default
/// PictureSettings::haze, 0.1, applies to all scenes. Throws Error naming the setting if one is out of range.
void render(const Scene& scene, const std::string& path, const PictureSettings& picture, const ViewSettings& view);

}  // namespace scarp
