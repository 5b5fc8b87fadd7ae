// SPDX-License-Identifier: MIT
#include "app/cli/vox_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

#include "scarp/base/error.h"
#include "scarp/scene/from_vox.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

bool is_vox_path(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".vox";
}

}  // namespace

bool is_vox_input(const std::vector<std::string>& inputs) {
  const auto vox = std::find_if(inputs.begin(), inputs.end(), is_vox_path);
  if (vox == inputs.end()) return false;
  if (inputs.size() > 1) throw Error(fmt::format("'{}': a .vox file stands alone; give it without others", *vox));
  return true;
}

void add_vox_options(CLI::App& command, VoxSceneOptions& options) {
  const std::string group = "MagicaVoxel files";
  command.add_option("--frame", options.frame, "frame of an animation")
      ->check(CLI::Range(0, 1 << 30))
      ->group(group)
      ->capture_default_str();
  command.add_flag("--hidden", options.hidden, "with hidden objects and layers")->group(group);
}

Json describe_vox(const std::string& path, const VoxSceneOptions& options) {
  const VoxFile file = read_vox(path);
  Json info;
  info["path"] = path;
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
  info["instances"] = vox_instances(file, options).size();
  info["hidden_instances"] =
      vox_instances(file, {.frame = options.frame, .hidden = true}).size() - vox_instances(file, options).size();
  const VoxelScene scene = voxel_scene_from(file, {options});
  const WorldBox& box = scene.box();
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
  line("format", fmt::format("{}, version {}", info["format"].get<std::string>(), count("version")));
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
  line("scene", fmt::format("{} nodes, {} layers; {} objects, {} hidden", count("nodes"), count("layers"),
                            count("instances"), count("hidden_instances")));
  line("colours", fmt::format("{} of the {} palette; {} materials", count("colours_used"),
                              info["default_palette"].get<bool>() ? "default" : "file's", count("materials")));
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
