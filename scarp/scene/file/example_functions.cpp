// SPDX-License-Identifier: MIT
#include "scarp/scene/file/example_functions.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/scene/file/function_json.h"
#include "scarp/source/incomplete_file.h"

namespace scarp {
namespace {

constexpr std::array kExamples = {
    ExampleFunction{"hills", "plain fBm of Perlin noise, 9 octaves",
                    R"({"type": "fbm", "wavelength": 1600, "height": 320, "gain": 0.45})"},
    ExampleFunction{"eroded", "fBm of value noise, damped by its gradient as in Elevated: sharp slopes, calm valleys",
                    R"({"type": "fbm", "noise": "value", "seed": 2, "wavelength": 2400, "height": 900, "damping": 1,
                        "octaves": {"march": 9, "shadow": 9, "normal": 13}})"},
    ExampleFunction{
        "ridges", "ridged multifractal of simplex noise: crests that meet",
        R"({"type": "ridged", "noise": "simplex", "seed": 3, "wavelength": 3600, "height": 520, "gain": 0.42})"},
    ExampleFunction{"warped", "fBm whose plane is bent by another one",
                    R"({"type": "warp", "base": {"type": "fbm", "seed": 4, "wavelength": 1400, "height": 280},
                        "shift_x": {"type": "fbm", "seed": 5, "wavelength": 2600, "height": 420, "octaves": 2},
                        "shift_y": {"type": "fbm", "seed": 6, "wavelength": 2600, "height": 420, "octaves": 2}})"},
    ExampleFunction{"sea", "waves: a sum of sines",
                    R"({"type": "sines", "waves": [
                        {"amplitude": 3.2, "wavelength": 140, "towards": 70},
                        {"amplitude": 1.8, "wavelength": 83, "towards": 38, "phase": 40},
                        {"amplitude": 1.1, "wavelength": 47, "towards": 105, "phase": 90},
                        {"amplitude": 0.5, "wavelength": 22, "towards": 60, "phase": 10}]})"},
    ExampleFunction{"mesas", "terraced hills",
                    R"({"type": "terraces", "base": {"type": "fbm", "seed": 8, "wavelength": 1500,
                        "height": 320, "octaves": 7}, "step": 60, "rise": 0.25})"},
    ExampleFunction{"island", "ridges inside a radial mask, and a calm sea",
                    R"({"type": "maximum", "of": [
                        {"type": "sum", "offset": -40, "of": [
                          {"type": "product", "of": [
                            {"type": "sum", "offset": 300, "of": [
                              {"type": "ridged", "noise": "perlin", "seed": 9, "wavelength": 2500, "height": 700},
                              {"type": "fbm", "seed": 10, "wavelength": 3000, "height": 200, "octaves": 3}]},
                            {"type": "mask", "inner": 200, "outer": 4200}]},
                          0]},
                        {"type": "sines", "waves": [{"amplitude": 0.6, "wavelength": 90, "towards": 70},
                                                    {"amplitude": 0.3, "wavelength": 37, "towards": 20}]}]})"},
};

}  // namespace

std::span<const ExampleFunction> example_functions() { return kExamples; }

Function example_function(std::string_view name) {
  std::string names;
  for (const ExampleFunction& example : kExamples) {
    if (example.name == name) return function_from_json(nlohmann::json::parse(example.json), "");
    names += fmt::format("{}{}", names.empty() ? "" : ", ", example.name);
  }
  throw Error(fmt::format("function '{}': unknown (available: {})", name, names));
}

Function read_function(const std::string& name_or_path) {
  for (const ExampleFunction& example : kExamples) {
    if (example.name == name_or_path) return example_function(name_or_path);
  }
  refuse_special_file(name_or_path, fmt::format("function '{}': ", name_or_path));
  std::ifstream file(name_or_path, std::ios::binary);
  if (!file) {
    std::string names;
    for (const ExampleFunction& example : kExamples) names += fmt::format("{}, ", example.name);
    throw Error(fmt::format("function '{}': neither a file that can be read nor one of {}", name_or_path,
                            names.substr(0, names.size() - 2)));
  }
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  nlohmann::json json;
  try {
    refuse_lfs_pointer(bytes);
    json = nlohmann::json::parse(bytes);
  } catch (const Error& error) {
    throw Error(fmt::format("function '{}': {}", name_or_path, error.what()));
  } catch (const nlohmann::json::exception& error) {
    std::string_view text = error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    if (const auto end = text.find("] "); end != std::string_view::npos) text.remove_prefix(end + 2);
    throw Error(fmt::format("function '{}': is not JSON: {}", name_or_path, text));
  }
  try {
    return function_from_json(json, "");
  } catch (const Error& error) {
    throw Error(fmt::format("function '{}': {}", name_or_path, error.what()));
  }
}

}  // namespace scarp
