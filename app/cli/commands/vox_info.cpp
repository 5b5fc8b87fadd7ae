// SPDX-License-Identifier: MIT
// `scarp info` of voxel files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "app/cli/options/vox_input.h"
#include "scarp/base/lattice_rotation.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/voxel/lattice_place.h"
#include "scarp/source/voxel/vdb_file.h"
#include "scarp/source/voxel/vox_animation.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

// Maximum number of lines of each list in the text; JSON has all of them.
constexpr std::size_t kListed = 8, kListedColours = 16;

using Counts = std::array<std::int64_t, 256>;  // voxels per palette index

Counts count_colours(const VoxFile& file) {
  Counts counts{};
  for (const VoxModel& model : file.models) {
    for (const VoxVoxel& voxel : model.voxels) ++counts[voxel.index];
  }
  counts[0] = 0;
  return counts;
}

Json palette_of(const VoxFile& file, const Counts& counts) {
  Json palette = Json::array();
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const VoxColour& c = file.colours()[i - 1];
    palette.push_back(
        {{"index", i}, {"colour", fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2])}, {"voxels", counts[i]}});
  }
  std::stable_sort(palette.begin(), palette.end(),
                   [](const Json& a, const Json& b) { return a["voxels"] > b["voxels"]; });
  return palette;
}

Json layers_of(const VoxFile& file) {
  Json layers = Json::array();
  for (const VoxLayer& layer : file.layers) {
    layers.push_back({{"id", layer.id},
                      {"name", std::string(find_attribute(layer.attributes, "_name").value_or(""))},
                      {"hidden", find_attribute(layer.attributes, "_hidden") == "1"}});
  }
  return layers;
}

// Materials of used colours, except plain diffuse ones.
Json materials_of(const VoxFile& file, const Counts& counts) {
  constexpr std::string_view kPlain = "_diffuse";
  Json materials = Json::array();
  for (const VoxMaterial& material : file.materials) {
    // The editor writes entry 256 as 0.
    if (material.id < 1 || material.id > 255 || counts[static_cast<std::size_t>(material.id)] == 0) continue;
    const std::string_view type = find_attribute(material.attributes, "_type").value_or(kPlain);
    if (type == kPlain) continue;
    Json values = Json::object();
    for (const auto& [name, value] : material.attributes) {
      if (name != "_type") values[name.starts_with('_') ? name.substr(1) : name] = value;
    }
    materials.push_back(
        {{"index", material.id}, {"type", type.substr(type.starts_with('_') ? 1 : 0)}, {"values", values}});
  }
  return materials;
}

void describe_document(const VoxFile& file, const VoxOptions& options, Json& info) {
  info["version"] = file.version;
  info["models"] = Json::array();
  for (const VoxModel& model : file.models) {
    const auto solid =
        std::count_if(model.voxels.begin(), model.voxels.end(), [](const auto& v) { return v.index > 0; });
    info["models"].push_back({{"size", {model.size.x, model.size.y, model.size.z}}, {"voxels", solid}});
  }
  const Counts counts = count_colours(file);
  info["palette"] = palette_of(file, counts);
  info["colours_used"] = info["palette"].size();
  info["default_palette"] = !file.palette.has_value();
  info["nodes"] = file.nodes.size();
  info["layers"] = layers_of(file);
  info["materials"] = materials_of(file, counts);
  const std::size_t shown = vox_instances(file, options.scene).size();
  info["instances"] = shown;
  const VoxAnimation animation = vox_animation(file);
  info["frames"] = animation.frames;
  info["loops"] = !animation.loops ? "none" : animation.ends ? "parts" : "all";
  info["hidden_instances"] = vox_instances(file, {.frame = options.scene.frame, .hidden = true}).size() - shown;
}

std::string more(std::size_t count) { return fmt::format("... and {} more", count); }

using WriteLine = std::function<void(std::string_view name, const std::string& value)>;

