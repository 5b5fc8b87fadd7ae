// SPDX-License-Identifier: MIT
// A triangle mesh between terrain, drawn by the device on which the scene is.
//
//   terrain, by rays ──colour, depth──▶ colour image + depth buffer ◀──drawn── mesh
//        ▲                                                                │  any-hit rays from its fragments: the
//        └──── map of what the mesh hides from the sun, read back ◀───────┘  terrain's shadow on the mesh
//
// What is nearer is seen. Depths are those of a reversed depth buffer without a far plane, near / z (depth.h),
// kMeshNear being 1; of cameras without perspective (far - z) / (far - near), the planes lying round all that there is.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scarp/render/camera/camera.h"
#include "scarp/render/light/light.h"
#include "scarp/render/light/sun_shadow.h"
#include "scarp/scene/terrain_scene.h"
#include "scarp/source/mesh_file.h"

namespace scarp {

/// Metres; what is nearer to the eye is not seen.
constexpr double kMeshNear = 0x1p-7;

/// Where a mesh stands.
struct MeshPlacement {
  dvec3 at{0.0};        ///< metres, world: where its middle is, seen from above, and its lowest point
  double scale = 1;     ///< metres per unit of the file; above 0
  double turn_deg = 0;  ///< clockwise, seen from above
};

/// The corners in the world. Throws Error when a number of the placement is out of its range, or corners so placed are
/// not finite.
std::vector<MeshCorner> placed(const TriangleMesh& mesh, const MeshPlacement& placement);

/// A picture's terrain, or the picture with the mesh, at width x height points: row by row from the top.
struct DrawnPoints {
  int width = 0, height = 0;
  std::vector<vec3> colour;        ///< linear light; of the mesh in its light, before the air between
  std::vector<float> depth;        ///< metres along the view axis; infinite where there is nothing
  std::vector<std::uint8_t> mesh;  ///< 1 where the mesh is seen
  std::vector<vec3> normal;        ///< of the mesh, unit, towards the eye; 0 elsewhere
};

/// Keeps the mesh in the device's memory. The scene, or a copy of it, must live as long.
class MeshRaster {
 public:
  /// Throws Error: the scene is not on a Vulkan device, the device does not draw, no memory; no corners.
  MeshRaster(const TerrainScene& scene, std::span<const MeshCorner> corners);
  MeshRaster(MeshRaster&&) noexcept;
  MeshRaster& operator=(MeshRaster&&) noexcept;
  ~MeshRaster();

  /// The mesh's shadow, for PictureSettings::sun_shadow, and for draw(). `to_sun` is a unit vector, above the horizon.
  std::shared_ptr<const SunShadow> cast_shadow(const dvec3& to_sun);

  /// Throws Error when the device does not draw so many points along a side: before the terrain is rendered for
  /// nothing.
  void require_drawable(int width, int height) const;
  /// The terrain's points (`mesh` and `normal` may be empty) with the mesh among them. `shadows`: of the terrain, and,
  /// if it was cast, the mesh's own on itself. Throws Error when there are more points along a side than the device
  /// draws.
  DrawnPoints draw(const Camera& camera, const DrawnPoints& terrain, const Light& light, bool shadows);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
