// SPDX-License-Identifier: MIT
#include "scarp/scene/file/shape_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

// Describes a value: numbers literally, others by their kind.
std::string told(const Json& json) {
  constexpr std::size_t kMost = 40;
  if (json.is_object()) return "an object";
  if (json.is_array()) return fmt::format("a list of {}", json.size());
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

[[noreturn]] void refuse(const std::string& path, std::string_view expected, const Json& got) {
  throw Error(fmt::format("{}: expected {}, got {}", path.empty() ? "/" : path, expected, told(got)));
}

// Appends a key to a JSON pointer (RFC 6901).
std::string within(const std::string& path, std::string_view key) {
  std::string out = path + '/';
  for (const char c : key) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
}
std::string within(const std::string& path, std::size_t index) { return fmt::format("{}/{}", path, index); }

// The keys of an object, each requested by name; keys that were not requested are errors.
class Settings {
 public:
  Settings(const Json& json, std::string path, std::span<const std::string_view> known)
      : json_(json), path_(std::move(path)) {
    if (!json.is_object()) refuse(path_, "an object", json);
    std::string names;
    for (const std::string_view name : known) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
    for (const auto& [key, value] : json.items()) {
      bool is_known = false;
      for (const std::string_view name : known) is_known = is_known || key == name;
      if (!is_known) throw Error(fmt::format("{}: unknown key (available: {})", within(path_, key), names));
    }
  }

  bool has(std::string_view key) const { return json_.contains(key); }
  std::string path(std::string_view key) const { return within(path_, key); }
  const Json& at(std::string_view key) const {
    if (!has(key)) throw Error(fmt::format("{}: is missing", path(key)));
    return json_.at(std::string(key));
  }

  double number(std::string_view key, double otherwise) const {
    return has(key) ? number(at(key), path(key)) : otherwise;
  }
  double number(std::string_view key) const { return number(at(key), path(key)); }
  /// Above 0.
  double length(std::string_view key) const { return length(at(key), path(key)); }
  /// 0 or more.
  double radius(std::string_view key, double otherwise) const {
    if (!has(key)) return otherwise;
    const double value = number(key);
    if (!(value == 0 || (value >= kLeastLength && value <= kMostLength)))
      refuse(path(key), "0 or more, up to 2^30", at(key));
    return value;
  }
  dvec3 vector(std::string_view key) const { return vector(at(key), path(key)); }
  dvec3 vector(std::string_view key, const dvec3& otherwise) const { return has(key) ? vector(key) : otherwise; }
  /// Each above 0.
  dvec3 lengths(std::string_view key) const {
    const dvec3 value = vector(key);
    for (std::size_t i = 0; i < 3; ++i) length(at(key).at(i), within(path(key), i));
    return value;
  }
  dvec3 direction(std::string_view key, const dvec3& otherwise) const {
    const dvec3 value = vector(key, otherwise);
    if (!(scarp::length(value) >= kLeastLength)) {
      throw Error(fmt::format("{}: expected a direction, got a vector of length 0", path(key)));
    }
    return value;
  }

  static dvec3 vector(const Json& json, const std::string& path) {
    if (!json.is_array() || json.size() != 3) refuse(path, "a list of 3 numbers", json);
    dvec3 value;
    for (std::size_t i = 0; i < 3; ++i) value[static_cast<int>(i)] = number(json[i], within(path, i));
    return value;
  }

 private:
  static double number(const Json& json, const std::string& path) {
    if (!json.is_number()) refuse(path, "a number", json);
    const double value = json.get<double>();
    if (!(std::abs(value) <= kMostLength)) refuse(path, "a number between -2^30 and 2^30", json);
    return value;
  }
  static double length(const Json& json, const std::string& path) {
    const double value = number(json, path);
    if (!(value >= kLeastLength)) refuse(path, value > 0 ? "at least 2^-20" : "> 0", json);
    return value;
  }

  const Json& json_;
  std::string path_;
};

template <std::size_t N>
Settings settings(const Json& json, const std::string& path, const std::string_view (&known)[N]) {
  return {json, path, known};
}

// Keys that are settings of a shape, not its type.
bool is_setting(std::string_view key) { return key == "material" || key == "smooth" || key == "of"; }

class ShapeReader {
 public:
  explicit ShapeReader(const ShapeNames& names) : names_(names) {}

  Shape shape(const Json& json, const std::string& path, int depth) const {
    if (depth > kDeepestJson) {
      throw Error(fmt::format("{}...: shapes nested deeper than {}; nest less", path.substr(0, 60), kDeepestJson));
    }
    if (!json.is_object()) refuse(path, "an object that is a shape", json);
    std::string_view kind;
    for (const auto& [key, value] : json.items()) {
      if (is_setting(key)) continue;
      if (!is_kind(key))
        throw Error(fmt::format("{}: unknown kind of shape (available: {})", within(path, key), kinds()));
      if (!kind.empty()) {
        throw Error(fmt::format("{}: both {} and {}; a shape is one thing", path.empty() ? "/" : path, kind, key));
      }
      kind = key;
    }
    if (kind.empty()) throw Error(fmt::format("{}: expected a shape, one of: {}", path.empty() ? "/" : path, kinds()));
    const bool is_placed = kind == "translate" || kind == "rotate" || kind == "scale" || kind == "repeat";
    const bool is_combined = kind == "union" || kind == "intersection" || kind == "subtract";
    if (json.contains("of") != is_placed) {
      throw Error(fmt::format("{}: {}", within(path, "of"),
                              is_placed ? "is missing; it must be a shape" : fmt::format("{} has no such key", kind)));
    }
    if (json.contains("smooth") && !is_combined) {
      throw Error(fmt::format("{}: {} has no such key", within(path, "smooth"), kind));
    }
    const Json& what = json.at(std::string(kind));
    Shape out;
    if (is_placed) {
      out = placed(kind, what, within(path, kind), shape(json.at("of"), within(path, "of"), depth + 1));
    } else if (is_combined) {
      const std::string_view of[] = {"union", "intersection", "subtract", "smooth", "material"};
      const double smooth = settings(json, path, of).radius("smooth", 0);
      out = combined(kind, what, within(path, kind), smooth, depth);
    } else {
      out = solid(kind, what, within(path, kind));
    }
    if (json.contains("material")) {
      out =
          made(within(path, "material"), shape::Painted{out, material(json.at("material"), within(path, "material"))});
    }
    return out;
  }

 private:
  // Fewer than the maximum depth of nodes, because a solid has up to three: its placement, itself and its material.
  static constexpr int kDeepestJson = 64;

  static constexpr std::array<std::string_view, 16> kKinds = {
      "sphere", "box",       "plane",  "capsule", "cylinder", "cone",  "torus",        "ellipsoid",
      "ground", "translate", "rotate", "scale",   "repeat",   "union", "intersection", "subtract"};
  static bool is_kind(std::string_view key) {
    for (const std::string_view kind : kKinds) {
      if (key == kind) return true;
    }
    return false;
  }
  static std::string kinds() { return fmt::format("{}", fmt::join(kKinds, ", ")); }

  // Adds the position to errors that the library throws.
  static Shape made(const std::string& path, const shape::Form& form) {
    try {
      return make_shape(form);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", path, error.what()));
    }
  }
  static Shape at(const std::string& path, const Settings& s, const shape::Form& form) {
    const Shape solid = made(path, form);
    return s.has("at") ? made(path, shape::Moved{solid, s.vector("at")}) : solid;
  }

  Shape solid(std::string_view kind, const Json& json, const std::string& path) const {
    if (kind == "sphere") {
      const Settings s = settings(json, path, {"radius", "at"});
      return at(path, s, shape::Sphere{s.length("radius")});
    }
    if (kind == "box") {
      const Settings s = settings(json, path, {"half", "round", "at"});
      return at(path, s, shape::Box{s.lengths("half"), s.radius("round", 0)});
    }
    if (kind == "plane") {
      const Settings s = settings(json, path, {"normal", "height"});
      return made(path, shape::HalfSpace{s.direction("normal", {0, 0, 1}), s.number("height", 0)});
    }
    if (kind == "capsule") {
      const Settings s = settings(json, path, {"from", "to", "radius"});
      return made(path, shape::Capsule{s.vector("from"), s.vector("to"), s.length("radius")});
    }
    if (kind == "cylinder") {
      const Settings s = settings(json, path, {"radius", "half_height", "at"});
      return at(path, s, shape::Cylinder{s.length("radius"), s.length("half_height")});
    }
    if (kind == "cone") {
      const Settings s = settings(json, path, {"radius", "height", "top", "at"});
      return at(path, s, shape::Cone{s.length("radius"), s.length("height"), s.radius("top", 0)});
    }
    if (kind == "torus") {
      const Settings s = settings(json, path, {"radius", "tube", "at"});
      return at(path, s, shape::Torus{s.length("radius"), s.length("tube")});
    }
    if (kind == "ellipsoid") {
      const Settings s = settings(json, path, {"radii", "at"});
      return at(path, s, shape::Ellipsoid{s.lengths("radii")});
    }
    if (!names_.ground) throw Error(fmt::format("{}: there are no fields here that could be a ground", path));
    const Shape ground = names_.ground(json, path);
    if (!ground) throw Error(fmt::format("{}: {} is no ground", path, told(json)));
    return ground;
  }

  static Shape placed(std::string_view kind, const Json& json, const std::string& path, const Shape& of) {
    if (kind == "translate") return made(path, shape::Moved{of, Settings::vector(json, path)});
    if (kind == "scale") {
      const Json object{{"scale", json}};
      return made(path,
                  shape::Scaled{of, settings(object, path.substr(0, path.rfind('/')), {"scale"}).length("scale")});
    }
    if (kind == "rotate") {
      const Settings s = settings(json, path, {"axis", "degrees"});
      const dvec3 axis = s.direction("axis", {0, 0, 1});
      const double angle = s.number("degrees") * std::numbers::pi / 180;
      return made(path, shape::Turned{of, axis, angle});
    }
    const Settings s = settings(json, path, {"period", "count"});
    shape::Repeated repeated{of, s.vector("period"), {0, 0, 0}};
    for (std::size_t i = 0; i < 3; ++i) {
      if (repeated.period[static_cast<int>(i)] < 0) refuse(within(s.path("period"), i), "0 or more", s.at("period")[i]);
    }
    const dvec3 count = s.vector("count", dvec3(0.0));
    for (std::size_t i = 0; i < 3; ++i) {
      const double n = count[static_cast<int>(i)];
      if (!(n >= 0 && n == std::floor(n))) {
        refuse(within(s.path("count"), i), "a whole number, 0 or more", s.at("count")[i]);
      }
      repeated.count[i] = static_cast<int>(n);
    }
    return made(path, std::move(repeated));
  }

  Shape combined(std::string_view kind, const Json& json, const std::string& path, double smooth, int depth) const {
    const std::size_t least = kind == "subtract" ? 2 : 1;
    if (!json.is_array() || json.size() < least) {
      refuse(path, fmt::format("a list of {} or more shapes", least), json);
    }
    std::vector<Shape> parts;
    for (std::size_t i = 0; i < json.size(); ++i) parts.push_back(shape(json[i], within(path, i), depth + 1));
    if (kind == "union") return made(path, shape::Union{std::move(parts), smooth});
    if (kind == "intersection") return made(path, shape::Intersection{std::move(parts), smooth});
    const Shape from = parts.front();
    parts.erase(parts.begin());
    const Shape what = parts.size() == 1 ? parts.front() : made(path, shape::Union{std::move(parts), 0});
    return made(path, shape::Subtraction{from, what, smooth});
  }

  int material(const Json& json, const std::string& path) const {
    if (!json.is_string()) refuse(path, "the name of a material", json);
    if (!names_.material) throw Error(fmt::format("{}: there are no materials here", path));
    return names_.material(json.get<std::string>(), path);
  }

  const ShapeNames& names_;
};

}  // namespace

Shape shape_from_json(const nlohmann::json& json, const std::string& path, const ShapeNames& names) {
  return ShapeReader(names).shape(json, path, 1);
}

DistanceField distance_field_from_json(const nlohmann::json& json, const std::string& path, const ShapeNames& names) {
  const Shape shape = shape_from_json(json, path, names);
  try {
    return DistanceField(shape);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path.empty() ? "/" : path, error.what()));
  }
}

}  // namespace scarp
