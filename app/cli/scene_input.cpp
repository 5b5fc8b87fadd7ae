// SPDX-License-Identifier: MIT
#include "app/cli/scene_input.h"

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

// For options that need something from the command line or the file.
void require(bool there, const std::vector<std::string>& given, std::initializer_list<std::string_view> names,
             std::string_view what) {
  if (there) return;
  for (const std::string& option : given) {
    if (std::find(names.begin(), names.end(), option) != names.end())
      throw Error(fmt::format("{} has no effect {}", option, what));
  }
}

// Applies the file's settings, unless the option was given.
class Taking {
 public:
  explicit Taking(const std::vector<std::string>& given) : given_(given) {}

  template <class From, class To>
  void operator()(const std::optional<From>& from, const char* option, To& to) const {
    if (from && std::find(given_.begin(), given_.end(), option) == given_.end()) to = *from;
  }

 private:
  const std::vector<std::string>& given_;
};

}  // namespace

bool is_scene_input(const std::vector<std::string>& inputs) {
  const auto scene = std::find_if(inputs.begin(), inputs.end(), is_scene_path);
  if (scene == inputs.end()) return false;
  if (inputs.size() > 1) throw Error(fmt::format("'{}': a scene file stands alone (give no other inputs)", *scene));
  return true;
}

PictureSettings picture_of(const SceneFile& file, PictureSettings settings, const std::vector<std::string>& given) {
  const Taking take(given);
  settings.materials = file.materials;
  if (std::find(given.begin(), given.end(), "--haze") == given.end())
    settings.haze_distance = file.haze_distance.value_or(kUnlimited);
  // Large pixels have their own picture size.
  if (settings.look != Look::comanche) {
    take(file.picture.width, "--size", settings.width);
    take(file.picture.height, "--size", settings.height);
    take(file.picture.aa, "--aa", settings.aa);
    take(file.sun.shadows, "--no-shadows", settings.shadows);
  }
  take(file.picture.samples, "--samples", settings.samples);
  take(file.picture.ao_distance, "--ao-distance", settings.ao_distance);
  take(file.picture.seed, "--seed", settings.seed);
  take(file.sun.azimuth_deg, "--sun", settings.sun.azimuth_deg);
  take(file.sun.altitude_deg, "--sun", settings.sun.altitude_deg);
  take(file.sun.size_deg, "--sun-size", settings.sun.size_deg);
  if (file.sky.kind && std::find(given.begin(), given.end(), "--sky") == given.end())
    settings.sky.kind = find_sky(*file.sky.kind);
  take(file.sky.turbidity, "--sky-turbidity", settings.sky.turbidity);
  require(settings.sky.kind == SkyKind::scattering, given, {"--sky-turbidity"},
          "without --sky scattering, or such a sky in the scene file");
  if (settings.sky.kind == SkyKind::scattering && file.fog && file.fog->sun_tint)
    throw Error("--sky scattering has no effect on the sun_tint of the fog in the scene file (remove the key)");
  require(settings.sky.kind == SkyKind::plain, given, {"--sun-tint"},
          "with a scattering sky, which colours the fog (add --sky plain)");
  require(settings.samples > 0, given, {"--seed", "--sun-size", "--ao-distance"},
          "without --samples N, or samples in the scene file");
  validate(settings);
  return settings;
}

void take_environment(const SceneFile& file, const std::vector<std::string>& given, LookOptions& options) {
  const Taking take(given);
  if (const auto& water = file.water) {
    take(std::optional(water->level), "--water", options.water);
    take(water->srgb, "--water-colour", options.water_settings.srgb);
    take(water->turbidity, "--turbidity", options.water_settings.turbidity);
    take(water->waves, "--waves", options.water_settings.waves);
    take(water->wavelength, "--wavelength", options.water_settings.wavelength);
    take(water->reflection, "--no-reflection", options.water_settings.reflection);
    take(water->refraction, "--no-refraction", options.water_settings.refraction);
  }
  // --fog replaces the fog of the file, whose numbers belong to its kind.
  if (const auto& fog = file.fog; fog && options.fog.empty()) {
    options.fog = fog->kind;
    take(fog->visibility, "--visibility", options.visibility);
    take(fog->base, "--fog-base", options.fog_base);
    take(fog->falloff, "--fog-falloff", options.fog_falloff);
    take(fog->sun_tint, "--sun-tint", options.fog_settings.sun_tint);
  }
  require(options.water.has_value(), given,
          {"--water-colour", "--turbidity", "--waves", "--wavelength", "--no-reflection", "--no-refraction"},
          "without --water M, or water in the scene file");
  const bool foggy = !options.fog.empty() && options.fog != "none";
  require(foggy, given, {"--visibility", "--sun-tint"}, "without --fog KIND, or fog in the scene file");
  require(options.fog == "height", given, {"--fog-base", "--fog-falloff"},
          "without --fog height, or such fog in the scene file");
  require(!foggy, given, {"--haze"}, "with the fog of the scene file, which replaces it (add --fog none)");
}

ViewSettings view_of(const SceneFile& file, ViewSettings view, const std::vector<std::string>& given) {
  const Taking take(given);
  take(file.camera.azimuth_deg, "--view", view.azimuth_deg);
  take(file.camera.elevation_deg, "--view", view.elevation_deg);
  take(file.camera.distance, "--view", view.distance);
  take(file.camera.fov_deg, "--fov", view.fov_deg);
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
