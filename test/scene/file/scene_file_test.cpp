// SPDX-License-Identifier: MIT
// Scene files: their content, and that every error is one line with its position.
#include "scarp/scene/file/scene_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scarp/base/error.h"
#include "scarp/source/voxel/binvox.h"
#include "scratch.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

class SceneFiles : public testing::Test, protected test::Scratch {
 protected:
  SceneFile read(const std::string& text) const { return read_scene(write("scene.json", text)); }
  // The message without the file name; empty if there is none.
  std::string error(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      const std::string what = error.what(), file = fmt::format("{}: ", (folder_ / "scene.json").string());
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_EQ(what.substr(0, file.size()), file);
      return what.substr(std::min(file.size(), what.size()));
    }
    return {};
  }
};

const std::string kBall = R"({"shape": {"sphere": {"radius": 1}}})";

std::string with_object(const std::string& object) { return R"({"objects": [)" + object + "]}"; }

TEST_F(SceneFiles, ReadEverySection) {
  const SceneFile file = read(R"({
    "about": "all of it",
    "picture": {"size": [320, 200], "aa": 3, "samples": 4, "ao_distance": 10, "seed": 7},
    "camera": {"eye": [0, -20, 2], "target": [0, 0, 1], "on": "ground", "fov": 40},
    "sun": {"azimuth": 120, "altitude": 20, "size": 1, "shadows": false},
    "haze": {"distance": 500},
    "materials": {
      "a mix": {"blend": {"by": "slope", "from": 20, "to": 30, "low": "green", "high": "red"}},
      "green": {"colour": "#00ff00"}, "red": {"colour": "#ff0000"},
      "board": {"checker": {"colours": ["#000000", "#ffffff"], "size": 2}},
      "bands": {"stops": [{"z": 0, "colour": "#102030"}, {"z": 5, "colour": "#405060"}]},
      "ramp": {"ramp": {"name": "viridis", "heights": [0, 10]}}
    },
    "functions": {"base": {"type": "plane", "height": 3}},
    "fields": {"ball": {"shape": {"sphere": {"radius": 2}}}},
    "objects": [
      {"name": "ground", "function": {"type": "sum", "of": ["base", 4]}, "material": "a mix"},
      {"name": "balls", "field": "ball", "on": "ground", "scale": 0.5, "at": [0, 0, 1],
       "places": [{"at": [10, 0, 0]}, {"at": [0, 20, 5], "scale": 3, "turn": [0, 0, 90]}]},
      {"name": "crowd", "field": "ball", "on": "ground", "scatter": {"count": 50, "within": [-9, -9, 9, 9], "scale": [0.5, 2]}},
      {"heights": {"generate": {"size": [9, 9], "cell": 2}, "centred": true}, "at": [0, 0, 100], "march": "exhaustive"}
    ]
  })");
  ASSERT_EQ(file.scene.objects().size(), 1u + 2 + 50 + 1);
  EXPECT_EQ(file.scene.fields().size(), 3u);
  EXPECT_TRUE(file.scene.endless());
  EXPECT_EQ(file.names[3].name, "/objects/3");
  EXPECT_EQ(file.names[2].count, 50u);
  EXPECT_EQ(*file.camera.eye, dvec3(0, -20, 9));  // 2 m over ground at 7 m
  EXPECT_EQ(*file.picture.width, 320);
  EXPECT_EQ(*file.sun.shadows, false);
  EXPECT_EQ(*file.haze_distance, 500);
  ASSERT_EQ(file.materials.size(), 6u);
  const auto& blend = std::get<Blend>(file.materials[file.scene.objects()[0].material]);
  EXPECT_EQ(std::get<PlainColour>(file.materials[blend.high]).colour, vec3(1, 0, 0));
  // The transform inside the object comes first, then its placement; z counts from the ground.
  const Placement& second = file.scene.objects()[2].placement;
  EXPECT_EQ(second.scale, 1.5);
  EXPECT_NEAR(length(second.origin - dvec3(0, 20, 7 + 5 + 3)), 0, 1e-12);
  EXPECT_NEAR(length(second.world_from_field({1, 0, 0}) - second.origin - dvec3(0, 1.5, 0)), 0, 1e-12);
  EXPECT_EQ(file.scene.fields()[file.scene.objects()[53].field]->march(), "exhaustive");
  for (std::uint32_t i = 3; i < 53; ++i) {
    const Placement& place = file.scene.objects()[i].placement;
    EXPECT_EQ(place.origin.z, 7);
    EXPECT_LE(std::abs(place.origin.x), 9);
    EXPECT_TRUE(place.scale >= 0.5 && place.scale <= 2);
  }
}

