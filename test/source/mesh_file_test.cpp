// SPDX-License-Identifier: MIT
#include "scarp/source/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scarp/base/error.h"
#include "scratch.h"

namespace scarp {
namespace {

using nlohmann::json;

class MeshFiles : public testing::Test, protected test::Scratch {
 protected:
  // The error message, without the file name.
  std::string refusal(const std::string& name, const std::string& bytes) const {
    const std::string path = write(name, bytes);
    try {
      read_mesh(path);
    } catch (const Error& error) {
      const std::string text = error.what(), head = path + ": ";
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return text.starts_with(head) ? text.substr(head.size()) : "other: " + text;
    }
    return "read";
  }
};

// A triangle in glTF: corners in one buffer, floats; indices of 16 bits behind them.
json triangle_document() {
  return json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "buffers": [{"byteLength": 44, "uri": "corners.bin"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]})");
}
std::string bytes_of(const std::vector<float>& numbers, const std::vector<std::uint16_t>& indices) {
  std::string bytes(4 * numbers.size() + 2 * indices.size(), '\0');
  std::memcpy(bytes.data(), numbers.data(), 4 * numbers.size());
  std::memcpy(bytes.data() + 4 * numbers.size(), indices.data(), 2 * indices.size());
  return bytes;
}
const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// A square with y up in the plane z = 0: cut in two, its normal is that of the plane, and z goes up.
TEST_F(MeshFiles, TriangulatesAndRotatesObjPolygons) {
  const std::string path = write("square.obj", "# a wall\nv 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4\n");
  const TriangleMesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.corners.size(), 6u);
  double highest = 0;
  for (const MeshCorner& corner : mesh.corners) {
    EXPECT_EQ(corner.position.y, 0);
    EXPECT_EQ(corner.normal, vec3(0, -1, 0));
    EXPECT_EQ(corner.colour, kMeshGrey);
    highest = std::max(highest, corner.position.z);
  }
  EXPECT_EQ(highest, 3);
  EXPECT_EQ(read_mesh(path, MeshUp::z).corners[0].normal, vec3(0, 0, 1));
}

TEST_F(MeshFiles, ReadsObjNormalsMaterialsAndNegativeIndices) {
  write("red.mtl", "newmtl red\nKd 0.5 0.25 0\n");
  const std::string path = write(
      "red.obj", "mtllib red.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nvn 0 2 0\nusemtl red\nf -3//1 -2//1 -1//1\nf 1 1 2\n");
  const TriangleMesh mesh = read_mesh(path, MeshUp::z);
  ASSERT_EQ(mesh.corners.size(), 3u) << "the other has no area";
  EXPECT_EQ(mesh.corners[2].position, dvec3(0, 0, 1));
  EXPECT_EQ(mesh.corners[0].normal, vec3(0, 1, 0)) << "the file's, not the plane's";
  EXPECT_EQ(mesh.corners[0].colour, vec3(0.5, 0.25, 0));
}

