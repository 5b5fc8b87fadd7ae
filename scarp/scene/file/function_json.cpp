// SPDX-License-Identifier: MIT
#include "scarp/scene/file/function_json.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/scene/file/example_functions.h"
#include "scarp/scene/file/json_object.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

constexpr double kRadians = std::numbers::pi / 180;
constexpr std::size_t kMostOperands = 1024;

const std::vector<std::string_view> kTypes = {"plane", "sines", "fbm",     "ridged",  "warp",    "terraces",
                                              "mask",  "sum",   "product", "minimum", "maximum", "smooth-minimum"};
enum Type { plane, sines, fbm, ridged, warp, terraces, mask, sum, product, minimum, maximum, smooth_minimum };

class FunctionReader {
 public:
  explicit FunctionReader(const FunctionByName& by_name) : by_name_(by_name) {}

  Function read(const Json& json, const std::string& path, int depth) const {
    if (depth > kDeepestFunction) {
      throw Error(fmt::format("{}...: more than {} functions under one another", path.substr(0, 60), kDeepestFunction));
    }
    if (json.is_number()) return made(Plane{json.get<double>()}, path);
    if (json.is_string()) return by_name_(json.get<std::string>(), path);
    if (!json.is_object()) refuse_json(path, json, "a function: an object with a type, a height, or a name");
    JsonObject object(json, path);
    if (!object.find("type")) {
      throw Error(fmt::format("{}: is missing; it must be one of {}", object.path_of("type"), fmt::join(kTypes, ", ")));
    }
    const auto type = static_cast<Type>(object.choice("type", 0, kTypes));
    const auto child = [&](const char* key) { return read(object.at(key), object.path_of(key), depth + 1); };
    Function function;
    switch (type) {
      case plane:
        function = made(plane_of(object), path);
        break;
      case sines:
        function = made(sines_of(object), path);
        break;
      case fbm:
      case ridged:
        function = made(fractal_of(object, type == ridged), path);
        break;
      case warp: {
        Warp w{child("base"), child("shift_x"), child("shift_y")};
        function = made(std::move(w), path);
        break;
      }
      case terraces: {
        Terraces t{.base = child("base")};
        t.step = object.number("step", t.step), t.rise = object.number("rise", t.rise);
        function = made(std::move(t), path);
        break;
      }
      case mask: {
        RadialMask m;
        object.pair("centre", m.centre.x, m.centre.y);
        m.inner = object.number("inner", m.inner), m.outer = object.number("outer", m.outer);
        function = made(m, path);
        break;
      }
      default:
        function = combined(type, object, depth);
    }
    object.finish();
    return function;
  }

 private:
  // make_function() reports values out of range; adds their position.
  static Function made(FunctionShape shape, const std::string& path) {
    try {
      return make_function(std::move(shape));
    } catch (const Error& error) {
      constexpr std::string_view kBefore = "terrain function: ";
      std::string_view text = error.what();
      if (text.starts_with(kBefore)) text.remove_prefix(kBefore.size());
      throw Error(fmt::format("{}: {}", path.empty() ? "/" : path, text));
    }
  }

  static Plane plane_of(JsonObject& object) {
    Plane p;
    p.height = object.number("height", p.height);
    object.pair("slope", p.slope_x, p.slope_y);
    return p;
  }

  static Sines sines_of(JsonObject& object) {
    const Json& waves = object.at("waves");
    const std::string path = object.path_of("waves");
    if (!waves.is_array() || waves.empty()) refuse_json(path, waves, "a list of waves, at least one");
    Sines s;
    for (std::size_t i = 0; i < waves.size(); ++i) {
      JsonObject wave(waves[i], fmt::format("{}/{}", path, i));
      Sine sine;
      sine.amplitude = wave.number("amplitude", sine.amplitude);
      sine.wavelength = wave.number("wavelength", sine.wavelength);
      sine.towards = wave.number("towards", 0) * kRadians;
      sine.phase = wave.number("phase", 0) * kRadians;
      wave.finish();
      s.waves.push_back(sine);
    }
    return s;
  }

