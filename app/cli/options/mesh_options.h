// SPDX-License-Identifier: MIT
// Triangle meshes: added to any scene by --mesh, or as the input itself.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/places.h"
#include "app/options/command.h"
#include "scarp/scene/scene.h"
#include "scarp/source/mesh/mesh_file.h"

namespace scarp::cli {

/// Typed options.
struct MeshOptions {
  std::string file, at, up = "y";
  double scale = 1, turn_deg = 0;

  bool operator==(const MeshOptions&) const = default;
};

/// Declares --mesh and its settings.
void add_mesh_options(Command& command, MeshOptions& options);
/// Declares only --mesh-up, for inputs.
void add_mesh_up_option(Command& command, MeshOptions& options, std::vector<Rule> rules = {});

/// Whether the input is a mesh, by its extension. Throws Error if there are other inputs as well.
bool is_mesh_input(const std::vector<std::string>& inputs);

/// A mesh from the command line, or none.
class MeshInput {
 public:
  /// Reads the file of --mesh, if given. `options` must outlive the object. Throws Error naming the file.
  explicit MeshInput(const MeshOptions& options) : MeshInput(options.file, options) {}
  /// Reads `path`, unless it is empty.
  MeshInput(const std::string& path, const MeshOptions& options);

  /// Returns the scene with the mesh. Without --mesh-at, the mesh stands on the highest surface in the middle, or on
  /// the surface nearest to the middle, or at the lowest height of the scene. Throws Error if --mesh-at has neither Z
  /// nor a surface.
  Scene with_mesh(Scene scene, const Places& places) const;
  /// Returns the mesh alone; without --mesh-at, in the coordinates of its file.
  Scene alone() const;

  const TriangleMesh& mesh() const { return mesh_; }
  const std::vector<std::string>& notes() const { return mesh_.notes; }

 private:
  const MeshOptions& options_;
  TriangleMesh mesh_;
};

/// --mesh-at as typed, converted to local coordinates: "X,Y[,Z]". Throws Error as Places::world() does.
std::string local_mesh_at(const MeshOptions& options, const Places& places);

/// The contents of a mesh file, for `scarp info`.
nlohmann::ordered_json describe_mesh(const std::string& path, const MeshOptions& options);
std::string mesh_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
