// SPDX-License-Identifier: MIT
#include "app/cli/options/scene_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

bool is_scene_path(const std::string& path) { return extension_of(path) == ".json"; }

// For options that need another one on the command line or in the file.
struct Asked {
  std::string_view option;
  bool given;
};
void require(bool there, std::initializer_list<Asked> options, std::string_view what) {
  if (there) return;
  for (const Asked& one : options) {
    if (one.given) throw Error(fmt::format("{} has no effect {}", one.option, what));
  }
}

}  // namespace

bool is_scene_input(const std::vector<std::string>& inputs) {
  const auto scene = std::find_if(inputs.begin(), inputs.end(), is_scene_path);
  if (scene == inputs.end()) return false;
  if (inputs.size() > 1) throw Error(fmt::format("'{}': a scene file stands alone (give no other inputs)", *scene));
  return true;
}

PictureRequest request_of(const SceneFile& file) {
  PictureRequest r;
  r.materials = file.materials;
  r.haze = 0, r.haze_distance = file.haze_distance;
  r.width = file.picture.width, r.height = file.picture.height, r.aa = file.picture.aa;
  r.samples = file.picture.samples, r.ao_distance = file.picture.ao_distance, r.seed = file.picture.seed;
  r.shadows = file.sun.shadows;
  r.sun_azimuth_deg = file.sun.azimuth_deg, r.sun_altitude_deg = file.sun.altitude_deg;
  r.sun_size_deg = file.sun.size_deg;
  if (file.sky.kind) r.sky = find_sky(*file.sky.kind);
  r.sky_turbidity = file.sky.turbidity;
  if (const auto& water = file.water) {
    r.water_level = water->level, r.water_srgb = water->srgb, r.water_turbidity = water->turbidity;
    r.waves = water->waves, r.wavelength = water->wavelength;
    r.reflection = water->reflection, r.refraction = water->refraction;
  }
  if (const auto& fog = file.fog) {
    r.fog = find_fog(fog->kind), r.visibility = fog->visibility;
    r.fog_base = fog->base, r.fog_falloff = fog->falloff, r.sun_tint = fog->sun_tint;
  }
  return r;
}

void check_effect(const PictureRequest& asked, const PictureRequest& own) {
  const PictureRequest all = merged(asked, own);
  require(all.water_level.has_value(),
          {{"--water-colour", asked.water_srgb.has_value()},
           {"--turbidity", asked.water_turbidity.has_value()},
           {"--waves", asked.waves.has_value()},
           {"--wavelength", asked.wavelength.has_value()},
           {"--no-reflection", asked.reflection.has_value()},
           {"--no-refraction", asked.refraction.has_value()}},
          "without --water M, or water in the scene file");
  const FogKind fog = all.fog.value_or(FogKind::none);
  require(fog != FogKind::none,
          {{"--visibility", asked.visibility.has_value()}, {"--sun-tint", asked.sun_tint.has_value()}},
          "without --fog KIND, or fog in the scene file");
  require(fog == FogKind::height,
          {{"--fog-base", asked.fog_base.has_value()}, {"--fog-falloff", asked.fog_falloff.has_value()}},
          "without --fog height, or such fog in the scene file");
  require(fog == FogKind::none, {{"--haze", asked.haze.has_value()}},
          "with the fog of the scene file, which replaces it (add --fog none)");
  const bool scatters = all.sky == SkyKind::scattering;
  require(scatters, {{"--sky-turbidity", asked.sky_turbidity.has_value()}},
          "without --sky scattering, or such a sky in the scene file");
  if (scatters && own.sun_tint)
    throw Error("--sky scattering has no effect on the sun_tint of the fog in the scene file (remove the key)");
  require(!scatters, {{"--sun-tint", asked.sun_tint.has_value()}},
          "with a scattering sky, which colours the fog (add --sky plain)");
  require(all.samples.value_or(0) > 0,
          {{"--seed", asked.seed.has_value()},
           {"--sun-size", asked.sun_size_deg.has_value()},
           {"--ao-distance", asked.ao_distance.has_value()}},
          "without --samples N, or samples in the scene file");
}