TEST_F(SceneFiles, SupportWaterAndFog) {
  const SceneFile dry = read(with_object(kBall));
  EXPECT_FALSE(dry.water || dry.fog);
  const SceneFile file = read(R"({"water": {"level": -2.5, "colour": "#00ff00", "turbidity": 0.5, "waves": 0.1,
    "wavelength": 7, "reflection": false, "refraction": true},
    "fog": {"kind": "height", "visibility": 800, "base": 3, "falloff": 20, "sun_tint": 0.25}, "objects": [)" +
                              kBall + "]}");
  ASSERT_TRUE(file.water && file.fog);
  EXPECT_EQ(file.water->level, -2.5);
  EXPECT_EQ(*file.water->srgb, vec3(0, 1, 0));
  EXPECT_EQ(*file.water->turbidity + *file.water->waves + *file.water->wavelength, 0.5 + 0.1 + 7);
  EXPECT_FALSE(*file.water->reflection);
  EXPECT_TRUE(*file.water->refraction);
  EXPECT_EQ(file.fog->kind, "height");
  EXPECT_EQ(*file.fog->visibility + *file.fog->base + *file.fog->falloff + *file.fog->sun_tint, 823.25);
  const SceneFile plain = read(R"({"water": {"level": 1}, "fog": {"kind": "distance"}, "objects": [)" + kBall + "]}");
  EXPECT_FALSE(plain.water->srgb || plain.water->waves || plain.water->reflection || plain.fog->visibility);
}

// The looks of voxels, by name: a rounded cube lacks its corner, and has a smooth normal next to it.
TEST_F(SceneFiles, SupportVoxelLooks) {
  Binvox cube;
  cube.size = ivec3(2);
  cube.clear();
  for_each_voxel({ivec3(0), cube.size}, [&](const ivec3& v) { cube.set(v); });
  write_binvox((folder_ / "cube.binvox").string(), cube);
  const SceneFile file = read(R"({"picture": {"coarse_voxels": true}, "objects": [
    {"voxels": {"file": "cube.binvox", "rounded": 0.5, "normals": "smooth", "colour": "#ff8000", "corner_ao": true,
                "surface_colours": true, "up": "y"}}]})");
  EXPECT_TRUE(file.picture.coarse_voxels);
  Ray ray;
  ray.origin = {1.95, 1.95, 5};
  EXPECT_FALSE(file.scene.closest_hit(ray));
  ray.origin = {1.6, 1.6, 5};
  const Hit hit = file.scene.closest_hit(ray);
  ASSERT_TRUE(hit);
  const SceneSurface surface = file.scene.surface(ray, hit);
  EXPECT_EQ(surface.colour, (VoxelColour{255, 128, 0}));
  EXPECT_GT(surface.shading_normal.x, 0.1);
  EXPECT_EQ(surface.openness, 1);
}

