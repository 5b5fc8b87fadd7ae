// SPDX-License-Identifier: MIT
// Voxels of a scene file: from one file, or unions, intersections and differences of several.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/scene/file/from_parts.h"
#include "scarp/scene/file/from_vdb.h"
#include "scarp/scene/file/from_volume.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/scene/file/json_object.h"
#include "scarp/scene/file/scene_parts.h"
#include "scarp/scene/file/scene_places.h"
#include "scarp/scene/voxel/combined_voxels.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

VoxelColour voxel_colour(const vec3& srgb) {
  const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
  return {byte(srgb.x), byte(srgb.y), byte(srgb.z)};
}

bool is_binvox(const Json& json) { return extension_of(json["file"].get<std::string>()) == ".binvox"; }

// Keys apply to some formats only. The format follows from the ending, or from `volume`.
void require_keys_of_format(const Json& json, const std::string& path) {
  const auto refuse = [&](std::initializer_list<const char*> keys, const char* why) {
    for (const char* key : keys) {
      if (json.contains(key)) throw Error(fmt::format("{}/{}: {}", path, key, why));
    }
  };
  const bool volume = json.contains("volume");
  if (!volume) refuse({"solid_from"}, "only valid for volumes");
  const bool parts = !volume && is_voxel_parts_path(json["file"].get<std::string>());
  const bool vdb = !volume && is_vdb_path(json["file"].get<std::string>());
  if (volume || parts || vdb || is_binvox(json)) refuse({"frame", "hidden"}, "only valid for MagicaVoxel files");
  if (!volume && !is_binvox(json)) refuse({"colour"}, "only valid for binvox files and volumes");
  if (!volume && !vdb && !is_binvox(json)) refuse({"up"}, "only valid for binvox and OpenVDB files and volumes");
}

PlacedVoxels voxels_of_file(const Json& json, const std::string& file, const VoxelFileOptions& voxels,
                            std::vector<std::string>& notes) {
  const FromVolumeOptions volume{
      voxels, json.value("up", "z") == "y" ? UpAxis::y : UpAxis::z,
      json.contains("solid_from") ? std::optional<double>(json["solid_from"].get<double>()) : std::nullopt};
  const VoxelColour colour = json.contains("colour") ? voxel_colour(colour_from_json(json["colour"])) : kPlainVoxels;
  if (json.contains("volume")) {
    require_marchable(volume_format_of(file, json["volume"]), voxels);
    return placed_voxels_from(read_volume(file, json["volume"]), std::vector{colour}, {}, volume);
  }
  if (is_vdb_path(file)) {
    const VdbVoxels grid = read_vdb(file);
    for (const std::string& note : grid.notes) notes.push_back(fmt::format("{}: {}", file, note));
    return placed_voxels_from(grid, voxels, volume.up);
  }
  if (is_voxel_parts_file(file)) {
    const VoxelParts parts = read_voxel_parts(file);
    for (const std::string& note : parts.notes) notes.push_back(fmt::format("{}: {}", file, note));
    return placed_voxels_from(parts, voxels);
  }
  if (is_binvox(json)) return placed_voxels_from(read_binvox(file), colour, volume);
  const VoxFile document = read_vox(file);
  const VoxSceneOptions scene{json.value("frame", 0), json.value("hidden", false)};
  for (const std::string& note : vox_notes(document, scene)) notes.push_back(fmt::format("{}: {}", file, note));
  return placed_voxels_from(document, {scene, voxels});
}

constexpr std::array<std::pair<const char*, VoxelCombination>, 3> kCombinations = {
    {{"union", VoxelCombination::unite},
     {"intersection", VoxelCombination::intersect},
     {"subtract", VoxelCombination::subtract}}};

struct VoxelsWithPlace {
  PlacedVoxels voxels;
  dvec3 shift{0.0};  // offset of `centred`
};

// Voxels of a file, or of several parts combined.
VoxelsWithPlace placed_voxels_from_json(const Json& json, const std::string& path, const FieldSurroundings& around,
                                        const VoxelFileOptions& options);