// Writes a list: `title`, then a line per item.
template <class TextOf>
void list(const WriteLine& line, std::string_view name, const std::string& title, const Json& items,
          const TextOf& text_of) {
  line(name, title);
  for (std::size_t i = 0; i < std::min(kListed, items.size()); ++i) line("", text_of(i, items[i]));
  if (items.size() > kListed) line("", more(items.size() - kListed));
}

void write_palette(const WriteLine& line, const Json& info) {
  const Json& palette = info["palette"];
  line("colours", fmt::format("{} of the {} palette: index, colour, voxels", palette.size(),
                              info["default_palette"].get<bool>() ? "default" : "file's"));
  constexpr std::size_t kPerLine = 4;
  std::string row;
  for (std::size_t i = 0; i < std::min(kListedColours, palette.size()); ++i) {
    row += fmt::format("{}{:>3} {} {:<10}", row.empty() ? "" : " ", palette[i]["index"].get<int>(),
                       palette[i]["colour"].get<std::string>(), palette[i]["voxels"].get<std::int64_t>());
    if ((i + 1) % kPerLine != 0 && i + 1 < std::min(kListedColours, palette.size())) continue;
    line("", row.substr(0, row.find_last_not_of(' ') + 1));
    row.clear();
  }
  if (palette.size() > kListedColours) line("", more(palette.size() - kListedColours));
}

void write_document(const WriteLine& line, const Json& info) {
  const auto count = [&](const char* name) { return info[name].get<std::int64_t>(); };
  const std::int64_t hidden = count("hidden_instances");
  line("scene", fmt::format("{} nodes; {} objects{}", count("nodes"), count("instances"),
                            hidden > 0 ? fmt::format(", {} hidden ones are left out (--hidden)", hidden) : ""));
  // The editor writes empty layers; only named or hidden layers are of interest.
  Json layers = Json::array();
  for (const Json& layer : info["layers"]) {
    if (layer["hidden"].get<bool>() || !layer["name"].get<std::string>().empty()) layers.push_back(layer);
  }
  list(line, "layers", fmt::format("{}", info["layers"].size()), layers, [](std::size_t, const Json& layer) {
    return fmt::format("{} '{}'{}", layer["id"].get<int>(), layer["name"].get<std::string>(),
                       layer["hidden"].get<bool>() ? ", hidden: its objects are left out" : "");
  });
  const std::int64_t frames = count("frames");
  const auto loops = info["loops"].get<std::string>();
  line("frames", frames == 1 ? "1"
                             : fmt::format("{} (--frame 0 to {}){}", frames, frames - 1,
                                           loops == "all"     ? ", repeating"
                                           : loops == "parts" ? ", parts of them repeating"
                                                              : ""));
  write_palette(line, info);
  list(line, "materials", fmt::format("{} of these colours are not plain", info["materials"].size()), info["materials"],
       [](std::size_t, const Json& material) {
         std::string text = fmt::format("{:>3} {}", material["index"].get<int>(), material["type"].get<std::string>());
         for (const auto& [name, value] : material["values"].items())
           text += fmt::format(", {} {}", name, value.get<std::string>());
         return text;
       });
}

// Placement of a part of the scene. The corner p of a voxel in the file is at offset + axes[0] p.x + axes[1] p.y +
// axes[2] p.z.
Json part_of(const PlacedVoxels& voxels, const VoxelPlace& place) {
  const LatticePlace& in_file = voxels.models[place.model]->file_place();
  const LatticeRotation back = in_file.turn().inverse();
  const dvec3 offset = place.origin - place.world_from_grid * dvec3(back(in_file.origin()));
  Json axes = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 along(0.0);
    along[axis] = 1;
    const dvec3 a = place.world_from_grid * back(along) + 0.0;  // no -0
    axes.push_back({a.x, a.y, a.z});
  }
  return {{"offset", {offset.x, offset.y, offset.z}}, {"axes", axes}};
}

}  // namespace