// A cube of 4 voxels minus a cube of 2 voxels in its upper corner, which is rotated, moved, and of another colour.
TEST_F(SceneFiles, CombineVoxels) {
  for (const int side : {2, 4}) {
    Binvox cube;
    cube.size = ivec3(side);
    cube.clear();
    for_each_voxel({ivec3(0), cube.size}, [&](const ivec3& v) { cube.set(v); });
    write_binvox((folder_ / fmt::format("cube{}.binvox", side)).string(), cube);
  }
  const auto parts = [](const char* at) {
    return fmt::format(R"([{{"file": "cube4.binvox", "colour": "#ff0000", "at": [0.5, 0, 0]}},
                           {{"file": "cube2.binvox", "colour": "#00ff00", "turn": [0, 0, 90], "at": {}}}])",
                       at);
  };
  const auto combined = [&](const std::string& name, const char* at) {
    return with_object(fmt::format(R"({{"scale": 2, "voxels": {{"{}": {}}}}})", name, parts(at)));
  };
  // From above, in metres: half a voxel is one metre.
  const auto height = [](const SceneFile& file, double x, double y) {
    const Ray ray{.origin = {x, y, 100}, .direction = {0, 0, -1}};
    const Hit hit = file.scene.closest_hit(ray);
    return hit ? 100 - hit.t : -1;
  };
  const SceneFile cut = read(combined("subtract", "[4.5, 2, 2]"));
  EXPECT_EQ(height(cut, 2, 1), 8);
  EXPECT_EQ(height(cut, 8, 7), 4);
  EXPECT_EQ(height(cut, 0.5, 1), -1);
  const SceneFile common = read(combined("intersection", "[4.5, 3, 3]"));
  EXPECT_EQ(common.scene.box().low, dvec3(5, 6, 6));
  EXPECT_EQ(common.scene.box().high, dvec3(9, 8, 8));
  const SceneFile both = read(combined("union", "[6.5, 0, 3]"));
  EXPECT_EQ(height(both, 2, 1), 8);
  EXPECT_EQ(height(both, 10, 1), 10);
  // Combinations can be parts of others; an empty result causes a note.
  const SceneFile nested = read(R"({"objects": [{"shape": {"sphere": {"radius": 1}}}, {"voxels": {"centred": true,
    "subtract": [{"union": [{"file": "cube2.binvox"}, {"file": "cube2.binvox", "at": [2, 0, 0]}]},
                 {"file": "cube4.binvox"}]}}]})");
  EXPECT_EQ(nested.notes, std::vector<std::string>{"/objects/1/voxels/subtract: the result is empty"});
  EXPECT_EQ(error(combined("union", "[1, 0, 0]")),
            "/objects/0/voxels/union: part 1 is (0.5, 0, 0) voxels off the lattice of the first one (combined voxels "
            "need whole offsets)");
  EXPECT_EQ(
      error(with_object(R"({"voxels": {"union": [{"file": "cube2.binvox"}], "file": "cube2.binvox"}})")).substr(0, 18),
      "/objects/0/voxels:");
  EXPECT_EQ(error(with_object(R"({"voxels": {"union": [{"file": "cube2.binvox"}], "up": "y"}})")),
            "/objects/0/voxels/up: not valid with union (set it in the parts)");
  EXPECT_EQ(error(with_object(R"({"voxels": {"union": [{"file": "cube2.binvox", "frame": 2}]}})")).substr(0, 31),
            "/objects/0/voxels/union/0/frame");
  EXPECT_NE(error(with_object(R"({"voxels": {"subtract": [{"file": "cube2.binvox"}]}})")).find("at least two"),
            std::string::npos);
}

TEST_F(SceneFiles, IncludeOtherScenesAsOneObject) {
  write("pair.json", R"({"materials": {"red": {"colour": "#ff0000"}}, "objects": [
    {"shape": {"sphere": {"radius": 1}}, "material": "red"}, {"shape": {"sphere": {"radius": 1}}, "at": [4, 0, 0]}]})");
  const SceneFile file = read(R"({"materials": {"blue": {"colour": "#0000ff"}}, "objects": [
    {"shape": {"box": {"half": [1, 1, 1]}}, "material": "blue"},
    {"name": "pairs", "scene": "pair.json", "places": [{"at": [10, 0, 0]}, {"at": [20, 0, 0], "turn": [0, 0, 90], "scale": 2}]}]})");
  ASSERT_EQ(file.scene.objects().size(), 5u);
  const auto& objects = file.scene.objects();
  EXPECT_EQ(std::get<PlainColour>(file.materials[objects[1].material]).colour, vec3(1, 0, 0));
  EXPECT_NEAR(length(objects[4].placement.origin - dvec3(20, 8, 0)), 0, 1e-12);
}

