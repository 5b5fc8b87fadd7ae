// SPDX-License-Identifier: MIT
#include "app/cli/vox_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/file/from_volume.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

bool is_voxel_path(const std::string& path) { return extension_of(path) == ".vox" || extension_of(path) == ".binvox"; }

constexpr int kRampColours = 255;

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

// What is wrong with a file that has been read names it, too.
template <class Work>
auto naming(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("voxels '{}': {}", path, error.what()));
  }
}

void refuse(bool given, const char* option, const char* goes_with) {
  if (given) throw Error(fmt::format("{}: goes with {}; leave it out", option, goes_with));
}

}  // namespace

bool is_vox_input(const std::vector<std::string>& inputs, const VoxOptions& options) {
  const auto vox = std::find_if(inputs.begin(), inputs.end(), is_voxel_path);
  if (vox == inputs.end() && options.volume.empty()) return false;
  if (inputs.size() > 1) {
    throw Error(fmt::format("'{}': a file of voxels stands alone; give it without others",
                            vox == inputs.end() ? inputs[1] : *vox));
  }
  return true;
}

void add_vox_options(CLI::App& command, VoxOptions& options) {
  const std::string group = "Files of voxels";
  command.add_option("--frame", options.scene.frame, "frame of an animation (MagicaVoxel)")
      ->check(CLI::Range(0, 1 << 30))
      ->group(group)
      ->capture_default_str();
  command.add_flag("--hidden", options.scene.hidden, "with hidden objects and layers (MagicaVoxel)")->group(group);
  command
      .add_flag("--surface-colours", options.surface_colours,
                "drop colours that cannot be seen from outside: less memory, lossy inside")
      ->group(group);
  command
      .add_option("--volume", options.volume,
                  "IN is numbers, one per voxel: npy (an array [z][y][x]), or NXxNYxNZ:TYPE[+OFFSET]: "
                  "256x256x128:u16le, x fastest")
      ->group(group);
  command.add_option("--solid-from", options.solid_from, "the least number of a solid voxel of a volume (all above 0)")
      ->check(number_in(kAnyNumber))
      ->group(group);
  command.add_option("--up", options.up, "y or z: the axis of a binvox file or volume that points up")
      ->check(CLI::IsMember({"y", "z"}))
      ->group(group)
      ->capture_default_str();
}

void add_vox_look_options(CLI::App& command, VoxLookOptions& options) {
  const std::string group = "Looks of voxels";
  command
      .add_option("--normals", options.normals,
                  "flat: of the face; voxel: one per face, of the shape it is part of; smooth: of the shape")
      ->check(CLI::IsMember({"flat", "voxel", "smooth"}))
      ->group(group)
      ->capture_default_str();
  command.add_option("--normal-radius", options.normal_radius, "voxels that those of the shape look at, 1 to 8")
      ->check(number_in({1, 8}))
      ->group(group)
      ->capture_default_str();
  command
      .add_option("--rounded", options.rounding.radius,
                  "radius of the edges that are open, in sides of a voxel, 0 to 0.5")
      ->check(number_in({0, 0.5}))
      ->group(group)
      ->capture_default_str();
  command.add_flag("--each", options.rounding.each, "with --rounded: every voxel on its own, as a heap of dice")
      ->group(group);
  command
      .add_flag("--corner-ao", options.corner_ao,
                "darker corners, by the voxels next to them; not where --samples asks the sky")
      ->group(group);
  command.add_flag("--coarse-voxels", options.coarse, "voxels that are smaller than pixels are made one of 2 x 2 x 2")
      ->group(group);
}

VoxInput read_voxels(const std::string& path, const VoxOptions& options, const VoxelSceneOptions& voxels,
                     const std::string& ramp) {
  const bool volume = !options.volume.empty(), binvox = !volume && extension_of(path) == ".binvox";
  const FromVolumeOptions from{voxels, options.up == "y" ? UpAxis::y : UpAxis::z, options.solid_from};
  refuse(!volume && options.solid_from.has_value(), "--solid-from", "--volume");
  refuse((volume || binvox) && options.scene.frame > 0, "--frame", "MagicaVoxel files");
  refuse((volume || binvox) && options.scene.hidden, "--hidden", "MagicaVoxel files");
  refuse(!volume && !binvox && options.up != "z", "--up", "binvox files and volumes: MagicaVoxel's z is up");
  if (volume) return {{}, voxel_scene_from(read_volume(path, options.volume), colours_of(ramp), from)};
  if (binvox) return {{}, voxel_scene_from(read_binvox(path), kPlainVoxels, from)};
  VoxFile document = read_vox(path);
  VoxelScene scene = naming(path, [&] { return voxel_scene_from(document, {options.scene, voxels}); });
  return {std::move(document), std::move(scene)};
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
  if (options.rounding.each && !options.rounding) throw Error("--each: goes with --rounded; give a radius");
  return shading;
}

