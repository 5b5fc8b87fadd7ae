// SPDX-License-Identifier: MIT
#include "app/cli/vox_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/scene_field.h"
#include "scarp/source/vox_animation.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRampColours = 255;

bool is_voxel_path(const std::string& path) { return extension_of(path) == ".vox" || extension_of(path) == ".binvox"; }

// What is wrong with a file that has been read names it, too.
template <class Work>
auto naming(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
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
      {.names = "--surface-colours", .help = "colours of visible voxels only: less memory, lossy inside"});
  add(&options.volume, {.names = "--volume",
                        .value = "FORMAT",
                        .help = "layout of IN, one number per voxel: npy (an array [z][y][x]), or "
                                "NXxNYxNZ:TYPE[+OFFSET], x fastest, for example 256x256x128:u16le"});
  add(&options.solid_from, {.names = "--solid-from",
                            .help = "smallest number of a solid voxel of a volume",
                            .fallback = "all above 0",
                            .rules = {needs("--volume FORMAT", [&options] { return !options.volume.empty(); })}});
  add(&options.up, {.names = "--up",
                    .value = "AXIS",
                    .help = "axis of a binvox file or volume that points up",
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
      {.names = "--rounded", .help = "radius of open edges in sides of a voxel", .range = {0, 0.5}, .inputs = kModels});
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
  add(&options.normals, {.names = "--normals",
                         .value = "KIND",
                         .help = "normals",
                         .choices = {"flat", "voxel", "smooth"},
                         .closed = true,
                         .note = "flat: of the face; voxel: one per face, of the shape around it; smooth: of the shape",
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

VoxInput read_voxels(const std::string& path, const VoxOptions& options, const VoxelFileOptions& voxels,
                     const std::string& ramp) {
  const bool volume = !options.volume.empty(), binvox = !volume && extension_of(path) == ".binvox";
  const FromVolumeOptions from{voxels, options.up == "y" ? UpAxis::y : UpAxis::z, options.solid_from};
  refuse((volume || binvox) && options.scene.frame > 0, "--frame", "MagicaVoxel files");
  refuse((volume || binvox) && options.scene.hidden, "--hidden", "MagicaVoxel files");
  refuse(!volume && !binvox && options.up != "z", "--up", "binvox files and volumes");
  if (volume) {
    const DenseVolume numbers = read_volume(path, options.volume);
    VoxInput input{{}, placed_voxels_from(numbers, colours_of(ramp), from)};
    const SolidRange range = solid_range(numbers, options.solid_from);
    if (!ramp.empty() && std::isfinite(range.high)) input.numbers = range;
    return input;
  }
  if (binvox) return {{}, placed_voxels_from(read_binvox(path), kPlainVoxels, from)};
  VoxFile document = read_vox(path);
  PlacedVoxels placed = naming(path, [&] { return placed_voxels_from(document, {options.scene, voxels}); });
  std::vector<std::string> notes = vox_notes(document, options.scene);
  return {std::move(document), std::move(placed), {}, std::move(notes)};
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

namespace {

void describe_document(const VoxFile& file, const VoxOptions& options, Json& info) {
  info["format"] = "MagicaVoxel";
  info["version"] = file.version;
  info["models"] = Json::array();
  for (const VoxModel& model : file.models) {
    const auto solid =
        std::count_if(model.voxels.begin(), model.voxels.end(), [](const auto& v) { return v.index > 0; });
    info["models"].push_back({{"size", {model.size.x, model.size.y, model.size.z}}, {"voxels", solid}});
  }
  std::set<int> colours;
  for (const VoxModel& model : file.models) {
    for (const VoxVoxel& voxel : model.voxels) colours.insert(voxel.index);
  }
  colours.erase(0);
  info["colours_used"] = colours.size();
  info["default_palette"] = !file.palette.has_value();
  info["nodes"] = file.nodes.size();
  info["layers"] = file.layers.size();
  info["materials"] = file.materials.size();
  const std::size_t shown = vox_instances(file, options.scene).size();
  info["instances"] = shown;
  const VoxAnimation animation = vox_animation(file);
  info["frames"] = animation.frames;
  info["loops"] = !animation.loops ? "none" : animation.ends ? "parts" : "all";
  info["hidden_instances"] = vox_instances(file, {.frame = options.scene.frame, .hidden = true}).size() - shown;
}

}  // namespace

Json describe_vox(const std::string& path, const VoxOptions& options) {
  VoxelFileOptions voxels;
  voxels.surface_colours = options.surface_colours;
  const VoxInput input = read_voxels(path, options, voxels, {});
  Json info;
  info["path"] = path;
  info["kind"] = name_of(InputKind::voxels);
  if (input.document) {
    naming(path, [&] { describe_document(*input.document, options, info); });
  } else {
    info["format"] = options.volume.empty() ? "binvox" : "volume";
    const VoxelGrid& grid = input.voxels.models[0]->grid();
    info["models"] = {{{"size", {grid.size().x, grid.size().y, grid.size().z}}, {"voxels", grid.solid_count()}}};
  }
  const SceneFieldPtr field = scene_voxels(input.voxels);
  info["bytes"] = field->bytes();
  const WorldBox box = *field->box();
  const auto corner = [](const dvec3& p) { return Json{std::llround(p.x), std::llround(p.y), std::llround(p.z)}; };
  info["low"] = box.empty() ? Json() : corner(box.low);
  info["high"] = box.empty() ? Json() : corner(box.high);
  info["notes"] = input.notes;
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
    const std::int64_t frames = count("frames");
    const auto loops = info["loops"].get<std::string>();
    line("frames", frames == 1 ? "1"
                               : fmt::format("{} (--frame 0 to {}){}", frames, frames - 1,
                                             loops == "all"     ? ", repeating"
                                             : loops == "parts" ? ", parts of them repeating"
                                                                : ""));
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
  for (const Json& note : info["notes"]) line("note", note.get<std::string>());
  return out;
}

}  // namespace scarp::cli