#if defined(SCARP_EMBREE) && defined(SCARP_MESH)
TEST_F(SceneFiles, PlaceMeshes) {
  // A wedge, y up: 4 wide, 2 high, 6 deep.
  write("wedge.obj", "v 1 5 0\nv 5 5 0\nv 1 7 0\nv 1 5 6\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  const SceneFile file = read(R"({
    "functions": {"hill": {"type": "plane", "height": 10}},
    "fields": {"wedge": {"mesh": {"file": "wedge.obj", "centred": true}}},
    "objects": [
      {"name": "hill", "function": "hill"},
      {"name": "wedges", "field": "wedge", "on": "hill", "places": [{"at": [100, 0, 0], "scale": 2}, {"at": [200, 0, 5]}]},
      {"mesh": {"file": "wedge.obj", "up": "z"}, "at": [300, 0, 100]}
    ]
  })");
  ASSERT_EQ(file.scene.objects().size(), 4u);
  EXPECT_EQ(file.scene.marches(), "embree, lipschitz-local");
  EXPECT_EQ(file.files.back(), (folder_ / "wedge.obj").string());
  const auto height = [&](double x, double y) {
    Ray ray;
    ray.origin = {x, y, 1000};
    return 1000 - file.scene.closest_hit(ray).t;
  };
  // The ridge at the low x, where z of the file is 0: y of the world is -z.
  EXPECT_NEAR(height(96.001, 5.999), 14, 0.01);
  EXPECT_NEAR(height(95.9, 5.9), 10, 1e-3);
  EXPECT_NEAR(height(198.001, 2.999), 17, 0.01);
  // In the file's coordinates: corners at z 0 and, at (1, 5), 6.
  EXPECT_NEAR(height(301.001, 5.001), 106, 0.02);
}
#endif

TEST_F(SceneFiles, ErrorNamesPlaceAndProblem) {
  write("itself.json", R"({"objects": [{"scene": "scene.json"}]})");
  struct Case {
    std::string text, place, what;
  };
  const std::vector<Case> cases = {
      {"", "no JSON", "line 1"},
      {"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer", "git lfs pull"},
      {"{\"objects\": [,]}", "no JSON", "line 1, column 14"},
      {with_object(R"({"shape": {"sphere": {"radius": 1e999}}})"), "/objects/0/shape/sphere/radius", "1e999"},
      {with_object(R"({"shape": {"sphere": {"radius": NaN}}})"), "no JSON", "line 1"},
      {"[]", "/:", "an object with objects"},
      {"{}", "/objects:", "is missing; expected a list of objects"},
      {R"({"objects": []})", "/objects:", "at least one"},
      {R"({"objects": [], "objects": []})", "/objects:", "twice"},
      {R"({"objects": [)" + kBall + R"(], "camara": {}})", "/camara:", "unknown (available: $schema, about, camera"},
      {R"({"objects": [)" + kBall + R"(], "sun": {"altitude": 91}})", "/sun/altitude:", "at most 90"},
      {R"({"objects": [)" + kBall + R"(], "picture": {"size": [0, 5]}})", "/picture/size/0:", "from 1 to 65536"},
      {R"({"objects": [)" + kBall + R"(], "camera": {"eye": [0, 0, 0]}})", "/camera/target:", "is missing"},
      {R"({"objects": [)" + kBall + R"(], "camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}})",
       "/camera/target:", "eye"},
      {R"({"objects": [)" + kBall + R"(], "materials": {"m": {"colour": "red"}}})", "/materials/m/colour:", "#rrggbb"},
      {R"({"objects": [)" + kBall + R"(], "materials": {"m": {}}})", "/materials/m:", "one of colour"},
      {R"({"objects": [)" + kBall + R"(], "materials": {
          "a": {"blend": {"by": "height", "from": 0, "to": 1, "low": "b", "high": "b"}},
          "b": {"blend": {"by": "height", "from": 0, "to": 1, "low": "a", "high": "a"}}}})",
       "/materials/b/blend/low:", "contains itself"},
      {R"({"objects": [)" + kBall +
           R"(], "materials": {"m": {"stops": [{"z": 1, "colour": "#000000"}, {"z": 1, "colour": "#000000"}]}}})",
       "/materials/m/stops/1/z:", "expected more"},
      {with_object("3"), "/objects/0:", "is 3; expected an object"},
      {with_object("{}"), "/objects/0:", "one of heights, function, shape, voxels, mesh"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "function": 3})"), "/objects/0:", "has function and shape"},
      {with_object(R"({"shape": {"sphere": {"radius": -1}}})"), "/objects/0/shape/sphere/radius:", "-1"},
      {with_object(R"({"function": {"type": "fbm", "wavelength": 0}})"), "/objects/0/function", "wavelength"},
      {with_object(R"({"function": "loop"})")
           .insert(1, R"("functions": {"loop": {"type": "sum", "of": ["loop", 1]}}, )"),
       "/functions/loop/of/0:", "contains itself"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "at": [1, 2]})"), "/objects/0/at:", "[x, y, z]"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "at": [1, 2, "up"]})"), "/objects/0/at/2:", "metres"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "scale": 0})"), "/objects/0/scale:", "above 0"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "material": "gold"})"),
       "/objects/0/material:", "no material 'gold'"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "on": "sea"})"), "/objects/0/on:", "no object 'sea'"},
      {with_object(kBall + R"(, {"shape": {"sphere": {"radius": 1}}, "on": "/objects/0"})"),
       "/objects/1/at:", "no ground"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "march": "max-mip"})"), "/objects/0/march:", "sphere-trace"},
      {with_object(R"({"function": 1, "settings": {"naive_tolerance": -1}})"), "/objects/0/settings:", "0 or more"},
      {with_object(R"({"function": 1, "settings": {"speed": 1}})"), "/objects/0/settings/speed:", "unknown"},
      {with_object(R"({"field": "tree"})"), "/objects/0/field:", "no field 'tree'"},
      {with_object(R"({"field": "tree", "march": "naive"})"), "/objects/0/march:", "does not go with field"},
      {with_object(R"({"voxels": {}})"), "/objects/0/voxels:", "one of file, union, intersection, subtract"},
      {with_object(R"({"voxels": {"file": "none.vox"}})"), "/objects/0/voxels/file:", "none.vox"},
      {with_object(R"({"voxels": {"file": "none.vox", "rounded": 0.7}})"), "/objects/0/voxels/rounded:", "0 to 0.5"},
      {with_object(R"({"voxels": {"file": "none.vox", "normals": "soft"}})"), "/objects/0/voxels/normals:", "smooth"},
      {with_object(R"({"voxels": {"file": "none.vox", "up": "y"}})"), "/objects/0/voxels/up:", "binvox"},
      {with_object(R"({"voxels": {"file": "none.binvox", "frame": 1}})"), "/objects/0/voxels/frame:", "MagicaVoxel"},
      {with_object(R"({"voxels": {"file": "none.raw", "volume": "2x2:u8"}})"), "/objects/0/voxels/file:", "NXxNYxNZ"},
      {with_object(R"({"heights": {"file": "none.tif"}})"), "/objects/0/heights/file:", "none.tif"},
      {with_object(R"({"heights": {}})"), "/objects/0/heights:", "one of file"},
      {with_object(R"({"mesh": {"up": "y"}})"), "/objects/0/mesh/file:", "is missing; expected the path of a triangle"},
      {with_object(R"({"mesh": {"file": "none.obj", "up": "x"}})"), "/objects/0/mesh/up:", "y or z"},
