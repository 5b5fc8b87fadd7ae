// SPDX-License-Identifier: MIT
// Shapes from JSON: shapes are built as described; errors are reported with their position.
#include "scarp/scene/file/shape_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/refusal.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

using Json = nlohmann::json;

const ShapeNames kNames{
    .material =
        [](const std::string& name, const std::string& path) {
          if (name == "red") return 1;
          if (name == "blue") return 2;
          throw Error(path + ": no such material");
        },
    .ground = [](const Json&, const std::string&) { return make_shape(shape::HalfSpace{}); },
};

DistanceField field_of(const char* text) { return distance_field_from_json(Json::parse(text), "/shape", kNames); }

TEST(ShapeJson, ReadsEverySolid) {
  // A position just outside each solid, and its distance.
  const struct {
    const char* text;
    dvec3 position;
    double distance;
  } solids[] = {
      {R"({"sphere": {"radius": 2, "at": [1, 0, 0]}})", {4, 0, 0}, 1},
      {R"({"box": {"half": [1, 2, 3], "at": [0, 1, 0]}})", {0, 4, 0}, 1},
      {R"({"box": {"half": [1, 1, 1], "round": 1}})", {3, 4, 0}, 4},
      {R"({"plane": {"normal": [0, 3, 0], "height": 2}})", {7, 5, 0}, 3},
      {R"({"capsule": {"from": [0, 0, 0], "to": [0, 4, 0], "radius": 0.5}})", {2, 1, 0}, 1.5},
      {R"({"cylinder": {"radius": 1, "half_height": 2}})", {3, 0, 1}, 2},
      {R"({"cone": {"radius": 1, "height": 2}})", {0, 0, 5}, 3},
      {R"({"cone": {"radius": 2, "height": 2, "top": 2, "at": [0, 0, 1]}})", {5, 0, 2}, 3},
      {R"({"torus": {"radius": 3, "tube": 1}})", {0, 6, 0}, 2},
      {R"({"ellipsoid": {"radii": [1, 2, 3]}})", {0, 0, 5}, 2},
      {R"({"ground": "hills"})", {3, 4, 5}, 5},
      {R"({"translate": [1, 2, 3], "of": {"sphere": {"radius": 1}}})", {1, 2, 6}, 2},
      {R"({"rotate": {"axis": [0, 0, 1], "degrees": 90}, "of": {"box": {"half": [5, 1, 1]}}})", {0, 7, 0}, 2},
      {R"({"scale": 3, "of": {"sphere": {"radius": 1}}})", {4, 0, 0}, 1},
      {R"({"repeat": {"period": [4, 0, 0], "count": [2, 0, 0]}, "of": {"sphere": {"radius": 1}}})", {12, 0, 0}, 3},
      {R"({"union": [{"sphere": {"radius": 1}}, {"sphere": {"radius": 1, "at": [5, 0, 0]}}]})", {8, 0, 0}, 2},
      {R"({"intersection": [{"sphere": {"radius": 2}}, {"plane": {}}]})", {0, 0, -4}, 2},
      {R"({"subtract": [{"box": {"half": [2, 2, 2]}}, {"sphere": {"radius": 1}}, {"plane": {"height": -1}}]})",
       {0, 0, 0},
       1},
  };
  for (const auto& [text, position, distance] : solids) {
    EXPECT_NEAR(field_of(text).value(position), distance, 1e-12) << text;
  }
  // Smooth by a quarter of the radius where both are equally far.
  const DistanceField smooth = field_of(
      R"({"union": [{"sphere": {"radius": 1, "at": [-2, 0, 0]}}, {"sphere": {"radius": 1, "at": [2, 0, 0]}}], "smooth": 0.4})");
  EXPECT_NEAR(smooth.value({0, 0, 0}), 1 - 0.1, 1e-12);
}

TEST(ShapeJson, KeepsMaterials) {
  const DistanceField field = field_of(
      R"({"material": "red", "union": [{"sphere": {"radius": 1}},
          {"sphere": {"radius": 1, "at": [5, 0, 0]}, "material": "blue"}]})");
  EXPECT_EQ(field.material({0, 0, 1}), 1);
  EXPECT_EQ(field.material({5, 0, 1}), 2);
}

std::string refusal(const std::string& text, const ShapeNames& names = kNames) {
  return test::refusal([&] { distance_field_from_json(Json::parse(text), "/objects/2/shape", names); });
}

