// SPDX-License-Identifier: MIT
// glTF 2.0 through tinygltf, which validates the document but not its references; those are validated here.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <string>

#include "scarp/source/mesh/mesh_corners.h"

namespace scarp {
namespace {

// Deeper documents cannot be trees, which glTF requires.
constexpr int kDeepest = 256;
constexpr std::size_t kMostCorners = std::size_t{1} << 31;

bool leave_out_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                     void*) {
  return true;
}

template <class T>
const T& at(const std::vector<T>& all, int index, const std::string& path, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= all.size())
    refuse_mesh(path, fmt::format("refers to {} {} of {}", what, index, all.size()));
  return all[static_cast<std::size_t>(index)];
}

// Numbers of an accessor, element by element.
class Accessor {
 public:
  Accessor(const tinygltf::Model& model, int index, const std::string& path)
      : path_(path), accessor_(at(model.accessors, index, path, "accessor")) {
    if (accessor_.sparse.isSparse) refuse_mesh(path, "sparse accessors are not supported");
    const tinygltf::BufferView& view = at(model.bufferViews, accessor_.bufferView, path, "buffer view");
    const tinygltf::Buffer& buffer = at(model.buffers, view.buffer, path, "buffer");
    components_ = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_.type));
    const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor_.componentType));
    const int stride = accessor_.ByteStride(view);
    if (components_ < 1 || bytes < 1 || stride < 1) refuse_mesh(path, "accessor of unknown type");
    stride_ = static_cast<std::size_t>(stride);
    bytes_ = static_cast<std::size_t>(bytes);
    const std::size_t begin = view.byteOffset + accessor_.byteOffset;
    const std::size_t room = buffer.data.size();
    const std::size_t one = bytes_ * static_cast<std::size_t>(components_);
    if (begin < view.byteOffset || begin > room ||
        (accessor_.count > 0 && ((room - begin) < one || (room - begin - one) / stride_ < accessor_.count - 1)))
      refuse_mesh(path, fmt::format("accessor {} reaches beyond its buffer", index));
    data_ = buffer.data.data() + begin;
  }

  std::size_t count() const { return accessor_.count; }
  int components() const { return components_; }

  /// Returns component i of element n; normalised integers are divided by their maximum.
  double number(std::size_t n, int i) const {
    const unsigned char* from = data_ + n * stride_ + static_cast<std::size_t>(i) * bytes_;
    switch (accessor_.componentType) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return static_cast<double>(as<float>(from));
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return as<std::uint8_t>(from) / (accessor_.normalized ? 255.0 : 1.0);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return as<std::uint16_t>(from) / (accessor_.normalized ? 65535.0 : 1.0);
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return std::max(-1.0, as<std::int8_t>(from) / (accessor_.normalized ? 127.0 : 1.0));
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return std::max(-1.0, as<std::int16_t>(from) / (accessor_.normalized ? 32767.0 : 1.0));
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return as<std::uint32_t>(from);
      default:
        refuse_mesh(path_, "accessor of unknown type");
    }
  }
  dvec3 three(std::size_t n) const { return {number(n, 0), number(n, 1), number(n, 2)}; }

 private:
  template <class T>
  static T as(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }

  const std::string& path_;
  const tinygltf::Accessor& accessor_;
  const unsigned char* data_ = nullptr;
  std::size_t stride_ = 0, bytes_ = 0;
  int components_ = 0;
};

