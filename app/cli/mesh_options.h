// SPDX-License-Identifier: MIT
// --mesh: a triangle mesh in a picture of terrain.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// What was typed.
struct MeshOptions {
  std::string file, at, up = "y";
  double scale = 1, turn_deg = 0;
};

/// Adds --mesh and what goes with it. `options` must live until the subcommand has run.
void add_mesh_options(CLI::App& command, MeshOptions& options);

/// Throws Error: --mesh without `device` or with a picture that has none.
void settle_mesh(const MeshOptions& options, const std::string& device, const PictureSettings& picture);

/// The mesh that was asked for, and terrain with it; without one all is as ever.
class MeshInput {
 public:
  /// Reads the file. Throws Error naming it.
  explicit MeshInput(const MeshOptions& options);
  ~MeshInput();

  /// Before pictures are made: where the mesh stands, which depends on the ground. Throws Error when it is to stand on
  /// the ground, and there is none.
  void stand_on(const TerrainScene& scene);
  Picture picture(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                  const PictureSettings& settings, const Progress& progress);
  PictureLayers layers(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                       const PictureSettings& settings, const Progress& progress);
  const std::vector<std::string>& notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;  // null: no mesh
};

}  // namespace scarp::cli