  static Fractal fractal_of(JsonObject& object, bool is_ridged) {
    Fractal f;
    f.form = is_ridged ? FractalForm::ridged : FractalForm::fbm;
    f.noise = static_cast<NoiseKind>(
        object.choice("noise", static_cast<std::size_t>(f.noise), {"value", "perlin", "simplex"}));
    f.seed = static_cast<std::uint64_t>(object.whole("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
    f.wavelength = object.number("wavelength", f.wavelength);
    f.height = object.number("height", f.height);
    f.gain = object.number("gain", f.gain);
    f.lacunarity = object.number("lacunarity", f.lacunarity);
    if (object.find("turn")) {
      const double turn = object.number("turn") * kRadians;
      f.turn = {std::cos(turn), std::sin(turn)};
    }
    f.damping = object.number("damping", f.damping);
    if (is_ridged) f.focus = object.number("focus", f.focus);
    f.octaves = octaves_of(object, f.octaves);
    return f;
  }

  static Octaves octaves_of(JsonObject& object, const Octaves& fallback) {
    const Json* octaves = object.find("octaves");
    if (!octaves) return fallback;
    const auto count = [](JsonObject& from, const char* key, int otherwise) {
      return static_cast<int>(from.whole(key, otherwise, 1, kMostOctaves));
    };
    if (!octaves->is_object()) {
      const int all = count(object, "octaves", 0);
      return {all, all, all};
    }
    JsonObject by_use(*octaves, object.path_of("octaves"));
    const Octaves read{count(by_use, "march", fallback.march), count(by_use, "shadow", fallback.shadow),
                       count(by_use, "normal", fallback.normal)};
    by_use.finish();
    return read;
  }

  // With more than two operands, combines the first two, then the result with the third, and so on.
  Function combined(Type type, JsonObject& object, int depth) const {
    const Json& of = object.at("of");
    const std::string path = object.path_of("of");
    const bool two = type == smooth_minimum;
    if (!of.is_array() || of.size() < 2 || of.size() > (two ? 2 : kMostOperands)) {
      refuse_json(path, of,
                  two ? "a list of two functions" : fmt::format("a list of 2 to {} functions", kMostOperands));
    }
    std::vector<Function> operands;
    for (std::size_t i = 0; i < of.size(); ++i) {
      operands.push_back(read(of[i], fmt::format("{}/{}", path, i), depth + 1));
    }
    const std::vector<double> factors = type == sum ? factors_of(object, of.size()) : std::vector<double>();
    const double offset = type == sum ? object.number("offset", 0) : 0;
    const double radius = two ? object.number("radius", SmoothMinimum{}.radius) : 0;
    Function all = operands[0];
    for (std::size_t i = 1; i < operands.size(); ++i) {
      const Function& next = operands[i];
      FunctionShape shape = Product{all, next};
      if (type == sum) shape = Sum{all, next, i == 1 ? factors[0] : 1, factors[i], i == 1 ? offset : 0};
      if (type == minimum) shape = Minimum{all, next};
      if (type == maximum) shape = Maximum{all, next};
      if (type == smooth_minimum) shape = SmoothMinimum{all, next, radius};
      all = made(std::move(shape), object.path());
    }
    return all;
  }

  static std::vector<double> factors_of(JsonObject& object, std::size_t count) {
    const Json* factors = object.find("factors");
    if (!factors) return std::vector<double>(count, 1);
    if (!factors->is_array() || factors->size() != count) {
      refuse_json(object.path_of("factors"), *factors, fmt::format("a list of {} numbers, one per function", count));
    }
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) {
      const Json& factor = (*factors)[i];
      if (!factor.is_number()) refuse_json(fmt::format("{}/{}", object.path_of("factors"), i), factor, "a number");
      numbers.push_back(factor.get<double>());
    }
    return numbers;
  }

  const FunctionByName& by_name_;
};

}  // namespace

Function function_from_json(const Json& json, std::string_view path, const FunctionByName& by_name) {
  const FunctionByName examples = [](const std::string& name, std::string_view place) {
    try {
      return example_function(name);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", place.empty() ? "/" : place, error.what()));
    }
  };
  return FunctionReader(by_name ? by_name : examples).read(json, std::string(path), 1);
}

}  // namespace scarp
