// SPDX-License-Identifier: MIT
#include "app/cli/options/vox_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/cli/progress.h"
#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/file/from_parts.h"
#include "scarp/scene/file/from_vdb.h"

namespace scarp::cli {
namespace {

constexpr int kRampColours = 255;

bool is_voxel_path(const std::string& path) {
  return extension_of(path) == ".vox" || extension_of(path) == ".binvox" || is_voxel_parts_path(path) ||
         is_vdb_path(path);
}

void refuse(bool given, const char* option, const char* files) {
  if (given) throw Error(fmt::format("{} applies to {} only", option, files));
}

}  // namespace

std::vector<VoxelColour> colours_of(const std::string& ramp) {
  if (ramp.empty()) return {kPlainVoxels};
  const Ramp colours(ramp, 0, kRampColours - 1);
  std::vector<VoxelColour> list;
  for (int i = 0; i < kRampColours; ++i) {
    const vec3 c = colours(i);
    list.push_back({srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z)});
  }
  return list;
}

bool is_vox_input(const std::vector<std::string>& inputs, const VoxOptions& options) {
  const auto vox = std::find_if(inputs.begin(), inputs.end(), is_voxel_path);
  if (vox == inputs.end() && options.volume.empty()) return false;
  if (inputs.size() > 1) {
    throw Error(
        fmt::format("'{}': a voxel file stands alone (give no other inputs)", vox == inputs.end() ? inputs[1] : *vox));
  }
  return true;
}

void add_vox_options(Command& command, VoxOptions& options) {
  constexpr Inputs kModels{kVoxels, "it interprets voxel files"};
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::voxels;
    option.inputs = kModels;
    command.add(std::move(to), std::move(option));
  };
  add(&options.scene.frame, {.names = "--frame", .help = "frame of a MagicaVoxel animation", .range = {.least = 0}});
  add(&options.scene.hidden, {.names = "--hidden", .help = "hidden MagicaVoxel objects and layers as well"});
  add(&options.surface_colours,
      {.names = "--surface-colours", .help = "colours of visible voxels only: saves memory, drops the others"});
  add(&options.volume, {.names = "--volume",
                        .value = "FORMAT",
                        .help = "layout of IN, one number per voxel: npy (an array [z][y][x]), or "
                                "NXxNYxNZ:TYPE[+OFFSET], x fastest, for example 256x256x128:u16le"});
  add(&options.solid_from, {.names = "--solid-from",
                            .help = "smallest value of a volume that is solid",
                            .fallback = "all above 0",
                            .rules = {needs("--volume FORMAT", [&options] { return !options.volume.empty(); })}});
  add(&options.up, {.names = "--up",
                    .value = "AXIS",
                    .help = "axis of a binvox or OpenVDB file or volume that points up",
                    .choices = {"y", "z"},
                    .closed = true});
}

void add_vox_rounding_options(Command& command, VoxLookOptions& options) {
  constexpr Inputs kModels{kVoxels, "only voxels have edges to round"};
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::voxels;
    command.add(std::move(to), std::move(option));
  };
  add(&options.rounding.radius,
      {.names = "--rounded", .help = "radius of exposed edges in voxel sides", .range = {0, 0.5}, .inputs = kModels});
  add(&options.rounding.each,
      {.names = "--each",
       .help = "every voxel rounded on all sides, like a heap of dice",
       .inputs = kModels,
       .rules = {needs("--rounded F", [&options] { return static_cast<bool>(options.rounding); })}});
}

void add_vox_look_options(Command& command, VoxLookOptions& options) {
  constexpr Inputs kModels{kVoxels, "only voxels have faces to shade"};
  constexpr Looks kShaded{"shaded", "the others show numbers"};
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::voxels;
    command.add(std::move(to), std::move(option));
  };
  add(&options.normals,
      {.names = "--normals",
       .value = "KIND",
       .help = "normals",
       .choices = {"flat", "voxel", "smooth"},
       .closed = true,
       .note = "flat: face normal; voxel: one per face, from the shape around; smooth: from the shape",
       .inputs = kModels,
       .looks = kShaded});
  add(&options.normal_radius,
      {.names = "--normal-radius",
       .help = "radius of smooth normals in voxels",
       .range = {1, 8},
       .inputs = kModels,
       .looks = kShaded,
       .rules = {needs("--normals voxel or smooth", [&options] { return options.normals != "flat"; })}});
  add(&options.corner_ao,
      {.names = "--corner-ao",
       .help = "ambient occlusion in corners from neighbouring voxels, unless --samples computes it",
       .inputs = kModels,
       .looks = kShaded});
  add(&options.coarse, {.names = "--coarse-voxels",
                        .help = "voxels smaller than pixels merged 2 x 2 x 2",
                        .inputs = {kVoxels | kScene, "only voxels can be merged"}});
}

