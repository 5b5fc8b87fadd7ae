// SPDX-License-Identifier: MIT
// A hierarchy of boxes: finds the objects that a ray may hit, or that may be nearest to something else, roughly nearest
// first.
//
// A node has four children, so one test covers four boxes. Boxes are stored in float, relative to the centre of the
// whole tree, and padded by more than the rounding error: a ray never misses a box that it touches. Rays start where
// they enter the outer box, so their distance to it does not matter.
//
// Rays of similar direction form a beam, which traverses the hierarchy once for all of them: an interval of origins and
// one of slopes per axis; a box is hit if the beam's earliest entry is not later than its latest exit.
//
// Sources: H. Dammertz, J. Hanika, A. Keller, "Shallow bounding volume hierarchies for fast SIMD ray tracing of
// incoherent rays", EGSR 2008; T. Ize, "Robust BVH ray traversal", JCGT 2013; I. Wald, "On fast construction of
// SAH-based bounding volume hierarchies", 2007 (16 bins); A. Reshetov, A. Soupikov, J. Hurley, "Multi-level ray tracing
// algorithm", SIGGRAPH 2005 (beams by interval arithmetic). Cost: 112 bytes per node, a node per 3 objects.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "scarp/base/four_floats.h"
#include "scarp/base/ray.h"
#include "scarp/base/world_box.h"

namespace scarp {

class BoxTree {
 public:
  BoxTree() = default;
  /// There must be fewer than 2^31 boxes, all finite and not empty.
  explicit BoxTree(std::span<const WorldBox> boxes);
  /// The same over boxes[i] for each i in `objects` only. box() is `reach` times as wide as the boxes, reach >= 1.
  BoxTree(std::span<const WorldBox> boxes, std::vector<std::uint32_t> objects, double reach = 1);

  /// A group of at most Beam::kRays rays; up to 7 numbers beyond them are read and ignored.
  struct Rays {
    std::size_t count;
    std::array<const double*, 3> origin, direction;
    const double *t_min, *t_max;
  };
  /// Rays of similar direction.
  struct Beam;
  /// Returns the rays as a beam; nullopt if they diverge.
  std::optional<Beam> beam(const Rays& rays) const;
  /// Calls visit(object) for each object whose box a ray of the beam may hit before the beam's end, roughly nearest
  /// first. visit returns the new end of the beam, or a negative number to stop.
  template <class Visit>
  void traverse(const Beam& beam, const Visit& visit) const;

  /// Calls visit(object) for each object whose box the ray may hit at or before t_max; visit returns the new t_max, no
  /// larger than before.
  template <class Visit>
  void traverse(const Ray& ray, const Visit& visit) const;

  /// Calls visit(object) for each object whose box may contain something no worse than `end`, roughly best first.
  /// bound(box) returns the best possible value in a box: a time or a distance, >= 0; infinity for none. visit returns
  /// the new `end`, no larger than before, or a negative number to stop.
  template <class Bound, class Visit>
  void search(double end, const Bound& bound, const Visit& visit) const;

  bool empty() const { return nodes_.empty(); }
  /// The tree in the layout of devices. A node has 112 bytes: four boxes (low x, y, z, high x, y, z; four floats each,
  /// relative to `middle`) and their children. `box` is the padded box around everything.
  struct Parts {
    std::span<const std::byte> nodes;
    dvec3 middle;
    WorldBox box;
    std::uint32_t levels;
  };
  Parts parts() const;
  /// Around all boxes.
  const WorldBox& box() const { return box_; }
  std::size_t bytes() const { return sizeof(*this) + nodes_.size() * sizeof(Node); }

 private:
  static constexpr int kWide = 4;
  static constexpr std::uint32_t kLeaf = 0x8000'0000;
  // With one level per split, at most 32 of them unbalanced and 32 in halves.
  static constexpr int kMaxDepth = 64;

  using Four = FourFloats;

  struct Node {
    std::array<Four, 3> low, high;           // per axis; low above high where there is no child
    std::array<std::uint32_t, kWide> child;  // a node, or kLeaf and an object

