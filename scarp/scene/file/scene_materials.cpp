// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "scarp/base/error.h"
#include "scarp/scene/file/scene_parts.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

class MaterialReader {
 public:
  MaterialReader(const Json& json, std::string path, std::vector<Material>& all)
      : json_(json), path_(std::move(path)), all_(all) {}

  std::map<std::string, std::uint32_t> read() {
    for (const auto& [name, material] : json_.items()) index_of(name, path_ + "/" + name);
    return std::move(indices_);
  }

 private:
  std::uint32_t index_of(const std::string& name, const std::string& asked_at) {
    if (const auto known = indices_.find(name); known != indices_.end()) return known->second;
    if (!json_.contains(name)) throw Error(fmt::format("{}: there is no material '{}'", asked_at, name));
    if (!open_.insert(name).second)
      throw Error(fmt::format("{}: the material '{}' contains itself; let it blend others", asked_at, name));
    Material material = material_from(json_[name], path_ + "/" + name);
    open_.erase(name);
    all_.push_back(std::move(material));
    return indices_[name] = static_cast<std::uint32_t>(all_.size() - 1);
  }

  Material material_from(const Json& json, const std::string& path) {
    if (json.contains("colour")) return PlainColour{colour_from_json(json["colour"])};
    if (json.contains("ramp")) {
      const Json& ramp = json["ramp"];
      const HeightRamp made{ramp["name"], ramp["heights"][0], ramp["heights"][1]};
      if (made.low > made.high)
        throw Error(fmt::format("{}/ramp/heights: is [{}, {}]; expected the low one first", path, made.low, made.high));
      return made;
    }
    if (json.contains("stops")) {
      HeightStops stops;
      for (const Json& stop : json["stops"]) {
        if (!stops.stops.empty() && !(stop["z"] > stops.stops.back().first)) {
          throw Error(fmt::format("{}/stops/{}/z: is {}; expected more than that before it", path, stops.stops.size(),
                                  stop["z"].get<double>()));
        }
        stops.stops.emplace_back(stop["z"].get<double>(), colour_from_json(stop["colour"]));
      }
      return stops;
    }
    if (json.contains("checker")) {
      const Json& checker = json["checker"];
      return Checker{colour_from_json(checker["colours"][0]), colour_from_json(checker["colours"][1]),
                     checker.value("size", 1.0)};
    }
    const Json& blend = json["blend"];
    Blend made{blend["by"] == "slope" ? Blend::By::slope : Blend::By::height, blend["from"], blend["to"]};
    if (made.from > made.to)
      throw Error(fmt::format("{}/blend/to: is {}; expected {} or more, as from", path, made.to, made.from));
    made.low = index_of(blend["low"], path + "/blend/low");
    made.high = index_of(blend["high"], path + "/blend/high");
    return made;
  }

  const Json& json_;
  std::string path_;
  std::vector<Material>& all_;
  std::map<std::string, std::uint32_t> indices_;
  std::set<std::string> open_;  // being read
};

}  // namespace

vec3 colour_from_json(const Json& json) {
  const auto rgb = std::stoul(json.get<std::string>().substr(1), nullptr, 16);
  return vec3(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255) / 255.0f;
}

std::map<std::string, std::uint32_t> materials_from_json(const Json& json, const std::string& path,
                                                         std::vector<Material>& all) {
  return MaterialReader(json, path, all).read();
}

}  // namespace scarp
