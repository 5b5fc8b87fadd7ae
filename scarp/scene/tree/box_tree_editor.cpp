// SPDX-License-Identifier: MIT
#include "scarp/scene/tree/box_tree_editor.h"

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <limits>
#include <utility>

namespace scarp {
namespace {

constexpr double kWorstArea = 2;           // relative to the area when the tree was built
constexpr std::uint64_t kEditsPerBox = 8;  // building costs about as much as one or two edits per box
constexpr std::uint64_t kFewEdits = 64;
// Range of a tree's coordinates from its centre, relative to its boxes when it was built: an object that moves away
// causes a rebuild each time its distance has doubled.
constexpr double kReach = 2;

}  // namespace

BoxTreeEditor::Box BoxTreeEditor::around(const Box& a, const Box& b) {
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(a.low[axis], b.low[axis]);
    box.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return box;
}

double BoxTreeEditor::half_area(const Box& box) {
  const auto side = [&](std::size_t axis) { return double{box.high[axis]} - double{box.low[axis]}; };
  return side(0) * side(1) + side(1) * side(2) + side(2) * side(0);
}

BoxTreeEditor::Box BoxTreeEditor::rounded(const WorldBox& box) const {
  Box rounded;
  for (int axis = 0; axis < 3; ++axis) {
    rounded.low[static_cast<std::size_t>(axis)] = tree_.rounded_low(box, axis);
    rounded.high[static_cast<std::size_t>(axis)] = tree_.rounded_high(box, axis);
  }
  return rounded;
}

bool BoxTreeEditor::in_reach(const WorldBox& box) const {
  const WorldBox& reach = tree_.box_;
  return glm::all(glm::greaterThanEqual(box.low, reach.low)) && glm::all(glm::lessThanEqual(box.high, reach.high));
}

BoxTreeEditor::Box BoxTreeEditor::box(const Slot& slot) const {
  const BoxTree::Node& node = tree_.nodes_[slot.node];
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = node.low[axis][slot.index];
    box.high[axis] = node.high[axis][slot.index];
  }
  return box;
}

BoxTreeEditor::Box BoxTreeEditor::box_of(std::uint32_t node) const {
  Box all = box({node, 0});
  for (int i = 1; i < BoxTree::kWide; ++i) all = around(all, box({node, i}));
  return all;
}

bool BoxTreeEditor::used(const Slot& slot) const {
  const BoxTree::Node& node = tree_.nodes_[slot.node];
  return node.low[0][slot.index] <= node.high[0][slot.index];
}

bool BoxTreeEditor::is_node(const Slot& slot) const { return used(slot) && !(child(slot) & BoxTree::kLeaf); }

int BoxTreeEditor::free_index(std::uint32_t node) const {
  for (int i = 0; i < BoxTree::kWide; ++i) {
    if (!used({node, i})) return i;
  }
  return -1;
}

std::uint8_t BoxTreeEditor::height_of(std::uint32_t node) const {
  int highest = 0;
  for (int i = 0; i < BoxTree::kWide; ++i) {
    if (is_node({node, i})) highest = std::max<int>(highest, height_[child({node, i})]);
  }
  return static_cast<std::uint8_t>(highest + 1);
}

void BoxTreeEditor::rebuild(std::span<const WorldBox> boxes, std::vector<std::uint32_t> objects) {
  edits_ = 0;
  edits_allowed_ = kEditsPerBox * objects.size() + kFewEdits;
  lost_ = false;
  tree_ = BoxTree(boxes, std::move(objects), kReach);
  const auto nodes = static_cast<std::uint32_t>(tree_.nodes_.size());
  parent_.assign(nodes, {});
  height_.assign(nodes, 0);
  leaf_.assign(boxes.size(), {});
  unused_.clear();
  area_ = 0;
  // Children come after their parents.
  for (std::uint32_t node = nodes; node-- > 0;) {
    for (int i = 0; i < BoxTree::kWide; ++i) {
      const Slot slot{node, i};
      if (!used(slot)) continue;
      const bool inner = is_node(slot);
      (inner ? parent_ : leaf_)[child(slot) & ~BoxTree::kLeaf] = slot;
      if (inner) area_ += half_area(box(slot));
    }
    height_[node] = height_of(node);
  }
  area_built_ = area_;
}

bool BoxTreeEditor::needs_rebuild() const {
  // Very large boxes have an infinite area: their trees are rebuilt each time.
  return lost_ || !(area_ <= kWorstArea * area_built_) || edits_ > edits_allowed_;
}

std::uint32_t BoxTreeEditor::new_node() {
  std::uint32_t node;
  if (unused_.empty()) {
    node = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.emplace_back();
    parent_.emplace_back();
    height_.emplace_back();
  } else {
    node = unused_.back();
    unused_.pop_back();
  }
  for (int i = 0; i < BoxTree::kWide; ++i) tree_.nodes_[node].clear(i);
  return node;
}

void BoxTreeEditor::put(const Slot& slot, const Box& box, std::uint32_t what) {
  if (is_node(slot)) area_ -= half_area(this->box(slot));
  BoxTree::Node& node = tree_.nodes_[slot.node];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.low[axis][slot.index] = box.low[axis];
    node.high[axis][slot.index] = box.high[axis];
  }
  child(slot) = what;
  const bool inner = is_node(slot);
  if (inner) area_ += half_area(box);
  const std::uint32_t index = what & ~BoxTree::kLeaf;
  if (!inner && index >= leaf_.size()) leaf_.resize(index + 1);
  (inner ? parent_ : leaf_)[index] = slot;
}

