// SPDX-License-Identifier: MIT
// The inputs of subcommands that trace rays, as scenes: terrain, voxels, scene files, functions, meshes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options/field_options.h"
#include "app/cli/options/function_input.h"
#include "app/cli/options/mesh_options.h"
#include "app/cli/options/vox_input.h"
#include "app/options/option.h"
#include "scarp/base/georeference.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/scene/file/scene_file.h"
#include "scarp/scene/scene.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp::cli {

/// The march for terrain without --march.
constexpr const char* kTerrainMarch = "max-mip";

/// Options as typed.
struct InputOptions {
  std::vector<std::string> inputs;
  RasterOptions raster;
  std::optional<RasterWindow> part;  ///< of the raster, with its cell lengths (source/raster/opened_raster.h)
  FieldOptions field;
  Exaggeration exaggeration;
  VoxOptions vox;
  VoxLookOptions vox_look;
  FunctionInput function;
  MeshOptions mesh;
  std::string march;  ///< empty: the fastest exact one
  MarchSettings march_settings;
  std::string device;
  /// Whether the camera will move. If so, large rasters are read for any view, and the CPU traces rays in addition to
  /// `device`.
  bool moves = false;

  bool operator==(const InputOptions&) const = default;
};

/// Returns the kind of the inputs, by their names and options. Throws Error or WrongUsage if there is none or several.
InputKind kind_of_input(const Command& command, const InputOptions& options);

/// Returns the march whose settings apply; empty for inputs whose marches have no settings.
std::string_view march_of(const InputOptions& options, InputKind kind);

struct OpenedInput {
  Scene scene{{}, {}};
  std::vector<std::string> notes{};  ///< one line each, for users
  std::vector<std::string> files{};  ///< files read in addition to those that were typed

  // Terrain only.
  std::string path{};  ///< first raster, for messages
  Georeference georeference{};
  int cols = 0, rows = 0;

  std::optional<SolidRange> numbers{};       ///< volumes: range that the ramp shows
  std::optional<SceneFile> document{};       ///< scene files
  std::optional<HeightFunction> function{};  ///< functions
};

/// Reads the inputs and builds their scene, without the mesh of --mesh. `ramp`, one of ramp_names(), colours the
/// numbers of volumes; empty: one colour. Throws Error naming the file.
OpenedInput open_input(InputKind kind, const InputOptions& options, const std::string& ramp = {});

}  // namespace scarp::cli