TEST(ShapeJson, ErrorNamesThePlace) {
  const std::string at = "/objects/2/shape";
  EXPECT_EQ(refusal(R"({"sphere": {"radius": -1}})"), at + "/sphere/radius: expected > 0, got -1");
  EXPECT_EQ(refusal(R"({"sphere": {"radius": 1e-9}})"), at + "/sphere/radius: expected at least 2^-20, got 1e-09");
  EXPECT_EQ(refusal(R"({"sphere": {"radius": "big"}})"), at + "/sphere/radius: expected a number, got \"big\"");
  EXPECT_EQ(refusal(R"({"sphere": {"radius": 1e300}})"),
            at + "/sphere/radius: expected a number between -2^30 and 2^30, got 1e+300");
  EXPECT_EQ(refusal(R"({"sphere": {}})"), at + "/sphere/radius: is missing");
  EXPECT_EQ(refusal(R"({"sphere": {"radius": 1, "colour/x": 2}})"),
            at + "/sphere/colour~1x: unknown key (available: radius, at)");
  EXPECT_EQ(refusal(R"({"box": {"half": [1, 0, 1]}})"), at + "/box/half/1: expected > 0, got 0");
  EXPECT_EQ(refusal(R"({"box": {"half": [1, 1]}})"), at + "/box/half: expected a list of 3 numbers, got a list of 2");
  EXPECT_EQ(refusal(R"({"union": [{"sphere": {"radius": 1}}, {"torus": {"radius": 1, "tube": 0}}]})"),
            at + "/union/1/torus/tube: expected > 0, got 0");
  EXPECT_EQ(refusal(R"({"union": []})"), at + "/union: expected a list of 1 or more shapes, got a list of 0");
  EXPECT_EQ(refusal(R"({"subtract": [{"plane": {}}]})"),
            at + "/subtract: expected a list of 2 or more shapes, got a list of 1");
  EXPECT_EQ(refusal(R"({"translate": [0, 0, 1]})"), at + "/of: is missing; it must be a shape");
  EXPECT_EQ(refusal(R"({"scale": -2, "of": {"plane": {}}})"), at + "/scale: expected > 0, got -2");
  EXPECT_EQ(refusal(R"({"sphere": {"radius": 1}, "smooth": 1})"), at + "/smooth: sphere has no such key");
  EXPECT_EQ(refusal(R"({"sphere": {"radius": 1}, "box": {}})"), at + ": both box and sphere; a shape is one thing");
  EXPECT_EQ(refusal("[]"), at + ": expected an object that is a shape, got a list of 0");
  EXPECT_EQ(refusal(R"({"plane": {"normal": [0, 0, 0]}})"),
            at + "/plane/normal: expected a direction, got a vector of length 0");
  EXPECT_EQ(refusal(R"({"plane": {}, "material": "green"})"), at + "/material: no such material");
  EXPECT_EQ(refusal(R"({"repeat": {"period": [1, 0, 0]}, "of": {"sphere": {"radius": 1}}})"),
            at + "/repeat: shape: repeat period x is 1 (must be at least 2, the length of the repeated shape)");
  EXPECT_EQ(refusal(R"({"repeat": {"period": [3, 0, 0], "count": [1.5, 0, 0]}, "of": {"sphere": {"radius": 1}}})"),
            at + "/repeat/count/0: expected a whole number, 0 or more, got 1.5");
  EXPECT_EQ(refusal(R"({"ground": "hills"})", {}), at + "/ground: there are no fields here that could be a ground");
  EXPECT_EQ(refusal("{}").substr(0, 44), at + ": expected a shape, one of: ");
  EXPECT_EQ(refusal(R"({"cube": {}})").substr(0, 50), at + "/cube: unknown kind of shape (avai");
}

TEST(ShapeJson, RejectsDeepNesting) {
  std::string deep = R"({"sphere": {"radius": 1}})";
  for (int i = 0; i < 60; ++i) deep = R"({"scale": 1, "of": )" + deep + "}";
  EXPECT_EQ(refusal(deep), "");
  Json json = Json::parse(R"({"sphere": {"radius": 1}})");
  for (int i = 0; i < 100'000; ++i) {
    Json next;
    next["scale"] = 1;
    next["of"] = std::move(json);
    json = std::move(next);
  }
  try {
    shape_from_json(json, "/shape", kNames);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 16), "/shape/of/of/of/");
    EXPECT_NE(std::string(error.what()).find("shapes nested deeper than 64; nest less"), std::string::npos);
  }
}

}  // namespace
}  // namespace scarp::test
