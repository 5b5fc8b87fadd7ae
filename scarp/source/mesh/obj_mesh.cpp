// SPDX-License-Identifier: MIT
// Wavefront OBJ through tinyobjloader, which reads invalid numbers as 0: coordinates are checked first.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "scarp/source/mesh/mesh_corners.h"

namespace scarp {
namespace {

constexpr std::size_t kLongestText = 60;

// Whether the text up to a comment consists of finite numbers.
bool has_numbers(const char* text) {
  for (;;) {
    while (*text == ' ' || *text == '\t' || *text == '\r') ++text;
    if (*text == '\0' || *text == '#') return true;
    char* end = nullptr;
    if (!std::isfinite(std::strtod(text, &end)) || end == text) return false;
    text = end;
  }
}

void check_numbers(const std::string& path) {
  std::ifstream in(path);
  if (!in) refuse_mesh(path, "cannot be opened (no read permission?)");
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos || line[begin] != 'v') continue;
    const std::size_t end = line.find_first_of(" \t", begin);
    if (end == std::string::npos) continue;
    const std::string_view word = std::string_view(line).substr(begin, end - begin);
    if ((word == "v" || word == "vn") && !has_numbers(line.c_str() + end)) {
      while (!line.empty() && line.back() == '\r') line.pop_back();
      refuse_mesh(path, fmt::format("line {}: '{}' (expected finite numbers)", number, line.substr(0, kLongestText)));
    }
  }
  if (in.bad()) refuse_mesh(path, "cannot be read to its end");
}

// The first of several lines, without its prefix.
std::string first_line(std::string text) {
  if (const std::size_t end = text.find('\n'); end != std::string::npos) text.resize(end);
  return text;
}

}  // namespace

TriangleMesh read_obj(const std::string& path) {
  check_numbers(path);
  tinyobj::ObjReader reader;
  tinyobj::ObjReaderConfig config;
  config.mtl_search_path = std::filesystem::path(path).parent_path().string();
  config.vertex_color = false;  // no default colours
  if (!reader.ParseFromFile(path, config)) refuse_mesh(path, first_line(reader.Error()));
  TriangleMesh mesh;
  if (reader.Warning().find("aterial") != std::string::npos)
    mesh.notes.push_back(fmt::format("{}: missing .mtl file, using grey", path));
  const tinyobj::attrib_t& all = reader.GetAttrib();
  const auto three = [](const std::vector<tinyobj::real_t>& numbers, int index) {
    const tinyobj::real_t* at = numbers.data() + 3 * static_cast<std::size_t>(index);
    return dvec3(at[0], at[1], at[2]);
  };
  const auto is_in = [](const std::vector<tinyobj::real_t>& numbers, int index) {
    return index >= 0 && 3 * static_cast<std::size_t>(index) + 2 < numbers.size();
  };
  bool textured = false;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    const tinyobj::mesh_t& faces = shape.mesh;
    for (std::size_t face = 0; 3 * face + 2 < faces.indices.size(); ++face) {
      const int material = face < faces.material_ids.size() ? faces.material_ids[face] : -1;
      std::array<FileCorner, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const tinyobj::index_t& index = faces.indices[3 * face + i];
        if (!is_in(all.vertices, index.vertex_index)) {
          refuse_mesh(path,
                      fmt::format("face refers to vertex {} of {}", index.vertex_index + 1, all.vertices.size() / 3));
        }
        corners[i].position = three(all.vertices, index.vertex_index);
        if (is_in(all.normals, index.normal_index)) corners[i].normal = three(all.normals, index.normal_index);
        if (material >= 0) {
          const tinyobj::material_t& of = reader.GetMaterials()[static_cast<std::size_t>(material)];
          corners[i].colour = vec3(of.diffuse[0], of.diffuse[1], of.diffuse[2]);
          textured = textured || !of.diffuse_texname.empty();
        } else if (is_in(all.colors, index.vertex_index)) {
          corners[i].colour = vec3(three(all.colors, index.vertex_index));
        }
      }
      add_triangle(corners, mesh);
    }
  }
  if (textured) mesh.notes.push_back(fmt::format("{}: ignored textures", path));
  return mesh;
}

}  // namespace scarp