    void clear(int i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis][i] = std::numeric_limits<float>::infinity();
        high[axis][i] = -std::numeric_limits<float>::infinity();
      }
    }
  };
  friend class BoxTreeEditor;  // box_tree_editor.h
  struct Builder;
  template <class Number>
  struct Entry {
    Number bound;
    std::uint32_t child;
  };
  template <class Number>
  using StackOf = std::array<Entry<Number>, (kWide - 1) * kMaxDepth + kWide>;
  using Stack = StackOf<float>;

  // Sides of a box as nodes store them.
  float rounded_low(const WorldBox& box, int axis) const {
    return static_cast<float>(box.low[axis] - middle_[axis] - padding_);
  }
  float rounded_high(const WorldBox& box, int axis) const {
    return static_cast<float>(box.high[axis] - middle_[axis] + padding_);
  }

  // Computes where a ray enters and leaves the outer box; returns false if it misses it.
  bool clip(const Ray& ray, double& t_in, double& t_out) const;

  // The nearest child must be on top.
  template <class Met, class Near, class Number>
  static void push(const Node& node, const Met& met, const Near& near, StackOf<Number>& stack, std::size_t& size) {
    const std::size_t first = size;
    for (std::size_t i = 0; i < kWide; ++i) {
      if (!met[i]) continue;
      std::size_t at = size++;
      for (; at > first && stack[at - 1].bound < near[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {near[i], node.child[i]};
    }
  }

  // In trees with more padding, coordinates may be infinite in float.
  static constexpr double kMostPadding = 0x1p100;
  // Rounding of a product and a difference in float, with a margin: Ize uses 2 * 3 units for a factor.
  static constexpr float kRounding = 1 + 0x1p-20f;
  // Steeper than any direction distinguishable from one along a side.
  static constexpr float kSteepest = 0x1p60f;

  std::vector<Node> nodes_;
  WorldBox box_;
  double padding_ = 0;
  dvec3 middle_{0.0};
};

struct BoxTree::Beam {
  static constexpr std::size_t kRays = 64;

  /// Lengths along the beam: (t - start) * per_t of each ray; per_t is 0 for rays that miss the outer box.
  alignas(16) std::array<double, kRays> start, per_t;
  std::uint64_t inside = 0;  ///< a bit for each ray that enters the outer box
  float end;                 ///< end of the ray that ends last

  /// End of the beam, from the ends of its rays.
  float end_of(std::span<const double> t_max) const;

 private:
  friend BoxTree;
  enum class Way { up, down, both };
  struct Axis {
    Way way;                 // common to all rays
    float low, high;         // bounds of the origins
    float per_up, per_down;  // length per distance for the steepest rays in this direction
    float per_least;         // for the flattest rays, if all have the same sign
  };
  std::array<Axis, 3> axes;
};

template <class Visit>
void BoxTree::traverse(const Beam& beam, const Visit& visit) const {
  if (nodes_.empty() || beam.inside == 0) return;
  float end = beam.end;
  Stack stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry<float> entry = stack[--size];
    if (entry.bound > end) continue;
    if (entry.child & kLeaf) {
      end = std::min(end, visit(entry.child & ~kLeaf));
      if (end < 0) return;
      continue;
    }
    const Node& node = nodes_[entry.child];
    Four near{}, far = near + end;
    for (std::size_t i = 0; i < 3; ++i) {
      const Beam::Axis& axis = beam.axes[i];
      const Four up = (node.low[i] - axis.high) * axis.per_up, down = (axis.low - node.high[i]) * axis.per_down;
      if (axis.way != Beam::Way::down) near = greater_of(near, up);
      if (axis.way != Beam::Way::up) near = greater_of(near, down);
      if (axis.way == Beam::Way::both) continue;
      const Four out = (axis.way == Beam::Way::up ? node.high[i] - axis.low : axis.high - node.low[i]) * axis.per_least;
      far = lesser_of(far, out);
    }
    push(node, not_above(near, far), near, stack, size);
  }
}

template <class Visit>
void BoxTree::traverse(const Ray& ray, const Visit& visit) const {
  if (nodes_.empty()) return;
  double t_in, t_out;
  if (!clip(ray, t_in, t_out)) return;
  const dvec3 &d = ray.direction, start = ray.origin + t_in * d - middle_;
  const std::array<double, 3> direction{d.x, d.y, d.z}, from{start.x, start.y, start.z};
  const double longest = std::max({0.0, std::abs(d.x), std::abs(d.y), std::abs(d.z)});

  // From here on in float; the longest component of the direction is 1, and t counts from the border.
  std::array<float, 3> origin, inwards, outwards;
  std::array<bool, 3> down;
  const double per_longest = 1 / longest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis] = static_cast<float>(from[axis]);
    const auto slope = static_cast<float>(direction[axis] * per_longest);
    inwards[axis] = std::abs(slope) * kSteepest < 1 ? std::copysign(kSteepest, slope) : 1 / slope;
    outwards[axis] = inwards[axis] * kRounding;
    down[axis] = std::signbit(slope);
  }
  const auto end_of = [&](double t) { return static_cast<float>((t - t_in) * longest) * kRounding; };
  float end = end_of(t_out);

  Stack stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry<float> entry = stack[--size];
    if (entry.bound > end) continue;
    if (entry.child & kLeaf) {
      end = std::min(end, end_of(visit(entry.child & ~kLeaf)));
      continue;
    }
    const Node& node = nodes_[entry.child];
    Four near{}, far = near + end;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Four in = ((down[axis] ? node.high : node.low)[axis] - origin[axis]) * inwards[axis];
      const Four out = ((down[axis] ? node.low : node.high)[axis] - origin[axis]) * outwards[axis];
      near = greater_of(near, in);
      far = lesser_of(far, out);
    }
    push(node, not_above(near, far), near, stack, size);
  }
}

template <class Bound, class Visit>
void BoxTree::search(double end, const Bound& bound, const Visit& visit) const {
  if (nodes_.empty()) return;
  StackOf<double> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry<double> entry = stack[--size];
    if (entry.bound > end) continue;
    if (entry.child & kLeaf) {
      end = std::min(end, visit(entry.child & ~kLeaf));
      if (end < 0) return;
      continue;
    }
    const Node& node = nodes_[entry.child];
    std::array<double, kWide> near{};
    std::array<bool, kWide> met{};
    for (std::size_t i = 0; i < kWide; ++i) {
      if (!(node.low[0][i] <= node.high[0][i])) continue;
      // No smaller than the box: padded, and rounding is monotone.
      near[i] = padding_ > kMostPadding
                    ? 0
                    : bound(WorldBox{middle_ + dvec3(node.low[0][i], node.low[1][i], node.low[2][i]),
                                     middle_ + dvec3(node.high[0][i], node.high[1][i], node.high[2][i])});
      met[i] = near[i] <= end;
    }
    push(node, met, near, stack, size);
  }
}

}  // namespace scarp
