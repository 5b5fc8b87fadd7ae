// SPDX-License-Identifier: MIT
#include "scarp/scene/file/scene_places.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/field/noise.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr std::int64_t kMostTries = 256;  // per copy that is scattered

glm::dmat3 about(int axis, double angle) {
  glm::dmat3 turn(1.0);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  turn[a][a] = turn[b][b] = std::cos(angle);
  turn[a][b] = std::sin(angle);
  turn[b][a] = -turn[a][b];
  return turn;
}

// Random numbers for one copy, the same on every machine.
class Dice {
 public:
  Dice(std::uint64_t seed, std::int64_t copy) : seed_(octave_seed(seed, 0)), copy_(copy) {}

  /// In [0, 1).
  double next() { return lattice_hash(seed_, copy_, next_++) * 0x1p-32; }
  double between(double low, double high) { return low + (high - low) * next(); }

 private:
  std::uint32_t seed_;
  std::int64_t copy_;
  std::int64_t next_ = 0;
};

// The steepness of ground in degrees, from heights a step apart.
std::optional<double> steepness(const SceneGround& ground, double x, double y, double z) {
  constexpr double kStep = 0.25;
  const auto east = ground.height(x + kStep, y), north = ground.height(x, y + kStep);
  if (!east || !north) return {};
  return std::atan(std::hypot(*east - z, *north - z) / kStep) / kRadiansPerDegree;
}

ScenePlaces scattered(const Json& json, const std::string& path, const SceneGround& ground) {
  const std::int64_t count = json["count"];
  const std::uint64_t seed = json.value("seed", std::uint64_t{1});
  const Json& within = json["within"];
  const auto range = [&](const char* key, double low, double high) {
    if (!json.contains(key)) return dvec2(low, high);
    const dvec2 given(json[key][0], json[key][1]);
    if (!(given.x <= given.y))
      throw Error(fmt::format("{}/{}: is [{}, {}]; expected the low one first", path, key, given.x, given.y));
    return given;
  };
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const dvec2 scale = range("scale", 1, 1), heights = range("heights", -kNoLimit, kNoLimit);
  if (!(scale.x > 0))
    throw Error(fmt::format("{}/scale: is [{}, {}]; expected numbers above 0", path, scale.x, scale.y));
  ScenePlaces places;
  std::int64_t tries = 0;
  for (; static_cast<std::int64_t>(places.size()) < count; ++tries) {
    if (tries == kMostTries * count) {
      throw Error(fmt::format("{}: found room for {} of {} copies; give more room, or fewer conditions", path,
                              places.size(), count));
    }
    Dice dice(seed, tries);
    const double x = dice.between(within[0], within[2]), y = dice.between(within[1], within[3]);
    const std::optional<double> z = ground.height(x, y);
    if (!z || *z < heights.x || *z > heights.y) continue;
    if (json.contains("steepest")) {
      const std::optional<double> steep = steepness(ground, x, y, *z);
      if (!steep || *steep > json["steepest"].get<double>()) continue;
    }
    Placement place;
    place.origin = {x, y, *z};
    place.turn = about(2, dice.between(0, 2 * std::numbers::pi));
    place.scale = dice.between(scale.x, scale.y);
    places.push_back(place);
  }
  return places;
}

}  // namespace

Placement placement_from_json(const Json& json) {
  Placement placement;
  if (json.contains("at")) placement.origin = {json["at"][0], json["at"][1], json["at"][2]};
  if (json.contains("turn")) {
    for (int axis = 0; axis < 3; ++axis)
      placement.turn =
          about(axis, json["turn"][static_cast<std::size_t>(axis)].get<double>() * kRadiansPerDegree) * placement.turn;
  }
  placement.scale = json.value("scale", 1.0);
  return placement;
}

std::optional<double> SceneGround::height(double x, double y) const {
  Ray ray;
  ray.origin = {x, y, placement.origin.z};
  const dvec3 local = placement.field_from_world(ray).origin;
  const std::optional<double> height = field->height(local.x, local.y);
  if (!height) return {};
  return placement.world_from_field({local.x, local.y, *height}).z;
}

double SceneGround::height(double x, double y, const std::string& at) const {
  const std::optional<double> z = height(x, y);
  if (!z) throw Error(fmt::format("{}: '{}' has no ground at ({:g}, {:g})", at, name, x, y));
  return *z;
}

ScenePlaces places_from_json(const Json& object, const std::string& path, const GroundByName& grounds) {
  const Placement own = placement_from_json(object);
  std::optional<SceneGround> ground;
  if (object.contains("on")) {
    ground = grounds(object["on"], path + "/on");
    if (!ground->placement.upright())
      throw Error(
          fmt::format("{}/on: '{}' is tilted; expected ground that is turned about z alone", path, ground->name));
  }
  ScenePlaces places;
  if (object.contains("scatter")) {
    if (object.contains("places")) throw Error(fmt::format("{}/places: does not go with scatter; leave one out", path));
    places = scattered(object["scatter"], path + "/scatter", *ground);
    for (Placement& place : places) place = placed(place, own);
    return places;
  }
  const Json list = object.contains("places") ? object["places"] : Json::array({Json::object()});
  for (std::size_t i = 0; i < list.size(); ++i) {
    Placement place = placed(placement_from_json(list[i]), own);
    const std::string at = object.contains("places") ? fmt::format("{}/places/{}/at", path, i) : path + "/at";
    if (ground) place.origin.z += ground->height(place.origin.x, place.origin.y, at);
    places.push_back(place);
  }
  return places;
}

}  // namespace scarp
