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

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  const std::string group = "Mesh";
  command.add_option("--mesh", options.file, "a triangle mesh, .obj, .gltf or .glb, in the scene")->group(group);
  command
      .add_option(
          "--mesh-at", options.at,
          "X,Y[,Z] in metres, as --eye: where its middle, seen from above, and its lowest point are (the middle "
          "of the field; on the ground)")
      ->group(group);
  command.add_option("--mesh-scale", options.scale, "metres per unit of the file, above 0")
      ->check(number_in(kAboveZero))
      ->group(group)
      ->capture_default_str();
  command.add_option("--mesh-rotate", options.turn_deg, "degrees clockwise, seen from above")
      ->check(number_in(kAnyNumber))
      ->group(group)
      ->capture_default_str();
  command.add_option("--mesh-up", options.up, "the axis that points up in the file, y or z")
      ->group(group)
      ->capture_default_str();
}

void settle_mesh(const MeshOptions& options) {
  if (options.file.empty()) return;
#ifndef SCARP_EMBREE
  throw Error("--mesh: this scarp was built without Embree (SCARP_EMBREE=OFF); leave it out");
#endif
  if (options.up != "y" && options.up != "z") throw Error(fmt::format("--mesh-up '{}': expected y or z", options.up));
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

// settle_mesh() has refused all meshes.
Scene MeshInput::with_mesh(Scene scene) const { return scene; }

#endif

}  // namespace scarp::cli
