// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vox_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <glm/common.hpp>
#include <unordered_map>

#include "scarp/base/error.h"
#include "scarp/source/voxel/vox_animation.h"
#include "scarp/source/voxel/vox_bytes.h"
#include "scarp/source/voxel/vox_material.h"

namespace scarp {
namespace {

constexpr std::size_t kMostInstances = std::size_t{1} << 20;
constexpr int kFarthestNode = 1 << 24;

LatticeRotation turn_of(const VoxAttributes& frame) {
  const auto text = find_attribute(frame, "_r");
  if (!text) return {};
  const int bits = whole_number(*text, "rotation");
  const int first = bits & 3, second = bits >> 2 & 3;
  if (bits < 0 || bits > 127 || first > 2 || second > 2 || first == second)
    throw Error(fmt::format("rotation {} is not a lattice rotation", bits));
  const auto sign = [&](int bit) { return bits >> bit & 1 ? -1 : 1; };
  return {{first, second, 3 - first - second}, {sign(4), sign(5), sign(6)}};
}

ivec3 move_of(const VoxAttributes& frame) {
  ivec3 move(0);
  const auto text = find_attribute(frame, "_t");
  if (!text) return move;
  std::string_view rest = *text;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? rest.find(' ') : rest.size();
    if (end == std::string_view::npos)
      throw Error(fmt::format("translation is {} (expected 'x y z')", printable(*text)));
    move[axis] = whole_number(rest.substr(0, end), "coordinate of a translation");
    if (std::abs(std::int64_t{move[axis]}) > kFarthestNode)
      throw Error(fmt::format("translation by {} voxels (limited to {})", move[axis], kFarthestNode));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return move;
}

bool hidden(const VoxAttributes& attributes) { return find_attribute(attributes, "_hidden") == "1"; }

// A translation between two keyframes, rounded to whole voxels.
ivec3 interpolated(const ivec3& from, const ivec3& to, const VoxMoment& moment) {
  ivec3 move;
  for (int axis = 0; axis < 3; ++axis) {
    // Twice the exact value, plus 1 to round, as a fraction.
    const std::int64_t above = 2 * (std::int64_t{to[axis]} - from[axis]) * moment.passed + moment.distance;
    const std::int64_t below = 2 * moment.distance, whole = above / below;
    move[axis] = from[axis] + static_cast<int>(whole - (above % below < 0 ? 1 : 0));
  }
  return move;
}

// Placement or model of a node at a frame.
struct AtFrame {
  VoxInstance place;  // for transforms; without a model
  int model = 0;      // for shapes
};

AtFrame at_frame(const VoxNode& node, int frame) {
  AtFrame now;
  const std::vector<std::int64_t> keyframes = vox_keyframes(node);
  if (keyframes.empty()) return now;
  const VoxMoment moment = vox_moment(keyframes, vox_loops(node), frame);
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
    const VoxAttributes &before = transform->frames[moment.before], &after = transform->frames[moment.after];
    now.place = {0, turn_of(before), interpolated(move_of(before), move_of(after), moment)};
  } else {
    now.model = std::get<VoxShape>(node.content).models[moment.before].model;
  }
  return now;
}

using Nodes = std::unordered_map<int, const VoxNode*>;

Nodes by_id(const VoxFile& file) {
  Nodes nodes;
  for (const VoxNode& node : file.nodes) {
    if (!nodes.emplace(node.id, &node).second) throw Error(fmt::format("scene: duplicate node {}", node.id));
  }
  return nodes;
}

// The editor's root is node 0. A scene without one starts with its first node.
int root_of(const Nodes& nodes, const VoxFile& file) { return nodes.contains(0) ? 0 : file.nodes.front().id; }

std::vector<int> children_of(const VoxNode& node) {
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) return {transform->child};
  if (const auto* group = std::get_if<VoxGroup>(&node.content)) return group->children;
  return {};
}

void check_node(const VoxFile& file, const VoxNode& node, const Nodes& nodes) {
  vox_keyframes(node);
  for (const int child : children_of(node)) {
    if (!nodes.contains(child)) throw Error(fmt::format("child {} does not exist", child));
  }
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
    for (const VoxAttributes& frame : transform->frames) turn_of(frame), move_of(frame);
  }
  if (const auto* shape = std::get_if<VoxShape>(&node.content)) {
    for (const VoxModelUse& use : shape->models) {
      if (use.model < 0 || static_cast<std::size_t>(use.model) >= file.models.size())
        throw Error(fmt::format("model {} does not exist (the file has {})", use.model, file.models.size()));
    }
  }
}

void check_no_cycles(const VoxFile& file, const Nodes& nodes) {
  enum class State { open, done };
  std::unordered_map<int, State> states;
  for (const VoxNode& root : file.nodes) {
    std::vector<std::pair<int, std::vector<int>>> path;  // nodes, each with the children still to visit
    const auto enter = [&](int id) {
      states[id] = State::open;
      path.emplace_back(id, children_of(*nodes.at(id)));
    };
    if (!states.contains(root.id)) enter(root.id);
    while (!path.empty()) {
      auto& [id, children] = path.back();
      if (children.empty()) {
        states[id] = State::done;
        path.pop_back();
        continue;
      }
      const int child = children.back();
      children.pop_back();
      const auto state = states.find(child);
      if (state == states.end()) {
        enter(child);
      } else if (state->second == State::open) {
        throw Error(fmt::format("scene: node {} contains itself", child));
      }
    }
  }
}

}  // namespace

