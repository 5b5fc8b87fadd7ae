// SPDX-License-Identifier: MIT
#include "scarp/scene/file/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/scene/file/example_functions.h"
#include "scarp/scene/file/json_object.h"
#include "scarp/scene/file/scene_parts.h"
#include "scarp/scene/file/scene_places.h"
#include "scarp/scene/file/scene_schema.h"

namespace scarp {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kMostObjects = std::size_t{1} << 20;

// Shared by all files of a scene.
struct Whole {
  std::vector<SceneFieldPtr> fields;
  std::vector<Material> materials;
  std::vector<std::string> notes;
  std::vector<std::string> files;       // files already read
  std::vector<std::string> open_files;  // files being read, each included by the previous one
  Progress progress;
};

// Reads one file. Objects of other files that it names are converted to its own space first.
class SceneReader {
 public:
  SceneReader(const std::string& path, Whole& whole) : path_(path), whole_(whole) {
    json_ = parse_scene_text(json_text_of(path, "a scene"));
    whole_.files.push_back(path);
    check_scene_schema(json_);
    around_.folder = fs::path(path).parent_path().string();
    around_.functions = [this](const std::string& name, std::string_view at) { return function_of(name, at); };
    around_.material = [this](const std::string& name, const std::string& at) {
      return static_cast<int>(material_named(name, at)) + 1;
    };
    around_.field = [this](const std::string& name, const std::string& at) { return field_named(name, at); };
    around_.notes = &whole_.notes;
    around_.files = &whole_.files;
    around_.progress = whole_.progress;
  }

  void read() {
    if (json_.contains("materials"))
      materials_ = materials_from_json(json_["materials"], "/materials", whole_.materials);
    const Json& list = json_["objects"];
    for (std::size_t i = 0; i < list.size(); ++i) read_object(list[i], fmt::format("/objects/{}", i));
  }

  const Json& json() const { return json_; }
  std::vector<SceneObject>& objects() { return objects_; }
  std::vector<SceneObjectName>& names() { return names_; }
  SceneCamera camera() const;

 private:
  Function function_of(const std::string& name, std::string_view at) {
    if (!json_.contains("functions") || !json_["functions"].contains(name)) {
      try {
        return example_function(name);
      } catch (const Error&) {
        rethrow_at(std::string(at));
      }
    }
    if (!open_functions_.insert(name).second)
      throw Error(fmt::format("{}: the function '{}' contains itself; let it use others", at, name));
    Function function = function_from_json(json_["functions"][name], "/functions/" + name, around_.functions);
    open_functions_.erase(name);
    return function;
  }

  // Returns the index of the object's field, which is referred to by name or defined in the object.
  std::pair<std::uint32_t, dvec3> field_of(const Json& object, const std::string& path) {
    if (!object.contains("field")) return add_field(object, path);
    for (const char* key : {"march", "settings", "heights", "function", "shape", "voxels", "mesh", "scene"}) {
      if (object.contains(key))
        throw Error(fmt::format("{}/{}: does not go with field; give it in /fields", path, key));
    }
    const std::string name = object["field"];
    if (const auto known = named_fields_.find(name); known != named_fields_.end()) return known->second;
    const auto [json, at] = field_named(name, path + "/field");
    return named_fields_[name] = add_field(*json, at);
  }
  std::pair<const Json*, std::string> field_named(const std::string& name, const std::string& at) const {
    if (!json_.contains("fields") || !json_["fields"].contains(name))
      throw Error(fmt::format("{}: there is no field '{}'; fields stand in /fields, by name", at, name));
    return {&json_["fields"][name], "/fields/" + name};
  }
  std::pair<std::uint32_t, dvec3> add_field(const Json& json, const std::string& path) {
    FieldWithPlace made = field_from_json(json, path, around_);
    whole_.fields.push_back(std::move(made.field));
    return {static_cast<std::uint32_t>(whole_.fields.size() - 1), made.shift};
  }

  // The objects of another file, in its space.
  std::vector<SceneObject> objects_of(const std::string& file, const std::string& path) {
    const std::string inner = (fs::path(around_.folder) / file).lexically_normal().string();
    std::error_code none;
    const std::string canonical = fs::weakly_canonical(inner, none).string();
    const auto& open = whole_.open_files;
    if (std::find(open.begin(), open.end(), canonical) != open.end())
      throw Error(fmt::format("{}/scene: '{}' is the file itself, or contains it; a scene cannot", path, file));
    whole_.open_files.push_back(canonical);
    try {
      SceneReader reader(inner, whole_);
      reader.read();
      whole_.open_files.pop_back();
      return std::move(reader.objects());
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      throw Error(fmt::format("{}/scene: {}: {}", path, inner, error.what()));
    }
  }

