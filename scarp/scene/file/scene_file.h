// SPDX-License-Identifier: MIT
// Scenes from JSON files: fields, where they stand, what they look like, and how a picture is made of them.
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
// Every key is in scene.schema.json and in doc/user/scenes.md. Paths count from the file's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// What is not set is left to whoever makes the picture.
struct SceneCamera {
  std::optional<dvec3> eye, target;  ///< both or none, metres, world
  std::optional<double> azimuth_deg, elevation_deg, distance, fov_deg;
};

struct SceneSun {
  std::optional<double> azimuth_deg, altitude_deg, size_deg;
  std::optional<bool> shadows;
};

struct ScenePicture {
  std::optional<int> width, height, aa, samples;
  std::optional<double> ao_distance;
  std::optional<std::uint32_t> seed;
  bool coarse_voxels = false;  ///< Scene::coarser()
};

struct SceneWater {
  double level = 0;            ///< metres, not exaggerated
  std::optional<vec3> srgb{};  ///< 0..1
  std::optional<double> turbidity{}, waves{}, wavelength{};
  std::optional<bool> reflection{}, refraction{};
};

struct SceneFog {
  std::string kind;  ///< "distance" or "height"
  std::optional<double> visibility{}, base{}, falloff{}, sun_tint{};
};

/// An object of a file; one with places, scattered or of another scene is several of a Scene.
struct SceneObjectName {
  std::string name;         ///< as the file says, or its place in the file
  std::uint32_t first = 0;  ///< of its objects in the scene
  std::uint32_t count = 0;
};

struct SceneFile {
  Scene scene;
  std::vector<Material> materials;
  std::vector<SceneObjectName> names;
  SceneCamera camera;
  SceneSun sun;
  ScenePicture picture;
  std::optional<double> haze_distance;  ///< metres; not beside fog
  std::optional<SceneWater> water;
  std::optional<SceneFog> fog;
  std::vector<std::string> notes;  ///< of readers, one line each, for people
  std::vector<std::string> files;  ///< all that were read: this one, other scenes, heights, voxels
};

/// Reads the file and everything that it names. Throws Error in one line with the file and the place in it, as a JSON
/// pointer, and what would be right: no such file, not JSON, not to the schema, files that cannot be read, names that
/// nobody has, scenes or materials that contain themselves, more than 2^20 objects. Interrupted when progress asks.
SceneFile read_scene(const std::string& path, const Progress& progress = {});

}  // namespace scarp