// A placed part of a combination. It is never traced, so it gets the march without an accelerator.
PlacedVoxels voxel_part(const Json& json, const std::string& path, const FieldSurroundings& around) {
  VoxelsWithPlace part = placed_voxels_from_json(json, path, around, {.march = "voxel-planes"});
  const Placement placement = placement_from_json(json);
  for (VoxelPlace& place : part.voxels.places) {
    place.world_from_grid = placement.scale * (placement.turn * place.world_from_grid);
    place.origin = placement.world_from_field(place.origin + part.shift);
  }
  return std::move(part.voxels);
}

PlacedVoxels combined_from(const Json& json, const char* name, VoxelCombination combination, const std::string& path,
                           const FieldSurroundings& around, const VoxelFileOptions& options) {
  for (const char* key : {"volume", "solid_from", "up", "colour", "frame", "hidden"}) {
    if (json.contains(key)) throw Error(fmt::format("{}/{}: not valid with {} (set it in the parts)", path, key, name));
  }
  const std::string inner = fmt::format("{}/{}", path, name);
  std::vector<PlacedVoxels> parts;
  for (std::size_t i = 0; i < json[name].size(); ++i)
    parts.push_back(voxel_part(json[name][i], fmt::format("{}/{}", inner, i), around));
  try {
    PlacedVoxels combined = combined_voxels(combination, parts, options);
    if (combined.places.empty()) around.notes->push_back(fmt::format("{}: the result is empty", inner));
    return combined;
  } catch (const Error&) {
    rethrow_at(inner);
  }
}

VoxelsWithPlace placed_voxels_from_json(const Json& json, const std::string& path, const FieldSurroundings& around,
                                        const VoxelFileOptions& options) {
  std::vector<const char*> kinds;
  if (json.contains("file")) kinds.push_back("file");
  for (const auto& [name, combination] : kCombinations) {
    if (json.contains(name)) kinds.push_back(name);
  }
  if (kinds.size() > 1)
    throw Error(
        fmt::format("{}: has both '{}' and '{}' (give one; put the other into its parts)", path, kinds[0], kinds[1]));
  if (kinds.empty()) refuse_json(path, json, "an object with one of file, union, intersection, subtract");
  VoxelsWithPlace placed;
  if (json.contains("file")) {
    require_keys_of_format(json, path);
    try {
      const std::string file = resolved(around, json["file"]);
      placed.voxels = voxels_of_file(json, file, options, *around.notes);
      around.files->push_back(file);
    } catch (const Error&) {
      rethrow_at(path + "/file");
    }
  }
  for (const auto& [name, combination] : kCombinations) {
    if (json.contains(name)) placed.voxels = combined_from(json, name, combination, path, around, options);
  }
  if (json.value("centred", false)) {
    const WorldBox box = world_box(placed.voxels);
    if (!box.empty()) placed.shift = -dvec3(0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y), box.low.z);
  }
  return placed;
}

}  // namespace

FieldWithPlace voxels_from_json(const Json& json, const std::string& path, const FieldSurroundings& around,
                                std::string_view march) {
  VoxelFileOptions options{march, json.value("surface_colours", false), {}};
  options.rounding = {json.value("rounded", 0.0), json.value("each", false)};
  VoxelShading shading;
  const std::string normals = json.value("normals", "flat");
  shading.normals = normals == "smooth"  ? VoxelNormals::smooth
                    : normals == "voxel" ? VoxelNormals::voxel
                                         : VoxelNormals::flat;
  shading.normal_radius = json.value("normal_radius", shading.normal_radius);
  shading.corner_ao = json.value("corner_ao", false);
  VoxelsWithPlace made = placed_voxels_from_json(json, path, around, options);
  try {
    return {scene_voxels(std::move(made.voxels), shading), made.shift};
  } catch (const Error&) {
    rethrow_at(path);
  }
}

}  // namespace scarp
