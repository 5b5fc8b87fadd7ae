// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "scarp/accel/solid_ground.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/scene/file/json_object.h"
#include "scarp/scene/file/scene_parts.h"
#include "scarp/scene/file/shape_json.h"
#include "scarp/source/mesh/mesh_file.h"
#include "scarp/source/raster/procedural_dem.h"
#include "scarp/source/raster/read_raster.h"
#ifdef SCARP_EMBREE
#include "scarp/scene/mesh/scene_mesh.h"
#endif

namespace scarp {
namespace {

using Json = nlohmann::json;

template <class T>
std::optional<T> optional(const Json& json, const char* key) {
  return json.contains(key) ? std::optional<T>(json[key].get<T>()) : std::nullopt;
}

RasterOptions raster_options_from(const Json& json, const std::string& path) {
  RasterOptions options;
  options.band = json.value("band", 0);
  options.key = json.value("key", "");
  options.channel = json.value("channel", "");
  options.unit = json.value("unit", "");
  options.crs = json.value("crs", "");
  options.nodata = optional<double>(json, "nodata");
  options.scale = optional<double>(json, "factor");
  options.offset = optional<double>(json, "offset");
  if (json.contains("window")) {
    const Json& w = json["window"];
    options.window = RasterWindow{w[0], w[1], w[2], w[3]};
  }
  if (json.contains("bounds")) {
    const Json& b = json["bounds"];
    options.bounds = MapBounds{b[0], b[1], b[2], b[3]};
  }
  if (json.contains("height_range"))
    options.height_range = HeightRange{json["height_range"][0], json["height_range"][1]};
  if (json.contains("encoding")) options.encoding = *height_encoding(json["encoding"].get<std::string>());
  try {
    if (json.contains("raw")) options.raw = parse_raw_format(json["raw"].get<std::string>());
  } catch (const Error&) {
    rethrow_at(path + "/raw");
  }
  return options;
}

Raster generated(const Json& json) {
  ProceduralDem dem;
  dem.kind = *terrain_kind(json.value("kind", "fbm"));
  dem.seed = json.value("seed", dem.seed);
  if (json.contains("size")) dem.cols = json["size"][0], dem.rows = json["size"][1];
  dem.cell_m = json.value("cell", dem.cell_m);
  dem.feature_size = json.value("feature_size", dem.feature_size);
  Raster raster;
  raster.samples = generate_dem(dem);
  raster.cols = dem.cols, raster.rows = dem.rows;
  raster.georeference.cell_x_m = raster.georeference.cell_y_m = dem.cell_m;
  raster.path = "generated";
  return raster;
}

struct HeightsWithPlace {
  HeightField field;
  dvec3 shift;
};

HeightsWithPlace heights_from(const Json& json, const std::string& path, const FieldSurroundings& around) {
  const int sources = json.contains("file") + json.contains("files") + json.contains("generate");
  if (sources != 1) refuse_json(path, json, "an object with one of file, files, generate");
  const RasterOptions options = raster_options_from(json, path);
  const std::string source = json.contains("generate") ? "generate" : json.contains("file") ? "file" : "files";
  try {
    Raster raster;
    if (source == "generate") {
      raster = generated(json["generate"]);
    } else {
      std::vector<std::string> inputs;
      for (const Json& file : source == "file" ? Json::array({json["file"]}) : json["files"])
        inputs.push_back(resolved(around, file));
      raster = read_tiles(inputs, options, around.progress);
    }
    for (const std::string& note : raster.notes) around.notes->push_back(note);
    for (const std::string& file : raster.files) around.files->push_back(file);
    FieldOptions field_options;
    field_options.exaggeration = json.value("exaggeration", 1.0);
    field_options.surface = json.value("surface", "bilinear") == "triangles" ? Surface::triangles : Surface::bilinear;
    field_options.solid = json.value("solid", false);
    HeightField field = height_field_from(std::move(raster), field_options);
    const dvec3 shift =
        json.value("centred", false) ? dvec3(-0.5 * field.width(), -0.5 * field.depth(), 0) : dvec3(0.0);
    return {std::move(field), shift};
  } catch (const Error&) {
    rethrow_at(path + "/" + source);
  }
}

// The ground that a shape is cut out of: a field's name, or an object with heights or a function.
Shape ground_from(const Json& json, const std::string& path, const FieldSurroundings& around) {
  if (json.is_string()) {
    const auto [named, at] = around.field(json.get<std::string>(), path);
    if (!named->is_object() || !(named->contains("heights") || named->contains("function")))
      throw Error(fmt::format("{}: '{}' is no ground; expected a field of heights or a function", path,
                              json.get<std::string>()));
    return ground_from(*named, at, around);
  }
  if (json.is_object() && json.size() >= 1 && json.contains("heights")) {
    HeightsWithPlace made = heights_from(json["heights"], path + "/heights", around);
    const Shape ground = [&] {
      try {
        return make_shape(solid_ground(std::make_shared<HeightField>(std::move(made.field))));
      } catch (const Error&) {
        rethrow_at(path + "/heights");
      }
    }();
    return made.shift == dvec3(0.0) ? ground : make_shape(shape::Moved{ground, made.shift});
  }
  if (json.is_object() && json.contains("function")) {
    Function function = function_from_json(json["function"], path + "/function", around.functions);
    return make_shape(shape::FunctionGround{std::make_shared<const HeightFunction>(std::move(function))});
  }
  refuse_json(path, json, "the name of a field, or an object with heights or a function");
}

#ifdef SCARP_EMBREE

FieldWithPlace mesh_from(const Json& json, const std::string& path, const FieldSurroundings& around) {
  try {
    const std::string file = resolved(around, json["file"]);
    const TriangleMesh mesh = read_mesh(file, json.value("up", "y") == "z" ? MeshUp::z : MeshUp::y);
    around.files->push_back(file);
    around.notes->insert(around.notes->end(), mesh.notes.begin(), mesh.notes.end());
    return {scene_mesh(mesh), json.value("centred", false) ? mesh_placement(mesh, {}).origin : dvec3(0.0)};
  } catch (const Error&) {
    rethrow_at(path + "/file");
  }
}

#else

FieldWithPlace mesh_from(const Json&, const std::string& path, const FieldSurroundings&) {
  throw Error(fmt::format("{}: this scarp was built without Embree, which traces meshes (SCARP_EMBREE=OFF)", path));
}

#endif

}  // namespace

std::string resolved(const FieldSurroundings& around, const Json& file) {
  return (std::filesystem::path(around.folder) / file.get<std::string>()).lexically_normal().string();
}

void rethrow_at(const std::string& path) {
  try {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

MarchSettings march_settings_from_json(const Json& json, const std::string& path) {
  MarchSettings s;
  JsonObject object(json, path);
  const auto number = [&](const char* key, double& value) { value = object.number(key, value); };
  const auto count = [&](const char* key, int& value) {
    value = static_cast<int>(object.whole(key, value, 1, std::numeric_limits<int>::max()));
  };
  number("naive_step_factor", s.naive.step_factor);
  number("naive_min_step", s.naive.min_step);
  number("naive_tolerance", s.naive.tolerance);
  count("naive_max_steps", s.naive.max_steps);
  number("fixed_step", s.fixed_step.step);
  if (const Json* interpolate = object.find("fixed_step_interpolate")) {
    if (!interpolate->is_boolean())
      refuse_json(object.path_of("fixed_step_interpolate"), *interpolate, "true or false");
    s.fixed_step.interpolate = interpolate->get<bool>();
  }
  count("fixed_step_max_steps", s.fixed_step.max_steps);
  number("relaxed_step_factor", s.relaxed.step_factor);
  number("relaxed_tolerance", s.relaxed.tolerance);
  count("relaxed_max_steps", s.relaxed.max_steps);
  number("shrink", s.lipschitz.shrink);
  number("lipschitz_tolerance", s.lipschitz.tolerance);
  count("lipschitz_max_steps", s.lipschitz.max_steps);
  count("bisect_halvings", s.bisect.halvings);
  number("local_tolerance", s.lipschitz_local.tolerance);
  count("local_max_steps", s.lipschitz_local.max_steps);
  number("trace_tolerance", s.sphere_trace.tolerance);
  count("trace_max_steps", s.sphere_trace.max_steps);
  number("function_reach", s.function.reach);
  number("function_step", s.function.step);
  number("function_step_share", s.function.step_share);
  number("function_tolerance", s.sampling.tolerance);
  if (object.find("refine")) s.sampling.refinement = find_refinement(object.text("refine"));
  count("refine_halvings", s.sampling.halvings);
  object.finish();
  try {
    validate(s);
  } catch (const Error&) {
    rethrow_at(path);
  }
  return s;
}

FieldWithPlace field_from_json(const Json& json, const std::string& path, const FieldSurroundings& around) {
  constexpr std::array<const char*, 5> kKinds = {"heights", "function", "shape", "voxels", "mesh"};
  const char* kind = nullptr;
  for (const char* name : kKinds) {
    if (!json.contains(name)) continue;
    if (kind)
      throw Error(fmt::format("{}: has {} and {}; expected one of {}", path, kind, name, fmt::join(kKinds, ", ")));
    kind = name;
  }
  if (!kind) refuse_json(path, json, fmt::format("an object with one of {}", fmt::join(kKinds, ", ")));
  const MarchSettings settings =
      json.contains("settings") ? march_settings_from_json(json["settings"], path + "/settings") : MarchSettings{};
  // The march of the field, or the default of its kind.
  const auto march = [&](const auto& find, const char* usual) -> const auto& {
    try {
      return find(json.value("march", usual));
    } catch (const Error&) {
      rethrow_at(path + "/march");
    }
  };
  const std::string inner = path + "/" + kind;
  const Json& field = json[kind];
  if (kind == kKinds[0]) {
    const HeightMarchEntry& by = march(find_height_march, "max-mip");
    HeightsWithPlace made = heights_from(field, inner, around);
    return {scene_heights(std::move(made.field), by, settings), made.shift};
  }
  if (kind == kKinds[1]) {
    const FunctionMarchEntry& by = march(find_function_march, "lipschitz-local");
    return {scene_function(HeightFunction(function_from_json(field, inner, around.functions)), by, settings)};
  }
  if (kind == kKinds[2]) {
    const ShapeMarchEntry& by = march(find_shape_march, "sphere-trace");
    const ShapeNames names{around.material, [&](const Json& ground, const std::string& at) {
                             try {
                               return ground_from(ground, at, around);
                             } catch (const Error& error) {
                               // Most have a position already.
                               if (*error.what() == '/') throw;
                               rethrow_at(at);
                             }
                           }};
    return {scene_shape(distance_field_from_json(field, inner, names), by, settings)};
  }
  if (kind == kKinds[3])
    return voxels_from_json(field, inner, around, json.contains("march") ? march(find_voxel_march, "").name : "");
  for (const char* key : {"march", "settings"}) {
    if (json.contains(key)) throw Error(fmt::format("{}/{}: does not go with mesh, which Embree traces", path, key));
  }
  return mesh_from(field, inner, around);
}

}  // namespace scarp
