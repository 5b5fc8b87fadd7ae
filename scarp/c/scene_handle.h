// SPDX-License-Identifier: MIT
// What is behind a scarp_scene.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "scarp/c/failure.h"
#include "scarp/scene/combine.h"
#include "scarp/scene/terrain.h"
#include "scarp/scene/tiled_terrain.h"
#include "scarp/scene/voxels.h"

namespace scarp::c {

/// An object of a scene as it was opened, to check hits that the caller passes in; no object at the numbers of removed
/// ones.
using Part = std::variant<std::monostate, Terrain, Voxels, TerrainTiles>;

/// Parts by the index of their object.
struct Parts {
  std::vector<Part> objects;
  std::vector<std::shared_ptr<const void>> memory;  // of the caller, with a `release`
};

}  // namespace scarp::c

/// The scene of `queries` may be replaced in place, by edits of the field that it belongs to.
struct scarp_scene {
  const scarp::Scene* queries = nullptr;  // in `combined`, a part or a LiveScene
  std::optional<scarp::Scene> combined{};
  scarp::c::Parts parts{};
  bool of_live = false;  // belongs to a scarp_live
  void* user_data = nullptr;
};

namespace scarp::c {

inline const Scene& scene_of(const scarp_scene* scene) { return *required(scene, "scene").queries; }

/// Returns the scene of a terrain, of voxels or of tiles.
template <class Field>
std::unique_ptr<scarp_scene> opened(const Field& field) {
  auto scene = std::make_unique<scarp_scene>();
  scene->parts.objects.emplace_back(field);
  scene->queries = &std::get<Field>(scene->parts.objects[0]).scene();
  return scene;
}

/// Returns the Terrain or the Voxels that a scene was opened as. Throws Unsupported for other scenes.
template <class Field>
Field& only(scarp_scene* given, const char* kind) {
  scarp_scene& scene = required(given, "scene");
  const bool one = !scene.combined && !scene.of_live && scene.parts.objects.size() == 1;
  Field* field = one ? std::get_if<Field>(&scene.parts.objects[0]) : nullptr;
  if (!field) throw Unsupported(fmt::format("scene: it was not opened as {}", kind));
  return *field;
}
inline const Terrain& only_terrain(const scarp_scene* scene) {
  return only<Terrain>(const_cast<scarp_scene*>(scene), "heights");
}

inline Ray ray_from(const scarp_ray& ray) {
  Ray own;
  own.origin = {ray.origin[0], ray.origin[1], ray.origin[2]};
  own.direction = {ray.direction[0], ray.direction[1], ray.direction[2]};
  own.t_min = ray.t_min;
  own.t_max = ray.t_max;
  return own;
}
/// Whether a scene may have returned a hit; queries that start on its surface would read beyond a field otherwise.
bool is_hit_of(const scarp_scene& scene, const scarp_hit& hit);
/// For any values of its members.
Hit hit_from(const scarp_hit& hit);
/// Throws Error unless is_hit_of().
Hit checked_hit(const scarp_scene& scene, const scarp_hit& hit);

/// Largest coordinate and scale, and the inverse of the smallest scale: boxes of scenes are compared in floats.
constexpr double kReach = 1e30;

/// Returns a placed part. Throws Error if it has no scene, or an object beyond kReach.
ScenePart part_from(const scarp_part& part);
Placement placement_from(const scarp_part& part);
void require_reach(const Placement& placement);
inline dvec3 vector_from(const double v[3], const char* name) {
  required(v, name);
  return {v[0], v[1], v[2]};
}
/// A rotation given row by row, which glm stores by columns; no rotation if all are 0.
glm::dmat3 turn_from(const double turn[9]);

}  // namespace scarp::c