void check_vox_scene(const VoxFile& file) {
  const Nodes nodes = by_id(file);
  for (const VoxNode& node : file.nodes) {
    try {
      check_node(file, node, nodes);
    } catch (const Error& error) {
      throw Error(fmt::format("scene: node {}: {}", node.id, error.what()));
    }
  }
  check_no_cycles(file, nodes);
}

std::vector<VoxInstance> vox_instances(const VoxFile& file, const VoxSceneOptions& options) {
  std::vector<VoxInstance> instances;
  if (file.nodes.empty()) {
    if (file.models.empty()) return instances;
    const int model = file.pack ? std::min(options.frame, static_cast<int>(file.models.size()) - 1) : 0;
    instances.push_back({model, {}, file.models[static_cast<std::size_t>(model)].size / 2});
    return instances;
  }
  check_vox_scene(file);
  const Nodes nodes = by_id(file);
  std::unordered_map<int, bool> hidden_layers;
  for (const VoxLayer& layer : file.layers) hidden_layers[layer.id] = hidden(layer.attributes);

  // Computed once per node: groups may use a node many times.
  std::unordered_map<int, AtFrame> now;
  for (const VoxNode& node : file.nodes) now.emplace(node.id, at_frame(node, options.frame));

  struct Visit {
    int node;
    VoxInstance place;
  };
  std::vector<Visit> stack{{root_of(nodes, file), {}}};
  // The total is limited, too.
  for (std::size_t visits = 0; !stack.empty(); ++visits) {
    if (visits >= 8 * kMostInstances || instances.size() >= kMostInstances)
      throw Error(fmt::format("scene: more than {} model instances (use fewer objects)", kMostInstances));
    const Visit visit = stack.back();
    stack.pop_back();
    const VoxNode& node = *nodes.at(visit.node);
    if (!options.hidden && hidden(node.attributes)) continue;
    if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
      const auto layer = hidden_layers.find(transform->layer);
      if (!options.hidden && layer != hidden_layers.end() && layer->second) continue;
      const VoxInstance& own = now.at(visit.node).place;
      Visit below{transform->child, visit.place};
      below.place.turn = visit.place.turn * own.turn;
      below.place.move += visit.place.turn(own.move);
      const ivec3 away = glm::abs(below.place.move);
      if (std::max({away.x, away.y, away.z}) > kFarthestNode)
        throw Error(fmt::format("scene: node {} is more than {} voxels away (move it closer)", node.id, kFarthestNode));
      stack.push_back(below);
    } else if (const auto* group = std::get_if<VoxGroup>(&node.content)) {
      if (group->children.size() > kMostInstances)
        throw Error("scene: group of more than 2^20 nodes (use fewer objects)");
      for (auto child = group->children.rbegin(); child != group->children.rend(); ++child)
        stack.push_back({*child, visit.place});
    } else {
      instances.push_back({now.at(visit.node).model, visit.place.turn, visit.place.move});
    }
  }
  return instances;
}

std::vector<std::string> vox_notes(const VoxFile& file, const VoxSceneOptions& options) {
  std::vector<std::string> notes;
  const VoxAnimation animation = vox_animation(file);
  const std::int64_t last = animation.frames - 1;
  if (options.frame > last) {
    notes.push_back(fmt::format(
        "frame {}: {}", options.frame,
        last == 0          ? "the file has a single frame, which is shown"
        : !animation.loops ? fmt::format("the animation ends at frame {}, which is shown", last)
        : !animation.ends  ? fmt::format("the animation repeats, its last frame is {}", last)
                           : fmt::format("parts of the animation repeat, the others are shown as at frame {}", last)));
  }
  std::size_t empty = 0;
  for (const VoxModel& model : file.models)
    empty += static_cast<std::size_t>(std::count_if(model.voxels.begin(), model.voxels.end(),
                                                    [](const VoxVoxel& voxel) { return voxel.index == 0; }));
  if (empty > 0) notes.push_back(fmt::format("voxels with palette index 0, treated as empty: {}", empty));
  std::array<bool, 256> glass{};
  for (const VoxMaterial& material : file.materials) {
    if (material.id > 0 && material.id < 256 && is_vox_glass(material))
      glass[static_cast<std::size_t>(material.id)] = true;
  }
  const bool shows_glass = std::any_of(file.models.begin(), file.models.end(), [&](const VoxModel& model) {
    return std::any_of(model.voxels.begin(), model.voxels.end(),
                       [&](const VoxVoxel& voxel) { return glass[voxel.index]; });
  });
  if (shows_glass) notes.push_back("glass is shown opaque");
  return notes;
}

}  // namespace scarp
