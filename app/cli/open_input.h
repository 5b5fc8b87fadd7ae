// SPDX-License-Identifier: MIT
// The inputs of subcommands that trace rays, as scenes: terrain, voxels, scene files, functions, meshes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/function_input.h"
#include "app/cli/mesh_options.h"
#include "app/cli/option.h"
#include "app/cli/vox_input.h"
#include "scarp/base/georeference.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/scene/file/scene_file.h"
#include "scarp/scene/scene.h"
#include "scarp/source/raster_options.h"

namespace scarp::cli {

/// The march for terrain without --march.
constexpr const char* kTerrainMarch = "max-mip";

/// What was typed.
struct InputOptions {
  std::vector<std::string> inputs;
  RasterOptions raster;
  FieldOptions field;
  VoxOptions vox;
  VoxLookOptions vox_look;
  FunctionInput function;
  MeshOptions mesh;
  std::string march;  ///< empty: the fastest exact one
  MarchSettings march_settings;
  std::string device;
};

/// The kind of the inputs, by their names and the options beside them. Throws Error or WrongUsage: none, or several
/// kinds at once.
InputKind kind_of_input(const Command& command, const InputOptions& options);

/// The march whose settings count; empty for inputs whose marches have none.
std::string_view march_of(const InputOptions& options, InputKind kind);

struct OpenedInput {
  Scene scene{{}, {}};
  std::vector<std::string> notes{};  ///< one line each, for people
  std::vector<std::string> files{};  ///< that were read, beside those that were typed

  // Of terrain alone.
  std::string path{};  ///< of the first raster, for messages
  Georeference georeference{};
  int cols = 0, rows = 0;

  std::optional<SolidRange> numbers{};       ///< of a volume, shown by the ramp
  std::optional<SceneFile> document{};       ///< of a scene file
  std::optional<HeightFunction> function{};  ///< of a function
};

/// Reads the inputs and builds what rays need, without the mesh of --mesh. Numbers of volumes are shown by `ramp`, of
/// ramp_names(); empty: not at all. Throws Error naming the file.
OpenedInput open_input(InputKind kind, const InputOptions& options, const std::string& ramp = {});

}  // namespace scarp::cli
