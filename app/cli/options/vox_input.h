// SPDX-License-Identifier: MIT
// Voxel files as inputs: MagicaVoxel, binvox, volumes of numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_volume.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/scene/voxel/voxel_shading.h"

namespace scarp::cli {

/// Typed options.
struct VoxOptions {
  VoxSceneOptions scene;
  bool surface_colours = false;
  std::string volume;  ///< empty: not a volume
  std::optional<double> solid_from;
  std::string up = "z";

  bool operator==(const VoxOptions&) const = default;
};

/// Typed options for the look of voxels.
struct VoxLookOptions {
  std::string normals = "flat";
  double normal_radius = VoxelShading{}.normal_radius;
  VoxelRounding rounding;
  bool corner_ao = false;
  bool coarse = false;

  bool operator==(const VoxLookOptions&) const = default;
};

/// Whether the input is a voxel file: by its extension, or because --volume was given. Throws Error if there are other
/// inputs as well.
bool is_vox_input(const std::vector<std::string>& inputs, const VoxOptions& options);

/// Declares --frame, --hidden, --volume, ...
void add_vox_options(Command& command, VoxOptions& options);
/// Declares --rounded and --each.
void add_vox_rounding_options(Command& command, VoxLookOptions& options);
/// Declares --normals, --corner-ao, ...
void add_vox_look_options(Command& command, VoxLookOptions& options);

/// Calls work(). Adds the file's name to errors in its contents.
template <class Work>
auto naming(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
}

/// Colours for the numbers of a volume, from the smallest to the largest.
std::vector<VoxelColour> colours_of(const std::string& ramp);

/// The contents of a voxel file.
struct VoxInput {
  std::optional<VoxFile> document;  ///< MagicaVoxel only
  PlacedVoxels voxels;
  std::optional<SolidRange> numbers{};  ///< volumes: range of the colours
  std::vector<std::string> notes{};     ///< one line each, for users
  std::string format = "binvox";        ///< name of the file's format
};
/// Throws Error naming the file if nothing is visible. `ramp`, one of ramp_names(), colours the numbers of volumes;
/// empty: not coloured.
VoxInput read_voxels(const std::string& path, const VoxOptions& options, const VoxelFileOptions& voxels,
                     const std::string& ramp);

/// The same, but also accepts files without visible voxels, except volumes.
VoxInput read_any_voxels(const std::string& path, const VoxOptions& options, const VoxelFileOptions& voxels,
                         const std::string& ramp);

VoxelShading shading_of(const VoxLookOptions& options);

/// Describes a voxel file, for `scarp info`.
nlohmann::ordered_json describe_vox(const std::string& path, const VoxOptions& options);
std::string vox_text_of(const nlohmann::ordered_json& info);

}  // namespace scarp::cli
