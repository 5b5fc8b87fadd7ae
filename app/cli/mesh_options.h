// SPDX-License-Identifier: MIT
// --mesh: a triangle mesh in a scene.
#pragma once

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

/// The mesh that was typed, if any.
class MeshInput {
 public:
  /// Reads the file. `options` must live as long. Throws Error naming the file.
  explicit MeshInput(const MeshOptions& options);

  /// The scene with the mesh in it. Throws Error when the mesh is to stand on the ground, and there is none.
  Scene with_mesh(Scene scene) const;
  const std::vector<std::string>& notes() const { return mesh_.notes; }

 private:
  const MeshOptions& options_;
  TriangleMesh mesh_;
};

}  // namespace scarp::cli
