// SPDX-License-Identifier: MIT
// Terrain functions from JSON: every type, and the messages of invalid ones.
#include "scarp/scene/file/function_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "base/refusal.h"
#include "scarp/base/error.h"
#include "scarp/field/height_function.h"
#include "scarp/scene/file/example_functions.h"

namespace scarp::test {
namespace {

Function parsed(const std::string& text) { return function_from_json(nlohmann::json::parse(text), "/f"); }
double value(const std::string& text, double x, double y, FunctionUse use = FunctionUse::march) {
  return HeightFunction(parsed(text)).value(x, y, use);
}
std::string message(const std::string& text) {
  return test::refusal([&] { parsed(text); });
}

TEST(FunctionJson, ReadsEveryType) {
  const double x = 310, y = -170;
  EXPECT_EQ(value("7.5", x, y), 7.5);
  EXPECT_EQ(value(R"({"type": "plane", "height": 3, "slope": [0.5, -0.25]})", x, y), 3 + 155 + 42.5);
  EXPECT_NEAR(
      value(R"({"type": "sines", "waves": [{"amplitude": 4, "wavelength": 100, "towards": 90, "phase": 90}]})", x, y),
      4 * std::cos(2 * 3.141592653589793 * -1.7), 1e-9);
  const auto same = [&](const std::string& text, FunctionShape shape) {
    const HeightFunction made(make_function(std::move(shape)));
    for (const FunctionUse use : {FunctionUse::march, FunctionUse::shadow, FunctionUse::normal}) {
      EXPECT_EQ(value(text, x, y, use), made.value(x, y, use)) << text;
    }
  };
  same(R"({"type": "fbm"})", Fractal{});
  same(R"({"type": "fbm", "noise": "value", "seed": 7, "wavelength": 90, "height": 3, "gain": 0.4, "lacunarity": 1.9,
           "damping": 0.7, "octaves": 4})",
       Fractal{.noise = NoiseKind::value,
               .seed = 7,
               .wavelength = 90,
               .height = 3,
               .gain = 0.4,
               .lacunarity = 1.9,
               .damping = 0.7,
               .octaves = {4, 4, 4}});
  same(R"({"type": "ridged", "noise": "simplex", "focus": 3, "octaves": {"march": 3, "normal": 5}})",
       Fractal{.form = FractalForm::ridged, .noise = NoiseKind::simplex, .focus = 3, .octaves = {3, 9, 5}});
  same(R"({"type": "fbm", "turn": 90})", Fractal{.turn = {std::cos(3.141592653589793 / 2), 1}});
  const Function fbm = make_function(Fractal{}), ten = make_function(Plane{10}), two = make_function(Plane{2});
  const std::string f = R"({"type": "fbm"})";
  same(R"({"type": "warp", "base": )" + f + R"(, "shift_x": 10, "shift_y": 2})", Warp{fbm, ten, two});
  same(R"({"type": "terraces", "base": )" + f + R"(, "step": 20, "rise": 0.5})", Terraces{fbm, 20, 0.5});
  same(R"({"type": "mask", "centre": [300, -100], "inner": 10, "outer": 200})", RadialMask{{300, -100}, 10, 200});
  same(R"({"type": "sum", "of": [)" + f + R"(, 10], "factors": [2, -1], "offset": 5})", Sum{fbm, ten, 2, -1, 5});
  same(R"({"type": "smooth-minimum", "of": [)" + f + R"(, 10], "radius": 40})", SmoothMinimum{fbm, ten, 40});
  // The first two of three operands are combined first.
  EXPECT_EQ(value(R"({"type": "product", "of": [2, 3, 4]})", 0, 0), 24);
  EXPECT_EQ(value(R"({"type": "minimum", "of": [2, 1, 4]})", 0, 0), 1);
  EXPECT_EQ(value(R"({"type": "maximum", "of": [2, 1, 4]})", 0, 0), 4);
  EXPECT_EQ(value(R"({"type": "sum", "of": [2, 1, 4], "factors": [1, 10, 100], "offset": 1000})", 0, 0), 1412);
}

TEST(FunctionJson, ResolvesNames) {
  EXPECT_EQ(value(R"("hills")", 3, 4), HeightFunction(example_function("hills")).value(3, 4));
  const FunctionByName mine = [](const std::string& name, std::string_view path) -> Function {
    if (name == "five") return make_function(Plane{5});
    throw Error(std::string(path) + ": no " + name);
  };
  const auto two = nlohmann::json::parse(R"({"type": "sum", "of": ["five", "five"]})");
  EXPECT_EQ(HeightFunction(function_from_json(two, "", mine)).value(0, 0), 10);
  EXPECT_THROW(function_from_json(nlohmann::json("six"), "", mine), Error);
}

