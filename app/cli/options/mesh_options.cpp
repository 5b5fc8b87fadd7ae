// SPDX-License-Identifier: MIT
#include "app/cli/options/mesh_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/scene/material.h"
#include "scarp/source/mesh/mesh_file.h"
#ifdef SCARP_EMBREE
#include "scarp/scene/mesh/scene_mesh.h"
#endif

namespace scarp::cli {

bool is_mesh_input(const std::vector<std::string>& inputs) {
  const auto is_mesh = [](const std::string& path) {
    const std::string extension = extension_of(path);
    return extension == ".obj" || extension == ".gltf" || extension == ".glb";
  };
  const auto mesh = std::find_if(inputs.begin(), inputs.end(), is_mesh);
  if (mesh == inputs.end()) return false;
  if (inputs.size() > 1) throw Error(fmt::format("'{}': a mesh stands alone (give no other inputs)", *mesh));
  return true;
}

void add_mesh_options(Command& command, MeshOptions& options) {
  // The same options place a mesh that is itself the input.
  const Rule of_mesh = needs(
      "--mesh FILE", [&command] { return command.given("--mesh"); }, kEveryInput & ~kMesh);
  command.add(
      &options.file,
      {
          .names = "--mesh",
          .value = "FILE",
          .help = "triangle mesh in the scene: .obj, .gltf or .glb",
          .files = "obj gltf glb",
          .topic = Topic::mesh,
          .inputs = {kEveryInput & ~kMesh, "a scene file places several meshes"},
#ifndef SCARP_EMBREE
          .rules = {{"is not available: this scarp was built without Embree (SCARP_EMBREE=OFF)", [] { return false; }}},
#endif
      });
  command.add(&options.at,
              {.names = "--mesh-at",
               .value = "X,Y[,Z]",
               .help = "position of the mesh (see --coords): X,Y of its centre, Z of its lowest point",
               .fallback = "on the ground, at or nearest to the middle of the scene; mesh inputs: as in the file",
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
  add_mesh_up_option(command, options, {of_mesh});
}

void add_mesh_up_option(Command& command, MeshOptions& options, std::vector<Rule> rules) {
  command.add(&options.up, {.names = "--mesh-up",
                            .value = "AXIS",
                            .help = "axis of the file that points up",
                            .choices = {"y", "z"},
                            .closed = true,
                            .topic = Topic::mesh,
                            .inputs = {rules.empty() ? kMesh : kEveryInput, "it interprets mesh files"},
                            .rules = std::move(rules)});
}

MeshInput::MeshInput(const std::string& path, const MeshOptions& options) : options_(options) {
  if (!path.empty()) mesh_ = read_mesh(path, options.up == "z" ? MeshUp::z : MeshUp::y);
}

namespace {

constexpr std::string_view kMeshAt = "--mesh-at";

}  // namespace

std::string local_mesh_at(const MeshOptions& options, const Places& places) {
  const TypedPlace typed = typed_place(options.at, kMeshAt);
  const dvec3 at = places.world(dvec3(typed.x, typed.y, typed.z.value_or(0.0)), kMeshAt);
  return fmt::format("{:.17g},{:.17g}", at.x, at.y) + (typed.z ? fmt::format(",{:.17g}", at.z) : "");
}

#ifdef SCARP_EMBREE

namespace {

// The lattice point with a surface that is nearest to the scene's centre; if there is none, the centre at the lowest
// height.
dvec3 place_near_middle(const Scene& scene) {
  constexpr int kHalf = 32;  // lattice points from the centre to the border
  const WorldBox& box = scene.box();
  if (box.empty()) return {0, 0, surface_at(scene, 0, 0).value_or(0.0)};
  const dvec3 middle = 0.5 * (box.low + box.high), step = (box.high - middle) / static_cast<double>(kHalf);
  dvec3 best(middle.x, middle.y, box.low.z);
  if (const auto z = surface_at(scene, best.x, best.y)) return {best.x, best.y, *z};
  double least = std::numeric_limits<double>::infinity();
  for (int row = -kHalf; row <= kHalf; ++row) {
    for (int col = -kHalf; col <= kHalf; ++col) {
      const double x = middle.x + col * step.x, y = middle.y + row * step.y,
                   away = std::hypot(x - middle.x, y - middle.y);
      if (away >= least) continue;
      const auto z = surface_at(scene, x, y);
      if (z) best = {x, y, *z}, least = away;
    }
  }
  return best;
}

}  // namespace

Scene MeshInput::with_mesh(Scene scene, const Places& places) const {
  if (options_.file.empty()) return scene;
  const dvec3 at =
      options_.at.empty() ? place_near_middle(scene) : places.world(typed_place(options_.at, kMeshAt), scene, kMeshAt);
  const Placement placement = mesh_placement(mesh_, {at, options_.scale, options_.turn_deg});
  std::vector<SceneFieldPtr> fields = scene.fields();
  std::vector<SceneObject> objects = scene.objects();
  objects.push_back(
      {.field = static_cast<std::uint32_t>(fields.size()), .material = kOwnMaterial, .placement = placement});
  fields.push_back(scene_mesh(mesh_));
  return {std::move(fields), std::move(objects)};
}

Scene MeshInput::alone() const {
  MeshPlacement place{.scale = options_.scale, .turn_deg = options_.turn_deg};
  if (!options_.at.empty()) {
    const TypedPlace at = typed_place(options_.at, kMeshAt);
    place.at = {at.x, at.y, at.z.value_or(0.0)};
  }
  Placement placement = mesh_placement(mesh_, place);
  if (options_.at.empty()) placement.origin = dvec3(0.0);
  return {{scene_mesh(mesh_)}, {{.material = kOwnMaterial, .placement = placement}}};
}

#else

// The check of --mesh has already rejected all meshes.
Scene MeshInput::with_mesh(Scene scene, const Places&) const { return scene; }

Scene MeshInput::alone() const {
  throw Error("rays at a mesh are not available: this scarp was built without Embree (SCARP_EMBREE=OFF)");
}

#endif

nlohmann::ordered_json describe_mesh(const std::string& path, const MeshOptions& options) {
  const MeshInput input(path, options);
  dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const MeshCorner& corner : input.mesh().corners)
    low = glm::min(low, corner.position), high = glm::max(high, corner.position);
  return {{"path", path},
          {"kind", name_of(InputKind::mesh)},
          {"format", extension_of(path) == ".obj" ? "Wavefront OBJ" : "glTF"},
          {"triangles", input.mesh().corners.size() / 3},
          {"low", {low.x, low.y, low.z}},
          {"high", {high.x, high.y, high.z}},
          {"notes", input.notes()}};
}

std::string mesh_text_of(const nlohmann::ordered_json& info) {
  const auto corner = [&](const char* key) {
    const auto& p = info[key];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  };
  std::string out =
      fmt::format("{:<12} {}\n{:<12} {}\n{:<12} {}\n{:<12} {} to {}, z up, in units of the file\n", "file",
                  info["path"].get<std::string>(), "format", info["format"].get<std::string>(), "triangles",
                  info["triangles"].get<std::size_t>(), "box", corner("low"), corner("high"));
  for (const auto& note : info["notes"]) out += fmt::format("{:<12} {}\n", "note", note.get<std::string>());
  return out;
}

}  // namespace scarp::cli
