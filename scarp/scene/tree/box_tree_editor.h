// SPDX-License-Identifier: MIT
// Private to the station: edits of a BoxTree, one box at a time.
//
//   insert   down from the root to the place where the boxes of nodes grow least; then up again, growing them
//   remove   up from the leaf, shrinking boxes; a node that keeps one child is replaced by it
//   move     in place while the box stays inside that of its node; else remove and insert
//
// Boxes are rounded outwards as in a new tree, so that edits never lose a hit. Each edit costs a path through the tree.
//
// Many edits make a tree slower than a new one. It must be rebuilt (needs_rebuild) when the expected number of nodes
// that a ray visits may have doubled, by the surface area of all nodes; after 8 edits per box, over which the cost of
// the rebuild is amortised; when a box leaves the range of the tree's coordinates; and when the tree is too deep.
//
// Source: J. Goldsmith, J. Salmon, "Automatic creation of object hierarchies for ray tracing", IEEE Computer Graphics
// and Applications 7(5), 1987 (insertion by surface area). Cost: 8 bytes per node and 4 per box.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/scene/tree/box_tree.h"

namespace scarp {

class BoxTreeEditor {
 public:
  /// Edits `tree` until it is destroyed. Call rebuild() first.
  explicit BoxTreeEditor(BoxTree& tree) : tree_(tree) {}

  /// Builds the tree over boxes[i] for each i in `objects`; boxes as for BoxTree.
  void rebuild(std::span<const WorldBox> boxes, std::vector<std::uint32_t> objects);

  /// insert() requires that the object is not in the tree; move() and remove() require that it is. Boxes are finite and
  /// not empty.
  void insert(std::uint32_t object, const WorldBox& box);
  void remove(std::uint32_t object);
  void move(std::uint32_t object, const WorldBox& box);

  /// Whether rebuild() must be called before the next query.
  bool needs_rebuild() const;

 private:
  // In the form of nodes.
  struct Box {
    std::array<float, 3> low, high;

    bool operator==(const Box&) const = default;
  };
  // A child's place in a node.
  struct Slot {
    std::uint32_t node;
    int index;
  };
  // Where to insert: as a sibling of a child, in a new node; below a child; or beside all children of the root.
  struct Place {
    enum class Way { beside, below, above_root };
    Way way = Way::beside;
    int index = 0;
  };

  static Box around(const Box& a, const Box& b);
  static double half_area(const Box& box);
  Box rounded(const WorldBox& box) const;
  bool in_reach(const WorldBox& box) const;

  Box box(const Slot& slot) const;
  Box box_of(std::uint32_t node) const;
  bool used(const Slot& slot) const;
  bool is_node(const Slot& slot) const;
  std::uint32_t& child(const Slot& slot) { return tree_.nodes_[slot.node].child[static_cast<std::size_t>(slot.index)]; }
  std::uint32_t child(const Slot& slot) const {
    return tree_.nodes_[slot.node].child[static_cast<std::size_t>(slot.index)];
  }
  int free_index(std::uint32_t node) const;
  std::uint8_t height_of(std::uint32_t node) const;

  std::uint32_t new_node();
  void put(const Slot& slot, const Box& box, std::uint32_t child);
  void clear(const Slot& slot);
  double least_below(std::uint32_t node, const Box& leaf) const;
  Place cheapest(std::uint32_t node, const Box& leaf) const;
  void pair(const Slot& slot, const Box& leaf, std::uint32_t object);
  void put_above_root(const Box& leaf, std::uint32_t object);
  void refit(std::uint32_t node);

  BoxTree& tree_;
  std::vector<Slot> parent_;          // per node; undefined for the root, which is node 0
  std::vector<Slot> leaf_;            // per object
  std::vector<std::uint8_t> height_;  // per node: levels below it, itself included
  std::vector<std::uint32_t> unused_;
  double area_ = 0, area_built_ = 0;  // surface area of the boxes of all nodes except the root
  std::uint64_t edits_ = 0, edits_allowed_ = 0;
  bool lost_ = false;  // whether an edit was left to rebuild()
};

}  // namespace scarp