namespace {

void describe_document(const VoxFile& file, const VoxOptions& options, Json& info) {
  info["format"] = "MagicaVoxel";
  info["version"] = file.version;
  info["models"] = Json::array();
  for (const VoxModel& model : file.models)
    info["models"].push_back({{"size", {model.size.x, model.size.y, model.size.z}}, {"voxels", model.voxels.size()}});
  std::set<int> colours;
  for (const VoxModel& model : file.models) {
    for (const VoxVoxel& voxel : model.voxels) colours.insert(voxel.index);
  }
  info["colours_used"] = colours.size();
  info["default_palette"] = !file.palette.has_value();
  info["nodes"] = file.nodes.size();
  info["layers"] = file.layers.size();
  info["materials"] = file.materials.size();
  const std::size_t shown = vox_instances(file, options.scene).size();
  info["instances"] = shown;
  info["hidden_instances"] = vox_instances(file, {.frame = options.scene.frame, .hidden = true}).size() - shown;
}

}  // namespace

Json describe_vox(const std::string& path, const VoxOptions& options) {
  VoxelSceneOptions voxels;
  voxels.surface_colours = options.surface_colours;
  const VoxInput input = read_voxels(path, options, voxels, {});
  Json info;
  info["path"] = path;
  if (input.document) {
    naming(path, [&] { describe_document(*input.document, options, info); });
  } else {
    info["format"] = options.volume.empty() ? "binvox" : "volume";
    const VoxelGrid& grid = input.scene.models()[0]->grid();
    info["models"] = {{{"size", {grid.size().x, grid.size().y, grid.size().z}}, {"voxels", grid.solid_count()}}};
  }
  std::size_t bytes = input.scene.bytes();
  for (const auto& model : input.scene.models()) bytes += model->bytes();
  info["bytes"] = bytes;
  const WorldBox& box = input.scene.box();
  const bool empty = !(box.low.x <= box.high.x);
  const auto corner = [](const dvec3& p) { return Json{std::llround(p.x), std::llround(p.y), std::llround(p.z)}; };
  info["low"] = empty ? Json() : corner(box.low);
  info["high"] = empty ? Json() : corner(box.high);
  return info;
}

std::string vox_text_of(const Json& info) {
  std::string out;
  const auto line = [&](std::string_view name, const std::string& value) {
    out += fmt::format("{:<12} {}\n", name, value);
  };
  const auto count = [&](const char* name) { return info[name].get<std::int64_t>(); };
  line("file", info["path"].get<std::string>());
  const bool document = info.contains("version");
  line("format", info["format"].get<std::string>() + (document ? fmt::format(", version {}", count("version")) : ""));
  std::int64_t voxels = 0;
  for (const Json& model : info["models"]) voxels += model["voxels"].get<std::int64_t>();
  line("models", fmt::format("{}, {} voxels", info["models"].size(), voxels));
  constexpr std::size_t kListed = 8;
  for (std::size_t i = 0; i < std::min(kListed, info["models"].size()); ++i) {
    const Json& model = info["models"][i];
    line("", fmt::format("{}: {} x {} x {}, {} voxels", i, model["size"][0].get<int>(), model["size"][1].get<int>(),
                         model["size"][2].get<int>(), model["voxels"].get<std::int64_t>()));
  }
  if (info["models"].size() > kListed) line("", fmt::format("... and {} more", info["models"].size() - kListed));
  if (document) {
    line("scene", fmt::format("{} nodes, {} layers; {} objects, {} hidden", count("nodes"), count("layers"),
                              count("instances"), count("hidden_instances")));
    line("colours", fmt::format("{} of the {} palette; {} materials", count("colours_used"),
                                info["default_palette"].get<bool>() ? "default" : "file's", count("materials")));
  }
  line("memory", fmt::format("{} bytes, with all that rays need", count("bytes")));
  if (info["low"].is_null()) {
    line("box", "empty: there is no voxel to see");
  } else {
    const auto at = [&](const char* name, int axis) { return info[name][axis].get<std::int64_t>(); };
    line("box", fmt::format("({}, {}, {}) to ({}, {}, {}) voxels", at("low", 0), at("low", 1), at("low", 2),
                            at("high", 0), at("high", 1), at("high", 2)));
  }
  return out;
}

}  // namespace scarp::cli