ViewSettings view_of(const SceneCamera& own, const CameraOptions& camera, Look look) {
  ViewSettings view = view_of(camera, look);
  if (!camera.view) {
    view.azimuth_deg = own.azimuth_deg.value_or(view.azimuth_deg);
    view.elevation_deg = own.elevation_deg.value_or(view.elevation_deg);
    view.distance = own.distance.value_or(view.distance);
  }
  if (!camera.fov_deg) view.fov_deg = own.fov_deg.value_or(view.fov_deg);
  return view;
}

namespace {

// The elements that SceneField::elements() counts.
std::string_view elements_of(std::string_view kind) {
  return kind == "voxels" ? "voxels" : kind == "mesh" ? "triangles" : "samples";
}

}  // namespace

Json describe_scene(const std::string& path) {
  const SceneFile file = read_scene(path, terminal_progress("read"));
  Json info;
  info["path"] = path;
  info["kind"] = name_of(InputKind::scene);
  info["format"] = "Scarp scene";
  info["objects"] = Json::array();
  for (const SceneObjectName& name : file.names) {
    struct Counts {
      std::size_t fields = 0;
      std::int64_t elements = 0;
    };
    std::map<std::pair<std::string, std::string>, Counts> kinds;
    for (std::uint32_t i = name.first; i < name.first + name.count; ++i) {
      const SceneField& field = *file.scene.fields()[file.scene.objects()[i].field];
      Counts& counts = kinds[{std::string(field.kind()), std::string(field.march())}];
      ++counts.fields;
      counts.elements += field.elements();
    }
    Json object{{"name", name.name}, {"first", name.first}, {"count", name.count}, {"fields", Json::array()}};
    for (const auto& [kind, counts] : kinds) {
      object["fields"].push_back({{"kind", kind.first}, {"march", kind.second}, {"count", counts.fields}});
      if (counts.elements > 0) object["fields"].back()[std::string(elements_of(kind.first))] = counts.elements;
    }
    info["objects"].push_back(std::move(object));
  }
  info["placed"] = file.scene.objects().size();
  info["fields"] = file.scene.fields().size();
  info["materials"] = file.materials.size();
  info["endless"] = file.scene.endless();
  const WorldBox& box = file.scene.box();
  info["low_m"] = box.empty() ? Json() : Json{box.low.x, box.low.y, box.low.z};
  info["high_m"] = box.empty() ? Json() : Json{box.high.x, box.high.y, box.high.z};
  info["hierarchy_bytes"] = file.scene.bytes();
  info["notes"] = file.notes;
  return info;
}

std::string scene_text_of(const Json& info) {
  std::string out;
  const auto line = [&](std::string_view name, const std::string& value) {
    out += fmt::format("{:<12} {}\n", name, value);
  };
  line("file", info["path"].get<std::string>());
  line("format", info["format"].get<std::string>());
  line("objects", fmt::format("{}, placed {} times; {} fields, {} materials", info["objects"].size(),
                              info["placed"].get<std::size_t>(), info["fields"].get<std::size_t>(),
                              info["materials"].get<std::size_t>()));
  for (const Json& object : info["objects"]) {
    std::string what;
    for (const Json& field : object["fields"]) {
      const std::string kind = field["kind"].get<std::string>(), elements(elements_of(kind));
      what += fmt::format("{}{} x {} by {}", what.empty() ? "" : ", ", field["count"].get<std::size_t>(), kind,
                          field["march"].get<std::string>());
      if (field.contains(elements)) what += fmt::format(", {} {}", field[elements].get<std::int64_t>(), elements);
    }
    line("", fmt::format("{} {}: {}", object["first"].get<std::uint32_t>(), object["name"].get<std::string>(), what));
  }
  const auto corner = [&](const char* key) {
    const Json& p = info[key];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  };
  const std::string endless = info["endless"].get<bool>() ? "; beside it objects without an end" : "";
  line("box", info["low_m"].is_null() ? "none: all objects are without an end"
                                      : fmt::format("{} to {} m{}", corner("low_m"), corner("high_m"), endless));
  line("memory", fmt::format("{} bytes for objects and hierarchy", info["hierarchy_bytes"].get<std::size_t>()));
  for (const Json& note : info["notes"]) line("note", note.get<std::string>());
  return out;
}

}  // namespace scarp::cli