TEST_F(MeshFiles, RejectsBadObj) {
  EXPECT_EQ(refusal("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
            "line 2: 'v nan 0 0' (expected finite numbers)");
  EXPECT_EQ(refusal("huge.obj", "v 0 0 1e999\n"), "line 1: 'v 0 0 1e999' (expected finite numbers)");
  EXPECT_EQ(refusal("word.obj", "v 0 zero 0\n"), "line 1: 'v 0 zero 0' (expected finite numbers)");
  EXPECT_EQ(refusal("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "face refers to vertex 9 of 3");
  EXPECT_EQ(refusal("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "no triangles");
  EXPECT_EQ(refusal("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "no triangles");
  EXPECT_EQ(refusal("empty.obj", ""), "no triangles");
  for (const char* name : {"pointer.obj", "pointer.gltf", "pointer.glb"}) {
    EXPECT_EQ(refusal(name, "version https://git-lfs.github.com/spec/v1\n"),
              "Git LFS pointer instead of the file (fetch it with: git lfs pull)");
  }
  EXPECT_NE(refusal("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"), "read");
  EXPECT_EQ(refusal("model.stl", ""), "unknown mesh format (the name must end in .obj, .gltf or .glb)");
  EXPECT_THROW(read_mesh((folder_ / "none.obj").string()), Error);
  EXPECT_THROW(read_mesh((folder_ / "none.glb").string()), Error);
}

TEST_F(MeshFiles, AppliesGltfNodeTransforms) {
  json document = triangle_document();
  // Twice as large, a quarter turn about y (x to -z), moved; then by the parent.
  document["nodes"] = json::parse(R"([{"children": [1], "translation": [0, 0, 5]},
    {"mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0.70710678118654757, 0, 0.70710678118654757], "translation": [10, 0, 0]}])");
  write("corners.bin", bytes_of(kTriangle, {0, 1, 2, 0}));
  const TriangleMesh mesh = read_mesh(write("moved.gltf", document.dump()));
  ASSERT_EQ(mesh.corners.size(), 3u);
  // In the file (10, 0, 5), (10, 0, 3), (10, 2, 5); here y is -z and z is y.
  const dvec3 expected[] = {{10, -5, 0}, {10, -3, 0}, {10, -5, 2}};
  for (int i = 0; i < 3; ++i) EXPECT_LT(length(mesh.corners[i].position - expected[i]), 1e-12) << i;
  EXPECT_LT(length(mesh.corners[0].normal - vec3(1, 0, 0)), 1e-6f);
}

TEST_F(MeshFiles, ReadsGltfColoursStripsAndFans) {
  json document = triangle_document();
  document["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.25, 1]}}])");
  auto& primitive = document["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  document["accessors"][1]["count"] = 4;
  document["bufferViews"][1]["byteLength"] = 8;
  const std::vector<std::uint16_t> order = {0, 1, 2, 0};
  for (const int mode : {5, 6}) {
    primitive["mode"] = mode;
    write("corners.bin", bytes_of(kTriangle, order));
    const TriangleMesh mesh = read_mesh(write("strip.gltf", document.dump()));
    // The strip has 0 1 2 and 1 0 2; the fan has 0 1 2 and a degenerate triangle.
    EXPECT_EQ(mesh.corners.size(), mode == 5 ? 6u : 3u);
    EXPECT_EQ(mesh.corners[0].colour, vec3(0.5, 1, 0.25));
    // In a strip every second triangle is flipped, so that all face one way; this one is folded back.
    EXPECT_EQ(mesh.corners[0].normal, vec3(0, -1, 0));
    EXPECT_EQ(mesh.corners.back().normal, vec3(0, mode == 5 ? 1 : -1, 0));
  }
}

TEST_F(MeshFiles, RejectsBadGltf) {
  write("corners.bin", bytes_of(kTriangle, {0, 1, 2, 0}));
  const auto with = [&](const auto& change) {
    json document = triangle_document();
    change(document);
    return refusal("bad.gltf", document.dump());
  };
  EXPECT_EQ(with([](json&) {}), "read");
  EXPECT_EQ(with([](json& d) { d["accessors"][0]["count"] = 4; }), "accessor 0 reaches beyond its buffer");
  EXPECT_EQ(with([](json& d) { d["accessors"][0]["count"] = 2; }), "triangle refers to vertex 2 of 2");
  EXPECT_EQ(with([](json& d) { d["nodes"][0]["mesh"] = 7; }), "refers to mesh 7 of 1");
  EXPECT_EQ(with([](json& d) { d["nodes"][0]["children"] = {0}; }), "nodes do not form a tree");
  EXPECT_EQ(with([](json& d) { d["meshes"][0]["primitives"][0]["mode"] = 1; }),
            "no triangles (" + (folder_ / "bad.gltf").string() + ": ignored points and lines)");
  EXPECT_EQ(with([](json& d) { d["meshes"][0]["primitives"][0]["attributes"] = json::object(); }), "no triangles");
  EXPECT_EQ(with([](json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
            "requires the extension KHR_draco_mesh_compression, which is not supported");
  EXPECT_NE(with([](json& d) { d["buffers"][0]["uri"] = "gone.bin"; }), "read");
  // A file with textures only.
  EXPECT_EQ(refusal("empty.gltf",
                    R"({"asset": {"version": "2.0"}, "images": [{"uri": "x.png"}], "textures": [{"source": 0}]})"),
            "no triangles");
  EXPECT_NE(refusal("text.gltf", "not glTF"), "read");
  EXPECT_NE(refusal("short.glb", "glTF"), "read");
  EXPECT_NE(refusal("empty.glb", ""), "read");
  write("corners.bin", bytes_of({0, 0, 0, 1, NAN, 0, 0, 1, 0}, {0, 1, 2, 0}));
  EXPECT_EQ(with([](json&) {}), "vertex 1 is not finite");
}

}  // namespace
}  // namespace scarp
