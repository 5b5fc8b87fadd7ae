// SPDX-License-Identifier: MIT
// Triangle meshes: --mesh in any scene, and alone as an input.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "scarp/scene/scene.h"
#include "scarp/source/mesh_file.h"

namespace scarp::cli {

/// What was typed.
struct MeshOptions {
  std::string file, at, up = "y";
  double scale = 1, turn_deg = 0;
};

/// Declares --mesh and its settings.
void add_mesh_options(Command& command, MeshOptions& options);
/// Declares --mesh-up alone, for an input.
void add_mesh_up_option(Command& command, MeshOptions& options, std::vector<Rule> rules = {});

/// Whether the input is a mesh, by its ending. Throws Error when other inputs stand beside one.
bool is_mesh_input(const std::vector<std::string>& inputs);

/// A mesh that was typed, or none.
class MeshInput {
 public:
  /// Reads the file of --mesh, if there is one. `options` must live as long. Throws Error naming the file.
  explicit MeshInput(const MeshOptions& options) : MeshInput(options.file, options) {}
  /// Reads `path`, unless it is empty.
  MeshInput(const std::string& path, const MeshOptions& options);

  /// The scene with the mesh in it: without --mesh-at in the middle, on what is highest there, else on the nearest
  /// surface, else at the lowest point of the scene. Throws Error where --mesh-at has no Z and no surface below it.
  Scene with_mesh(Scene scene) const;
  /// The mesh alone: without --mesh-at where its file places it.
  Scene alone() const;

  const TriangleMesh& mesh() const { return mesh_; }
  const std::vector<std::string>& notes() const { return mesh_.notes; }

 private:
  const MeshOptions& options_;
  TriangleMesh mesh_;
};

/// What is in a mesh file, for `scarp info`.
nlohmann::ordered_json describe_mesh(const std::string& path, const MeshOptions& options);
std::string mesh_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
