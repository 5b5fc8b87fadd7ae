// SPDX-License-Identifier: MIT
// The sun, the sky, the water and the fog of a scene file. Ranges are in the schema.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scarp/base/error.h"
#include "scarp/scene/file/json_object.h"
#include "scarp/scene/file/scene_parts.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

}  // namespace

SceneSun sun_from_json(const Json& scene) {
  SceneSun sun;
  if (!scene.contains("sun")) return sun;
  const Json& json = scene["sun"];
  take_json(sun.azimuth_deg, json, "azimuth");
  take_json(sun.altitude_deg, json, "altitude");
  take_json(sun.size_deg, json, "size");
  take_json(sun.shadows, json, "shadows");
  return sun;
}

SceneSky sky_from_json(const Json& scene) {
  SceneSky sky;
  if (!scene.contains("sky")) return sky;
  const Json& json = scene["sky"];
  take_json(sky.kind, json, "kind");
  take_json(sky.turbidity, json, "turbidity");
  if (sky.turbidity && *sky.kind != "scattering")
    throw Error("/sky/turbidity: only valid for the sky kind 'scattering'");
  return sky;
}

std::optional<SceneWater> water_from_json(const Json& scene) {
  if (!scene.contains("water")) return {};
  const Json& json = scene["water"];
  SceneWater water{.level = json["level"].get<double>()};
  if (json.contains("colour")) water.srgb = colour_from_json(json["colour"]);
  take_json(water.turbidity, json, "turbidity");
  take_json(water.waves, json, "waves");
  take_json(water.wavelength, json, "wavelength");
  take_json(water.reflection, json, "reflection");
  take_json(water.refraction, json, "refraction");
  return water;
}

std::optional<SceneFog> fog_from_json(const Json& scene) {
  if (!scene.contains("fog")) return {};
  if (scene.contains("haze")) throw Error("/haze: not valid together with fog, which replaces it");
  const Json& json = scene["fog"];
  SceneFog fog{.kind = json["kind"].get<std::string>()};
  for (const char* key : {"base", "falloff"}) {
    if (fog.kind != "height" && json.contains(key))
      throw Error(fmt::format("/fog/{}: only valid for the fog kind 'height'", key));
  }
  if (json.contains("sun_tint") && sky_from_json(scene).kind == "scattering")
    throw Error("/fog/sun_tint: not valid together with a scattering sky, which colours the fog");
  take_json(fog.visibility, json, "visibility");
  take_json(fog.base, json, "base");
  take_json(fog.falloff, json, "falloff");
  take_json(fog.sun_tint, json, "sun_tint");
  return fog;
}

}  // namespace scarp
