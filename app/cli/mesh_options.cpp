// SPDX-License-Identifier: MIT
#include "app/cli/mesh_options.h"

#include <fmt/format.h>

#include <utility>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"
#include "scarp/scene/material.h"
#include "scarp/source/mesh_file.h"
#ifdef SCARP_EMBREE
#include "scarp/scene/mesh/scene_mesh.h"
#endif

namespace scarp::cli {

void add_mesh_options(Command& command, MeshOptions& options) {
  const Rule of_mesh = needs("--mesh FILE", [&command] { return command.given("--mesh"); });
  command.add(
      &options.file,
      {
          .names = "--mesh",
          .value = "FILE",
          .help = "triangle mesh in the scene: .obj, .gltf or .glb",
          .files = "obj gltf glb",
          .topic = Topic::mesh,
#ifndef SCARP_EMBREE
          .rules = {{"is not available: this scarp was built without Embree (SCARP_EMBREE=OFF)", [] { return false; }}},
#endif
      });
  command.add(&options.at, {.names = "--mesh-at",
                            .value = "X,Y[,Z]",
                            .help = "position of the mesh in metres, as for --eye: its middle, and its lowest point",
                            .fallback = "middle of the scene, on the ground",
                            .topic = Topic::mesh,
                            .rules = {of_mesh}});
  command.add(&options.scale, {.names = "--mesh-scale",
                               .help = "length of the file's unit",
                               .unit = "metres",
                               .range = kAboveZero,
                               .topic = Topic::mesh,
                               .rules = {of_mesh}});
  command.add(&options.turn_deg, {.names = "--mesh-rotate",
                                  .help = "clockwise rotation seen from above",
                                  .unit = "degrees",
                                  .topic = Topic::mesh,
                                  .rules = {of_mesh}});
  command.add(&options.up, {.names = "--mesh-up",
                            .value = "AXIS",
                            .help = "axis of the file that points up",
                            .choices = {"y", "z"},
                            .closed = true,
                            .topic = Topic::mesh,
                            .rules = {of_mesh}});
}

MeshInput::MeshInput(const MeshOptions& options) : options_(options) {
  if (!options.file.empty()) mesh_ = read_mesh(options.file, options.up == "z" ? MeshUp::z : MeshUp::y);
}

#ifdef SCARP_EMBREE

Scene MeshInput::with_mesh(Scene scene) const {
  if (options_.file.empty()) return scene;
  const WorldBox& box = scene.box();
  dvec3 at = box.low.x <= box.high.x ? 0.5 * (box.low + box.high) : dvec3(0.0);
  std::optional<double> height;
  if (!options_.at.empty()) {
    const auto numbers =
        numbers_from(options_.at, ',', 2, 3, "--mesh-at",
                     "X,Y or X,Y,Z in metres from the south-west sample, for example 500,300 or 500,300,1200");
    at.x = numbers[0], at.y = numbers[1];
    if (numbers.size() > 2) height = numbers[2];
  }
  if (!height) height = scene.height(at.x, at.y);
  if (!height) {
    throw Error(
        fmt::format("--mesh-at: there is no ground at {:g},{:g} for the mesh to stand on (give X,Y,Z; the scene "
                    "is {:g} x {:g} m)",
                    at.x, at.y, box.high.x - box.low.x, box.high.y - box.low.y));
  }
  at.z = *height;
  const Placement placement = mesh_placement(mesh_, {at, options_.scale, options_.turn_deg});
  std::vector<SceneFieldPtr> fields = scene.fields();
  std::vector<SceneObject> objects = scene.objects();
  objects.push_back(
      {.field = static_cast<std::uint32_t>(fields.size()), .material = kOwnMaterial, .placement = placement});
  fields.push_back(scene_mesh(mesh_));
  return {std::move(fields), std::move(objects)};
}

#else

// The rule of --mesh has refused all meshes.
Scene MeshInput::with_mesh(Scene scene) const { return scene; }

#endif

}  // namespace scarp::cli