#ifdef SCARP_EMBREE
      {with_object(R"({"mesh": {"file": "none.obj"}})"), "/objects/0/mesh/file:", "none.obj"},
      {with_object(R"({"mesh": {"file": "none.obj"}, "march": "embree"})"),
       "/objects/0/march:", "does not go with mesh"},
#else
      {with_object(R"({"mesh": {"file": "none.obj"}})"), "/objects/0/mesh:", "SCARP_EMBREE=OFF"},
#endif
      {with_object(R"({"scene": "none.json"})"), "/objects/0/scene:", "none.json"},
      {with_object(R"({"scene": "scene.json"})"), "/objects/0/scene:", "a scene cannot"},
      {with_object(R"({"scene": "itself.json"})"), "/objects/0/scene:", "a scene cannot"},
      {with_object(R"({"function": 0, "name": "sea"}, {"name": "sea", "function": 1})"), "/objects/1/name:", "taken"},
      {with_object(R"({"function": 0, "name": "sea"}, {"on": "sea", "shape": {"sphere": {"radius": 1}},
          "scatter": {"count": 5, "within": [0, 0, 1, 1], "heights": [5, 9]}})"),
       "/objects/1/scatter:", "found room for 0 of 5"},
      {with_object(R"({"shape": {"sphere": {"radius": 1}}, "scatter": {"count": 5, "within": [0, 0, 1, 1]}})"),
       "/objects/0/on:", "is missing"},
      {with_object(R"({"shape": )" + std::string(1'000'000, '[')), "/objects/0/shape/0/0", "than the 1000"},
  };
  for (const Case& wrong : cases) {
    const std::string told = error(wrong.text);
    EXPECT_EQ(told.substr(0, wrong.place.size()), wrong.place) << wrong.text.substr(0, 200) << "\n  " << told;
    EXPECT_NE(told.find(wrong.what), std::string::npos) << wrong.text.substr(0, 200) << "\n  " << told;
    EXPECT_LT(told.size(), 600u);
  }
  EXPECT_THROW(read_scene((folder_ / "nowhere.json").string()), Error);
}

}  // namespace
}  // namespace scarp