glm::dmat4 parent_from(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  glm::dmat4 matrix(1.0);
  if (node.rotation.size() == 4) {
    const auto& r = node.rotation;
    matrix = glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
  }
  if (node.scale.size() == 3) {
    for (int i = 0; i < 3; ++i) matrix[i] *= node.scale[static_cast<std::size_t>(i)];
  }
  if (node.translation.size() == 3)
    matrix[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
  return matrix;
}

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& model, const std::string& path) : model_(model), path_(path) {}

  TriangleMesh read() {
    std::vector<int> roots;
    if (!model_.scenes.empty()) {
      roots = at(model_.scenes, std::max(0, model_.defaultScene), path_, "scene").nodes;
    } else {
      std::vector<bool> is_child(model_.nodes.size());
      for (const tinygltf::Node& node : model_.nodes) {
        for (const int child : node.children) {
          at(model_.nodes, child, path_, "node");
          is_child[static_cast<std::size_t>(child)] = true;
        }
      }
      for (std::size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
      }
    }
    for (const int root : roots) add_node(root, glm::dmat4(1.0), 0);
    const auto note = [&](bool any, const char* what) {
      if (any) mesh_.notes.push_back(fmt::format("{}: ignored {}", path_, what));
    };
    note(textured_, "textures");
    note(!model_.animations.empty(), "animations");
    note(others_, "points and lines");
    return std::move(mesh_);
  }

 private:
  void add_node(int index, const glm::dmat4& world_from_parent, int depth) {
    // Nodes that form a cycle would never end.
    if (depth > kDeepest || ++visits_ > model_.nodes.size()) refuse_mesh(path_, "nodes do not form a tree");
    const tinygltf::Node& node = at(model_.nodes, index, path_, "node");
    const glm::dmat4 world_from_node = world_from_parent * parent_from(node);
    if (node.mesh >= 0) {
      for (const tinygltf::Primitive& primitive : at(model_.meshes, node.mesh, path_, "mesh").primitives)
        add(primitive, world_from_node);
    }
    for (const int child : node.children) add_node(child, world_from_node, depth + 1);
  }

  void add(const tinygltf::Primitive& primitive, const glm::dmat4& world_from_node) {
    const bool strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
               fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (!strip && !fan && primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) {
      others_ = true;
      return;
    }
    const auto accessor = [&](const char* name, int least) -> std::optional<Accessor> {
      const auto found = primitive.attributes.find(name);
      if (found == primitive.attributes.end()) return {};
      Accessor of(model_, found->second, path_);
      if (of.components() < least) refuse_mesh(path_, fmt::format("{} have {} components", name, of.components()));
      return of;
    };
    const auto positions = accessor("POSITION", 3);
    if (!positions) return;
    const auto normals = accessor("NORMAL", 3), colours = accessor("COLOR_0", 3);
    std::optional<Accessor> indices;
    if (primitive.indices >= 0) indices.emplace(model_, primitive.indices, path_);
    vec3 base(1.0f);
    if (primitive.material >= 0) {
      const auto& material = at(model_.materials, primitive.material, path_, "material").pbrMetallicRoughness;
      textured_ = textured_ || material.baseColorTexture.index >= 0;
      if (material.baseColorFactor.size() >= 3)
        base = {material.baseColorFactor[0], material.baseColorFactor[1], material.baseColorFactor[2]};
    } else if (!colours) {
      base = kMeshGrey;
    }
    // Normals transform with the inverse transpose.
    const glm::dmat3 turn(world_from_node), normal_turn = glm::transpose(glm::inverse(turn));
    const auto corner = [&](std::size_t i) {
      std::size_t n = i;
      if (indices) n = static_cast<std::size_t>(indices->number(i, 0));
      if (n >= positions->count())
        refuse_mesh(path_, fmt::format("triangle refers to vertex {} of {}", n, positions->count()));
      FileCorner result;
      result.position = dvec3(world_from_node * glm::dvec4(positions->three(n), 1));
      const dvec3& p = result.position;
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
        refuse_mesh(path_, fmt::format("vertex {} is not finite", n));
      if (normals && n < normals->count()) {
        const dvec3 normal = normal_turn * normals->three(n);
        if (std::isfinite(length(normal))) result.normal = normal;
      }
      result.colour = base;
      if (colours && n < colours->count()) result.colour *= vec3(colours->three(n));
      return result;
    };
    const std::size_t count = indices ? indices->count() : positions->count();
    if (mesh_.corners.size() + 3 * count > kMostCorners) refuse_mesh(path_, "too many triangles");
    for (std::size_t i = 0; i + 2 < count; i += strip || fan ? 1 : 3) {
      // Every second triangle of a strip has the opposite orientation.
      const std::size_t turned = strip ? i % 2 : 0;
      add_triangle({corner(fan ? 0 : i), corner(i + 1 + turned), corner(i + 2 - turned)}, mesh_);
    }
  }

  const tinygltf::Model& model_;
  const std::string& path_;
  TriangleMesh mesh_;
  std::size_t visits_ = 0;
  bool textured_ = false, others_ = false;
};

}  // namespace

TriangleMesh read_gltf(const std::string& path, bool binary) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(leave_out_image, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const bool read = binary ? loader.LoadBinaryFromFile(&model, &error, &warning, path)
                           : loader.LoadASCIIFromFile(&model, &error, &warning, path);
  if (!read) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    while (!error.empty() && error.back() == ' ') error.pop_back();
    refuse_mesh(path, error.empty() ? "not a glTF file" : fmt::format("not a readable glTF file: {}", error));
  }
  if (!model.extensionsRequired.empty()) {
    for (const std::string& name : model.extensionsRequired) {
      if (!name.starts_with("KHR_materials") && name != "KHR_texture_transform")
        refuse_mesh(path, fmt::format("requires the extension {}, which is not supported", name));
    }
  }
  return GltfReader(model, path).read();
}

}  // namespace scarp