void BoxTreeEditor::clear(const Slot& slot) {
  if (is_node(slot)) area_ -= half_area(box(slot));
  tree_.nodes_[slot.node].clear(slot.index);
}

// Lower bound of the area that inserting into a node adds to the nodes below it.
double BoxTreeEditor::least_below(std::uint32_t node, const Box& leaf) const {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < BoxTree::kWide; ++i) {
    const Slot slot{node, i};
    if (!used(slot)) return 0;
    const Box old = box(slot);
    const double area = half_area(around(old, leaf));
    least = std::min(least, is_node(slot) ? area - half_area(old) : area);
  }
  return least;
}

BoxTreeEditor::Place BoxTreeEditor::cheapest(std::uint32_t node, const Box& leaf) const {
  Place best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](Place::Way way, int index, double cost) {
    if (!(cost < least)) return;
    least = cost;
    best = {way, index};
  };
  for (int i = 0; i < BoxTree::kWide; ++i) {
    const Slot slot{node, i};
    const Box old = box(slot);
    const double area = half_area(around(old, leaf));
    consider(Place::Way::beside, i, area);
    if (is_node(slot)) consider(Place::Way::below, i, area - half_area(old) + least_below(child(slot), leaf));
  }
  if (node == 0) consider(Place::Way::above_root, 0, half_area(box_of(0)));
  return best;
}

// The child of the slot and the object become children of a new node there.
void BoxTreeEditor::pair(const Slot& slot, const Box& leaf, std::uint32_t object) {
  const Box old = box(slot);
  const std::uint32_t other = child(slot), node = new_node();
  clear(slot);
  put({node, 0}, old, other);
  put({node, 1}, leaf, BoxTree::kLeaf | object);
  height_[node] = height_of(node);
  put(slot, around(old, leaf), node);
}

// The root's children move to a new node, the only child of the root besides the object.
void BoxTreeEditor::put_above_root(const Box& leaf, std::uint32_t object) {
  const Box all = box_of(0);
  const std::uint32_t node = new_node();
  for (int i = 0; i < BoxTree::kWide; ++i) {
    const Slot from{0, i};
    if (!used(from)) continue;
    const Box moved = box(from);
    const std::uint32_t what = child(from);
    clear(from);
    put({node, i}, moved, what);
  }
  height_[node] = height_of(node);
  put({0, 0}, all, node);
  put({0, 1}, leaf, BoxTree::kLeaf | object);
}

// Refits boxes from a node whose children changed, upwards to the first that does not change.
void BoxTreeEditor::refit(std::uint32_t node) {
  while (node != 0) {
    const Slot slot = parent_[node];
    const Box all = box_of(node);
    const std::uint8_t height = height_of(node);
    if (all == box(slot) && height == height_[node]) return;
    height_[node] = height;
    put(slot, all, node);
    node = slot.node;
  }
  height_[0] = height_of(0);
  if (height_[0] > BoxTree::kMaxDepth) lost_ = true;
}

void BoxTreeEditor::insert(std::uint32_t object, const WorldBox& box) {
  ++edits_;
  lost_ = lost_ || tree_.nodes_.empty() || !in_reach(box);
  if (lost_) return;
  const Box leaf = rounded(box);
  std::uint32_t node = 0;
  while (true) {
    if (const int free = free_index(node); free >= 0) {
      put({node, free}, leaf, BoxTree::kLeaf | object);
      return refit(node);
    }
    const Place place = cheapest(node, leaf);
    if (place.way == Place::Way::below) {
      node = child({node, place.index});
      continue;
    }
    if (place.way == Place::Way::beside) {
      pair({node, place.index}, leaf, object);
    } else {
      put_above_root(leaf, object);
    }
    return refit(node);
  }
}

void BoxTreeEditor::remove(std::uint32_t object) {
  if (lost_) return;
  std::uint32_t node = leaf_[object].node;
  clear(leaf_[object]);
  int left = 0, last = 0;
  for (int i = 0; i < BoxTree::kWide; ++i) {
    if (used({node, i})) ++left, last = i;
  }
  // All nodes but the root have at least two children.
  if (node != 0 && left == 1) {
    const Slot slot = parent_[node], only{node, last};
    const Box kept = box(only);
    const std::uint32_t what = child(only);
    clear(only);
    clear(slot);
    put(slot, kept, what);
    unused_.push_back(node);
    node = slot.node;
  }
  refit(node);
}

void BoxTreeEditor::move(std::uint32_t object, const WorldBox& box) {
  lost_ = lost_ || !in_reach(box);
  if (lost_) return;
  const Box leaf = rounded(box);
  const Slot slot = leaf_[object];
  if (slot.node != 0) {
    const Box room = this->box(parent_[slot.node]);
    if (around(room, leaf) != room) {
      remove(object);
      return insert(object, box);
    }
  }
  ++edits_;
  put(slot, leaf, BoxTree::kLeaf | object);
  refit(slot.node);
}

}  // namespace scarp
