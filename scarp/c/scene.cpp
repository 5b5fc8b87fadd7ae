// SPDX-License-Identifier: MIT
// Version, combination and lifetime of scenes.
#include "scarp/c/scene_handle.h"
#include "scarp/version.h"

static_assert(SCARP_C_VERSION == SCARP_VERSION, "scarp_c.h: write the version of the project");

using namespace scarp::c;

int32_t scarp_version(void) { return SCARP_C_VERSION; }

scarp_status scarp_scene_combine(const scarp_part* parts, size_t count, scarp_scene** scene) {
  return guarded([&] {
    required(scene, "scene");
    required(parts, count, "parts");
    auto whole = std::make_unique<scarp_scene>();
    std::vector<scarp::ScenePart> placed;
    for (size_t i = 0; i < count; ++i) {
      placed.push_back(part_from(parts[i]));
      const Parts& own = parts[i].scene->parts;
      whole->parts.objects.insert(whole->parts.objects.end(), own.objects.begin(), own.objects.end());
      whole->parts.memory.insert(whole->parts.memory.end(), own.memory.begin(), own.memory.end());
    }
    whole->queries = &whole->combined.emplace(scarp::combine(placed));
    *scene = whole.release();
  });
}

size_t scarp_scene_objects(const scarp_scene* scene) { return scene ? scene->queries->objects().size() : 0; }

void scarp_scene_set_user_data(scarp_scene* scene, void* user_data) {
  if (scene) scene->user_data = user_data;
}

void* scarp_scene_user_data(const scarp_scene* scene) { return scene ? scene->user_data : nullptr; }

void scarp_scene_release(scarp_scene* scene) {
  if (scene && !scene->of_live) delete scene;
}