TEST(FunctionJson, ErrorNamesPlaceAndProblem) {
  EXPECT_EQ(message("[1]"), "/f: is a list of 1; expected a function: an object with a type, a height, or a name");
  EXPECT_EQ(message(R"({"height": 1})").substr(0, 35), "/f/type: is missing; it must be one");
  EXPECT_EQ(message(R"({"type": "fmb"})").substr(0, 40), R"(/f/type: is "fmb"; expected one of plane)");
  EXPECT_EQ(message(R"({"type": "fbm", "octave": 3})").substr(0, 25), "/f/octave: unknown (avail");
  EXPECT_EQ(message(R"({"type": "fbm", "octaves": 3.5})"), "/f/octaves: is 3.5; expected a whole number, 1 to 24");
  EXPECT_EQ(message(R"({"type": "fbm", "octaves": {"march": 25}})"),
            "/f/octaves/march: is 25; expected a whole number, 1 to 24");
  EXPECT_EQ(message(R"({"type": "fbm", "seed": -1})").substr(0, 30), "/f/seed: is -1; expected a who");
  EXPECT_EQ(message(R"({"type": "fbm", "seed": 18446744073709551615})").substr(0, 30),
            "/f/seed: is 184467440737095516");
  EXPECT_EQ(message(R"({"type": "fbm", "height": "x"})"), R"(/f/height: is "x"; expected a number)");
  EXPECT_EQ(message(R"({"type": "fbm", "height": -1})"), "/f: fractal height is -1 (must be between 0 and 2^30)");
  EXPECT_EQ(message(R"({"type": "sines", "waves": [{"wavelength": -1}]})"),
            "/f: sine wavelength is -1 (must be between 2^-20 and 2^30)");
  EXPECT_EQ(message(R"({"type": "sines", "waves": [{"length": 1}]})").substr(0, 28), "/f/waves/0/length: unknown (");
  EXPECT_EQ(message(R"({"type": "sum", "of": [1, {"type": "mask", "outer": "wide"}]})"),
            R"(/f/of/1/outer: is "wide"; expected a number)");
  EXPECT_EQ(message(R"({"type": "sum", "of": [1, 2], "factors": [1]})"),
            "/f/factors: is a list of 1; expected a list of 2 numbers, one per function");
  EXPECT_EQ(message(R"({"type": "smooth-minimum", "of": [1, 2, 3]})"),
            "/f/of: is a list of 3; expected a list of two functions");
  EXPECT_EQ(message(R"({"type": "warp", "base": 1, "shift_x": 1})"), "/f/shift_y: is missing");
  EXPECT_EQ(message(R"("hill")").substr(0, 37), "/f: function 'hill': unknown (availab");
  EXPECT_EQ(message(R"({"type": "mask", "centre": [1, 2, 3]})"),
            "/f/centre: is a list of 3; expected a list of two finite numbers");
}

TEST(FunctionJson, RejectsDeepNesting) {
#ifdef NDEBUG
  constexpr int kLevels = 1'000'000;
#else
  constexpr int kLevels = 100'000;
#endif
  std::string text;
  for (int i = 0; i < kLevels; ++i) text += R"({"type":"terraces","base":)";
  text += "1" + std::string(kLevels, '}');
  const std::string told = message(text);
  EXPECT_NE(told.find("more than 256 functions under one another"), std::string::npos) << told.substr(0, 200);
  EXPECT_LT(told.size(), 200u);
}

TEST(ExampleFunctions, AreValid) {
  for (const ExampleFunction& example : example_functions()) {
    const HeightFunction function(example_function(example.name));
    const FunctionBound& all = function.bound_everywhere();
    EXPECT_LT(all.low, all.high) << example.name;
    EXPECT_TRUE(std::isfinite(all.slope)) << example.name;
  }
  EXPECT_THROW(example_function("moon"), Error);
  EXPECT_THROW(read_function("/nowhere.json"), Error);
}

TEST(ExampleFunctions, ReportsGitLfsPointers) {
  const auto path = std::filesystem::temp_directory_path() / "scarp-function-pointer.json";
  std::ofstream(path) << "version https://git-lfs.github.com/spec/v1\n";
  try {
    read_function(path.string());
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ("function '" + path.string() + "': Git LFS pointer instead of the file (fetch it with: git lfs pull)",
              std::string(error.what()));
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace scarp::test