  void read_object(const Json& json, const std::string& path) {
    std::vector<SceneObject> parts;
    if (json.contains("scene")) {
      for (const char* key :
           {"march", "settings", "heights", "function", "shape", "voxels", "mesh", "field", "material"}) {
        if (json.contains(key)) throw Error(fmt::format("{}/{}: does not go with scene, which has its own", path, key));
      }
      parts = objects_of(json["scene"], path);
    } else {
      const auto [field, shift] = field_of(json, path);
      parts.push_back({field, material_of(json, path), {.origin = shift}});
    }
    const ScenePlaces places = places_from_json(
        json, path, [&](const std::string& name, const std::string& at) { return ground_of(name, at); });
    const auto first = static_cast<std::uint32_t>(objects_.size());
    if (parts.size() * places.size() > kMostObjects - first)
      throw Error(fmt::format("{}: more than {} objects; place fewer", path, kMostObjects));
    for (const Placement& place : places) {
      for (const SceneObject& part : parts)
        objects_.push_back({part.field, part.material, placed(place, part.placement)});
    }
    std::string name = json.contains("name") ? json["name"].get<std::string>() : path;
    for (const SceneObjectName& other : names_) {
      if (other.name == name) throw Error(fmt::format("{}/name: '{}' is taken; give another name", path, name));
    }
    names_.push_back({std::move(name), first, static_cast<std::uint32_t>(objects_.size()) - first});
  }

  std::uint32_t material_of(const Json& json, const std::string& path) const {
    if (!json.contains("material")) return static_cast<std::uint32_t>(-1);
    return material_named(json["material"], path + "/material");
  }
  std::uint32_t material_named(const std::string& name, const std::string& at) const {
    const auto found = materials_.find(name);
    if (found == materials_.end())
      throw Error(fmt::format("{}: there is no material '{}'; materials stand in /materials, by name", at, name));
    return found->second;
  }

  // An object on whose surface others are placed.
  SceneGround ground_of(const std::string& name, const std::string& at) const {
    for (const SceneObjectName& known : names_) {
      if (known.name != name) continue;
      if (known.count == 1) {
        const SceneObject& object = objects_[known.first];
        return {whole_.fields[object.field].get(), object.placement, name};
      }
      throw Error(fmt::format("{}: '{}' is {} objects; expected a single one", at, name, known.count));
    }
    throw Error(fmt::format("{}: there is no object '{}' before it", at, name));
  }

  std::string path_;
  Whole& whole_;
  Json json_;
  FieldSurroundings around_;
  std::map<std::string, std::uint32_t> materials_;
  std::map<std::string, std::pair<std::uint32_t, dvec3>> named_fields_;
  std::set<std::string> open_functions_;
  std::vector<SceneObject> objects_;
  std::vector<SceneObjectName> names_;
};

dvec3 point(const Json& json) { return {json[0], json[1], json[2]}; }

SceneCamera SceneReader::camera() const {
  SceneCamera camera;
  if (!json_.contains("camera")) return camera;
  const Json& json = json_["camera"];
  if (json.contains("eye")) {
    for (const char* key : {"azimuth", "elevation", "distance"}) {
      if (json.contains(key)) throw Error(fmt::format("/camera/{}: not valid together with eye and target", key));
    }
    camera.eye = point(json["eye"]);
    camera.target = point(json["target"]);
    if (json.contains("on")) {
      const SceneGround ground = ground_of(json["on"], "/camera/on");
      camera.eye->z += ground.height(camera.eye->x, camera.eye->y, "/camera/eye");
      camera.target->z += ground.height(camera.target->x, camera.target->y, "/camera/target");
    }
    if (*camera.eye == *camera.target) throw Error("/camera/target: is where the eye is; expected another point");
  }
  take_json(camera.azimuth_deg, json, "azimuth");
  take_json(camera.elevation_deg, json, "elevation");
  take_json(camera.distance, json, "distance");
  take_json(camera.fov_deg, json, "fov");
  return camera;
}

ScenePicture picture_from(const Json& scene) {
  ScenePicture picture;
  if (!scene.contains("picture")) return picture;
  const Json& json = scene["picture"];
  if (json.contains("size")) {
    picture.width = json["size"][0].get<int>();
    picture.height = json["size"][1].get<int>();
  }
  take_json(picture.aa, json, "aa");
  take_json(picture.samples, json, "samples");
  take_json(picture.ao_distance, json, "ao_distance");
  take_json(picture.seed, json, "seed");
  picture.coarse_voxels = json.value("coarse_voxels", false);
  return picture;
}

SceneFile read_whole(const std::string& path, const Progress& progress) {
  Whole whole;
  whole.progress = progress;
  std::error_code none;
  whole.open_files.push_back(fs::weakly_canonical(path, none).string());
  SceneReader reader(path, whole);
  reader.read();
  const Json& json = reader.json();
  const SceneCamera camera = reader.camera();
  SceneFile file{Scene(std::move(whole.fields), std::move(reader.objects())),
                 {},
                 std::move(reader.names()),
                 camera,
                 sun_from_json(json),
                 sky_from_json(json),
                 picture_from(json),
                 {},
                 water_from_json(json),
                 fog_from_json(json),
                 std::move(whole.notes),
                 std::move(whole.files)};
  if (!file.scene.endless() && file.scene.box().empty())
    throw Error(
        fmt::format("/objects: nothing to see in any of them: no solid voxel and no cell of heights{} (see 'scarp "
                    "info' for each file)",
                    file.files.empty() ? "" : fmt::format(" in {}", fmt::join(file.files, ", "))));
  file.materials = std::move(whole.materials);
  if (json.contains("haze")) file.haze_distance = json["haze"]["distance"].get<double>();
  return file;
}

}  // namespace

SceneFile read_scene(const std::string& path, const Progress& progress) {
  try {
    return read_whole(path, progress);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