namespace {

VoxInput read_volume_voxels(const std::string& path, const VoxOptions& options, const FromVolumeOptions& from,
                            const std::string& ramp) {
  naming(path, [&] { require_marchable(volume_format_of(path, options.volume), from.voxels); });
  const DenseVolume numbers = read_volume(path, options.volume);
  stop_if_interrupted();
  const SolidRange range = ramp.empty() ? SolidRange{} : solid_range(numbers, options.solid_from);
  VoxInput input{{}, placed_voxels_from(numbers, colours_of(ramp), range, from)};
  if (input.voxels.models[0]->grid().solid_count() == 0) {
    const SolidRange all = number_range(numbers);
    if (all.low > all.high)
      throw Error(fmt::format("{}: no voxel is solid: all numbers are NaN (is --volume right?)", path));
    throw Error(fmt::format("{}: no voxel is solid: its numbers are {} to {} (choose --solid-from in this range)", path,
                            all.low, all.high));
  }
  if (!ramp.empty() && std::isfinite(range.high)) input.numbers = range;
  return input;
}

VoxInput read_parts(const std::string& path, const VoxelFileOptions& voxels) {
  const VoxelParts parts = read_voxel_parts(path);
  VoxInput input{{}, naming(path, [&] { return placed_voxels_from(parts, voxels); })};
  input.format = parts.format, input.notes = parts.notes;
  return input;
}

VoxInput read_grid(const std::string& path, const VoxelFileOptions& voxels, UpAxis up) {
  const VdbVoxels grid = read_vdb(path);
  stop_if_interrupted();
  VoxInput input{{}, naming(path, [&] { return placed_voxels_from(grid, voxels, up); })};
  input.format = fmt::format("{}, {} '{}'", grid.format, grid.kind, grid.grid);
  input.notes = grid.notes;
  return input;
}

VoxInput read_document(const std::string& path, const VoxOptions& options, const VoxelFileOptions& voxels) {
  VoxFile document = read_vox(path);
  VoxInput input{{}, naming(path, [&] { return placed_voxels_from(document, {options.scene, voxels}); })};
  input.notes = vox_notes(document, options.scene);
  input.document = std::move(document);
  input.format = "MagicaVoxel";
  return input;
}

}  // namespace

VoxInput read_any_voxels(const std::string& path, const VoxOptions& options, const VoxelFileOptions& voxels,
                         const std::string& ramp) {
  const bool volume = !options.volume.empty(), binvox = !volume && extension_of(path) == ".binvox";
  const bool parts = !volume && !binvox && is_voxel_parts_file(path);
  const FromVolumeOptions from{voxels, options.up == "y" ? UpAxis::y : UpAxis::z, options.solid_from};
  const bool vdb = !volume && is_vdb_path(path);
  refuse((volume || binvox || parts || vdb) && options.scene.frame > 0, "--frame", "MagicaVoxel files");
  refuse((volume || binvox || parts || vdb) && options.scene.hidden, "--hidden", "MagicaVoxel files");
  refuse(!volume && !binvox && !vdb && options.up != "z", "--up", "binvox and OpenVDB files and volumes");
  if (vdb) return read_grid(path, voxels, from.up);
  if (volume) return read_volume_voxels(path, options, from, ramp);
  if (parts) return read_parts(path, voxels);
  if (!binvox) return read_document(path, options, voxels);
  const Binvox solid = read_binvox(path);
  return {{}, naming(path, [&] { return placed_voxels_from(solid, kPlainVoxels, from); })};
}

VoxInput read_voxels(const std::string& path, const VoxOptions& options, const VoxelFileOptions& voxels,
                     const std::string& ramp) {
  VoxInput input = read_any_voxels(path, options, voxels, ramp);
  if (world_box(input.voxels).empty()) {
    const bool hidden = naming(path, [&] {
      return input.document && !options.scene.hidden &&
             !vox_instances(*input.document, {.frame = options.scene.frame, .hidden = true}).empty() &&
             vox_instances(*input.document, options.scene).empty();
    });
    throw Error(fmt::format("{}: no visible voxels ({})", path,
                            hidden ? "all are hidden: --hidden shows them" : "see 'scarp info' for what it contains"));
  }
  return input;
}

VoxelShading shading_of(const VoxLookOptions& options) {
  VoxelShading shading;
  shading.normals = options.normals == "smooth"  ? VoxelNormals::smooth
                    : options.normals == "voxel" ? VoxelNormals::voxel
                                                 : VoxelNormals::flat;
  shading.normal_radius = options.normal_radius;
  shading.corner_ao = options.corner_ao;
  validate(shading);
  validate(options.rounding);
  return shading;
}

}  // namespace scarp::cli