Json describe_vox(const std::string& path, const VoxOptions& options) {
  VoxelFileOptions voxels;
  voxels.surface_colours = options.surface_colours;
  const VoxInput input = read_any_voxels(path, options, voxels, {});
  Json info;
  info["path"] = path;
  info["kind"] = name_of(InputKind::voxels);
  info["format"] = options.volume.empty() ? input.format : "volume";
  if (input.document) {
    naming(path, [&] { describe_document(*input.document, options, info); });
  } else {
    info["models"] = Json::array();
    for (const auto& model : input.voxels.models) {
      const VoxelGrid& grid = model->grid();
      info["models"].push_back(
          {{"size", {grid.size().x, grid.size().y, grid.size().z}}, {"voxels", grid.solid_count()}});
    }
  }
  const SceneFieldPtr field = scene_voxels(input.voxels);
  info["bytes"] = field->bytes();
  info["parts"] = Json::array();
  for (const VoxelPlace& place : input.voxels.places) info["parts"].push_back(part_of(input.voxels, place));
  const WorldBox box = *field->extent();
  // Coordinates of files with their own transform have decimals.
  const bool metres = is_vdb_path(path);
  const auto corner = [&](const dvec3& p) {
    return metres ? Json{p.x, p.y, p.z} : Json{std::llround(p.x), std::llround(p.y), std::llround(p.z)};
  };
  info["low"] = box.empty() ? Json() : corner(box.low);
  info["high"] = box.empty() ? Json() : corner(box.high);
  info["notes"] = input.notes;
  return info;
}

std::string vox_text_of(const Json& info) {
  std::string out;
  const WriteLine line = [&](std::string_view name, const std::string& value) {
    const std::size_t begin = out.size();
    out += fmt::format("{:<12} {}\n", name, value);
    // Names in the file may contain terminal control codes.
    std::replace_if(
        out.begin() + static_cast<std::ptrdiff_t>(begin), out.end() - 1,
        [](unsigned char c) { return c < ' ' || c == 0x7f; }, '.');
  };
  const auto count = [&](const char* name) { return info[name].get<std::int64_t>(); };
  line("file", info["path"].get<std::string>());
  const bool document = info.contains("version");
  line("format", info["format"].get<std::string>() + (document ? fmt::format(", version {}", count("version")) : ""));
  std::int64_t voxels = 0;
  for (const Json& model : info["models"]) voxels += model["voxels"].get<std::int64_t>();
  list(line, "models", fmt::format("{}, {} voxels", info["models"].size(), voxels), info["models"],
       [](std::size_t i, const Json& model) {
         return fmt::format("{}: {} x {} x {}, {} voxels", i, model["size"][0].get<int>(), model["size"][1].get<int>(),
                            model["size"][2].get<int>(), model["voxels"].get<std::int64_t>());
       });
  if (document) write_document(line, info);
  line("memory", fmt::format("{} bytes, with all that rays need", count("bytes")));
  if (info["low"].is_null()) {
    line("box", "empty: there is no voxel to see");
  } else {
    const auto at = [&](const char* name, int axis) { return info[name][axis].get<double>(); };
    const auto size = [&](int axis) { return at("high", axis) - at("low", axis); };
    const bool metres = is_vdb_path(info["path"].get<std::string>());
    line("box",
         fmt::format("{:.10g} x {:.10g} x {:.10g} {}, ({:.10g}, {:.10g}, {:.10g}) to ({:.10g}, {:.10g}, {:.10g})",
                     size(0), size(1), size(2), metres ? "m" : "voxels", at("low", 0), at("low", 1), at("low", 2),
                     at("high", 0), at("high", 1), at("high", 2)));
  }
  for (const Json& note : info["notes"]) line("note", note.get<std::string>());
  return out;
}

}  // namespace scarp::cli
