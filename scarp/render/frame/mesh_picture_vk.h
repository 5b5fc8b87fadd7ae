// SPDX-License-Identifier: MIT
// Pictures of terrain with a mesh in it, in the look `shaded`: the terrain as ever, the mesh drawn among it
// (mesh_raster_vk.h), each in the other's shadow, haze or fog over both.
//
//   MeshRaster mesh(scene, placed(read_mesh("tower.obj"), {.at = {500, 300, 1200}}));
//   render_with_mesh(scene, mesh, camera, grid_north_azimuth, settings);
#pragma once

#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/mesh_raster_vk.h"
#include "scarp/render/frame/picture.h"

namespace scarp {

/// As render_picture, with the mesh; `scene` is that of the mesh. The mesh's shadow is hard also where `samples` make
/// that of the terrain soft, and it hides nothing of the sky. Throws Error also for other looks and for water, in
/// which the mesh would have to be reflected, and when the device does not draw so many points (width or height times
/// aa).
Picture render_with_mesh(const TerrainScene& scene, MeshRaster& mesh, const Camera& camera, double grid_north_azimuth,
                         const PictureSettings& settings, const Progress& progress = {});

/// As render_layers; of the mesh, too, depth, normal and position are what the ray through the middle of the pixel
/// meets. `steps` are those of the ray in the terrain.
PictureLayers render_layers_with_mesh(const TerrainScene& scene, MeshRaster& mesh, const Camera& camera,
                                      double grid_north_azimuth, const PictureSettings& settings,
                                      const Progress& progress = {});

}  // namespace scarp
