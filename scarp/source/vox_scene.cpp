// SPDX-License-Identifier: MIT
#include "scarp/source/vox_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <glm/common.hpp>
#include <unordered_map>

#include "scarp/base/error.h"
#include "scarp/source/vox_bytes.h"

namespace scarp {
namespace {

constexpr std::size_t kMostInstances = std::size_t{1} << 20;
constexpr int kFarthest = 1 << 24;

int whole(std::string_view text, std::string_view what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(fmt::format("{} is {} (expected an integer)", what, printable(text)));
  return value;
}

LatticeRotation turn_of(const VoxAttributes& frame) {
  const auto text = find_attribute(frame, "_r");
  if (!text) return {};
  const int bits = whole(*text, "rotation");
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
    move[axis] = whole(rest.substr(0, end), "coordinate of a translation");
    if (std::abs(std::int64_t{move[axis]}) > kFarthest)
      throw Error(fmt::format("translation by {} voxels (limited to {})", move[axis], kFarthest));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return move;
}

bool hidden(const VoxAttributes& attributes) { return find_attribute(attributes, "_hidden") == "1"; }

int frame_of(const VoxAttributes& attributes) {
  const auto text = find_attribute(attributes, "_f");
  return text ? whole(*text, "frame") : 0;
}

// The last item that begins no later than the frame, or the first.
template <class Items, class Attributes>
const auto& at_frame(const Items& items, int frame, const Attributes& attributes) {
  const auto* found = &items.front();
  for (const auto& item : items) {
    if (frame_of(attributes(item)) <= frame) found = &item;
  }
  return *found;
}

using Nodes = std::unordered_map<int, const VoxNode*>;

Nodes by_id(const VoxFile& file) {
  Nodes nodes;
  for (const VoxNode& node : file.nodes) {
    if (!nodes.emplace(node.id, &node).second) throw Error(fmt::format("scene: duplicate node {}", node.id));
  }
  return nodes;
}

std::vector<int> children_of(const VoxNode& node) {
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) return {transform->child};
  if (const auto* group = std::get_if<VoxGroup>(&node.content)) return group->children;
  return {};
}

void check_node(const VoxFile& file, const VoxNode& node, const Nodes& nodes) {
  for (const int child : children_of(node)) {
    if (!nodes.contains(child)) throw Error(fmt::format("child {} does not exist", child));
  }
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
    for (const VoxAttributes& frame : transform->frames) turn_of(frame), move_of(frame), frame_of(frame);
  }
  if (const auto* shape = std::get_if<VoxShape>(&node.content)) {
    for (const VoxModelUse& use : shape->models) {
      frame_of(use.attributes);
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

  struct Visit {
    int node;
    VoxInstance place;
  };
  std::vector<Visit> stack{{file.nodes.front().id, {}}};
  // Groups may be used repeatedly: the total is limited.
  for (std::size_t visits = 0; !stack.empty(); ++visits) {
    if (visits >= 8 * kMostInstances || instances.size() >= kMostInstances)
      throw Error(fmt::format("scene: more than {} model instances", kMostInstances));
    const Visit visit = stack.back();
    stack.pop_back();
    const VoxNode& node = *nodes.at(visit.node);
    if (!options.hidden && hidden(node.attributes)) continue;
    if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
      const auto layer = hidden_layers.find(transform->layer);
      if (!options.hidden && layer != hidden_layers.end() && layer->second) continue;
      const VoxAttributes& frame =
          at_frame(transform->frames, options.frame, [](const VoxAttributes& f) -> const VoxAttributes& { return f; });
      Visit below{transform->child, visit.place};
      below.place.turn = visit.place.turn * turn_of(frame);
      below.place.move += visit.place.turn(move_of(frame));
      const ivec3 away = glm::abs(below.place.move);
      if (std::max({away.x, away.y, away.z}) > kFarthest)
        throw Error(fmt::format("scene: node {} is more than {} voxels away", node.id, kFarthest));
      stack.push_back(below);
    } else if (const auto* group = std::get_if<VoxGroup>(&node.content)) {
      if (group->children.size() > kMostInstances) throw Error("scene: group of more than 2^20 nodes");
      for (auto child = group->children.rbegin(); child != group->children.rend(); ++child)
        stack.push_back({*child, visit.place});
    } else if (const auto* shape = std::get_if<VoxShape>(&node.content)) {
      const VoxModelUse& use = at_frame(shape->models, options.frame,
                                        [](const VoxModelUse& u) -> const VoxAttributes& { return u.attributes; });
      instances.push_back({use.model, visit.place.turn, visit.place.move});
    }
  }
  return instances;
}

}  // namespace scarp
