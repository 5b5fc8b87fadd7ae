// SPDX-License-Identifier: MIT
// Scenes from JSON files: fields, their placements and materials, and settings of a picture.
//
//   {
//     "camera": {"eye": [0, -60, 20], "target": [0, 0, 5]},
//     "materials": {"grass": {"colour": "#6f8f4a"}},
//     "objects": [
//       {"name": "hills", "function": {"type": "fbm", "wavelength": 120, "height": 9}, "material": "grass"},
//       {"voxels": {"file": "house.vox", "centred": true}, "scale": 0.5, "at": [4, 3, 0], "on": "hills"}
//     ]
//   }
//
// scene.schema.json and doc/user/scenes.md document every key. Paths are relative to the file's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Camera settings of a file. Here and below, the caller chooses the members that the file does not set.
struct SceneCamera {
  std::optional<dvec3> eye, target;  ///< both or none, metres, world
  std::optional<double> azimuth_deg, elevation_deg, distance, fov_deg;
};

/// Sun of a file, as SunSettings of render/light/sun.h.
struct SceneSun {
  std::optional<double> azimuth_deg, altitude_deg, size_deg;
  std::optional<bool> shadows;
};

/// Picture settings of a file, as PictureSettings of render/frame/picture.h.
struct ScenePicture {
  std::optional<int> width, height, aa, samples;
  std::optional<double> ao_distance;
  std::optional<std::uint32_t> seed;
  bool coarse_voxels = false;  ///< whether to call Scene::coarser()
};

/// Sky settings of a file; see SkySettings in render/light/sky.h.
struct SceneSky {
  std::optional<std::string> kind{};  ///< "plain" or "scattering"
  std::optional<double> turbidity{};
};

/// Water of a file, as WaterSettings of render/surface/water.h.
struct SceneWater {
  double level = 0;            ///< metres, not exaggerated
  std::optional<vec3> srgb{};  ///< 0..1
  std::optional<double> turbidity{}, waves{}, wavelength{};
  std::optional<bool> reflection{}, refraction{};
};

/// Fog of a file, as FogSettings of render/light/fog.h.
struct SceneFog {
  std::string kind;  ///< "distance" or "height"
  std::optional<double> visibility{}, base{}, falloff{}, sun_tint{};
};

/// An object of a file. It becomes several objects of the Scene if it has several placements, is scattered or is itself
/// a scene.
struct SceneObjectName {
  std::string name;         ///< as in the file, or its position there
  std::uint32_t first = 0;  ///< index of its first object in the scene
  std::uint32_t count = 0;  ///< number of its objects
};

/// The contents of a scene file.
struct SceneFile {
  Scene scene;
  std::vector<Material> materials;
  std::vector<SceneObjectName> names;
  SceneCamera camera;
  SceneSun sun;
  SceneSky sky;
  ScenePicture picture;
  std::optional<double> haze_distance;  ///< metres; never set if `fog` is
  std::optional<SceneWater> water;
  std::optional<SceneFog> fog;
  std::vector<std::string> notes;  ///< conversions and assumptions that the readers made, one line each, for display
  std::vector<std::string> files;  ///< all files that were read: this one, other scenes, heights, voxels
};

/// Reads a scene file and all files that it names. Throws Error if a file is missing or not readable, is not JSON, does
/// not match the schema, contains unknown names, scenes or materials that contain themselves, or has more than 2^20
/// objects. The message names the file, the position in it as a JSON pointer, and the expected value. Throws
/// Interrupted if `progress` returns false.
SceneFile read_scene(const std::string& path, const Progress& progress = {});

}  // namespace scarp
