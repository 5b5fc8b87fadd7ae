// SPDX-License-Identifier: MIT
#include "scarp/scene/tree/box_tree.h"

#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "scarp/scene/tree/box_beam.h"

namespace scarp {
namespace {

constexpr int kBins = 16;
constexpr int kUnbalanced = 32;  // levels after which ranges are halved

// Rounding in float from a coordinate to a difference: less than 4 units of 2^-24 of the largest coordinate.
constexpr double kPadding = 0x1p-21;

// The rays of a beam share their longest axis, along which their speeds are similar; slopes are limited to this.
constexpr double kSteepestOfBeam = 4, kWidestBeam = 0.5;

}  // namespace

// Ranges of objects, split until one is left.
struct BoxTree::Builder {
  struct Range {
    std::uint32_t begin, end;
    WorldBox box;

    std::uint32_t count() const { return end - begin; }
  };

  std::span<const WorldBox> boxes;
  std::vector<std::uint32_t> order;
  BoxTree& tree;

  // Halved before they are added, which does not overflow.
  dvec3 centre(std::uint32_t object) const { return 0.5 * boxes[object].low + 0.5 * boxes[object].high; }

  Range range(std::uint32_t begin, std::uint32_t end) const {
    Range range{begin, end, {}};
    for (std::uint32_t i = begin; i < end; ++i) range.box = around(range.box, boxes[order[i]]);
    return range;
  }

  // Returns where to split a range: at the best bin border along the longest side of the box of its centres, or in the
  // middle.
  std::uint32_t split(const Range& whole, int depth) {
    WorldBox centres;
    for (std::uint32_t i = whole.begin; i < whole.end; ++i) {
      const dvec3 c = centre(order[i]);
      centres = around(centres, {c, c});
    }
    const dvec3 size = centres.high - centres.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order.begin() + whole.begin, end = order.begin() + whole.end;
    if (!(size[axis] > 0) || !std::isfinite(kBins * size[axis]) || depth >= kUnbalanced) {
      const std::uint32_t half = whole.begin + whole.count() / 2;
      std::nth_element(begin, order.begin() + half, end,
                       [&](std::uint32_t a, std::uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
      return half;
    }
    const auto bin = [&](std::uint32_t object) {
      return std::min(kBins - 1, static_cast<int>(kBins * (centre(object)[axis] - centres.low[axis]) / size[axis]));
    };
    std::array<WorldBox, kBins> bin_box;
    std::array<std::uint32_t, kBins> bin_count{};
    for (auto i = begin; i != end; ++i) {
      const int b = bin(*i);
      bin_box[b] = around(bin_box[b], boxes[*i]);
      ++bin_count[b];
    }
    // Cost of all bins from b on; then of those before.
    std::array<double, kBins> after{};
    WorldBox box;
    std::uint32_t count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      box = around(box, bin_box[b]);
      count += bin_count[b];
      after[b] = count * half_area(box);
    }
    box = {};
    count = 0;
    int best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (int b = 1; b < kBins; ++b) {
      box = around(box, bin_box[b - 1]);
      count += bin_count[b - 1];
      if (count == 0 || count == whole.count()) continue;
      const double cost = count * half_area(box) + after[b];
      if (cost < least) {
        least = cost;
        best = b;
      }
    }
    const auto middle_of = std::partition(begin, end, [&](std::uint32_t object) { return bin(object) < best; });
    return static_cast<std::uint32_t>(middle_of - order.begin());
  }

  // Builds the node for a range. Its children result from three splits, each of the largest part so far.
  std::uint32_t build(const Range& whole, int depth) {
    std::array<Range, kWide> parts{whole};
    int count = 1;
    while (count < kWide) {
      // The largest part that does not fit in one node; otherwise a part that fits in the remaining slots without its
      // own node.
      int largest = -1;
      const auto free = static_cast<std::uint32_t>(kWide - count);
      for (int i = 0; i < count; ++i) {
        const bool fits = parts[i].count() <= kWide,
                   splits = fits ? parts[i].count() > 1 && parts[i].count() - 1 <= free : true;
        if (!splits) continue;
        const bool before = largest >= 0 && parts[largest].count() <= kWide;
        if (largest < 0 || (before && !fits) ||
            (before == fits && half_area(parts[i].box) > half_area(parts[largest].box)))
          largest = i;
      }
      if (largest < 0) break;
      const Range part = parts[largest];
      const std::uint32_t at = split(part, depth);
      parts[largest] = range(part.begin, at);
      parts[count++] = range(at, part.end);
    }
    const auto index = static_cast<std::uint32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    for (int i = 0; i < kWide; ++i) {
      Node& node = tree.nodes_[index];
      if (i >= count) {
        node.clear(i);
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][i] = tree.rounded_low(parts[i].box, axis);
        node.high[axis][i] = tree.rounded_high(parts[i].box, axis);
      }
      const std::uint32_t child = parts[i].count() == 1 ? kLeaf | order[parts[i].begin] : build(parts[i], depth + 1);
      tree.nodes_[index].child[i] = child;
    }
    return index;
  }
};

BoxTree::BoxTree(std::span<const WorldBox> boxes)
    : BoxTree(boxes, [&] {
        std::vector<std::uint32_t> objects(boxes.size());
        std::iota(objects.begin(), objects.end(), 0u);
        return objects;
      }()) {}

BoxTree::BoxTree(std::span<const WorldBox> boxes, std::vector<std::uint32_t> objects, double reach) {
  if (objects.empty()) return;
  Builder builder{boxes, std::move(objects), *this};
  const auto whole = builder.range(0, static_cast<std::uint32_t>(builder.order.size()));
  box_ = whole.box;
  middle_ = 0.5 * box_.low + 0.5 * box_.high;
  const dvec3 half = box_.high - middle_;
  const double farthest = std::max({half.x, half.y, half.z}), room = (reach - 1) * farthest;
  box_ = {box_.low - room, box_.high + room};
  padding_ = reach * farthest * kPadding;
  nodes_.reserve(builder.order.size() / 2 + 1);
  builder.build(whole, 0);
  nodes_.shrink_to_fit();
}

BoxTree::Parts BoxTree::parts() const {
  static_assert(sizeof(Node) == 112 && kLeaf == 0x80000000);
  std::uint32_t levels = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;  // nodes and their levels
  if (!nodes_.empty()) open.push_back({0, 1});
  while (!open.empty()) {
    const auto [node, level] = open.back();
    open.pop_back();
    levels = std::max(levels, level);
    for (int i = 0; i < kWide; ++i) {
      const Node& at = nodes_[node];
      if (at.low[0][i] <= at.high[0][i] && !(at.child[i] & kLeaf)) open.push_back({at.child[i], level + 1});
    }
  }
  return {std::as_bytes(std::span(nodes_)), middle_, {box_.low - padding_, box_.high + padding_}, levels};
}

bool BoxTree::clip(const Ray& ray, double& t_in, double& t_out) const {
  t_in = ray.t_min, t_out = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double direction = ray.direction[axis], low = box_.low[axis] - padding_, high = box_.high[axis] + padding_;
    if (direction == 0) {
      if (ray.origin[axis] < low || ray.origin[axis] > high) return false;
      continue;
    }
    const double inverse = 1 / direction, a = (low - ray.origin[axis]) * inverse,
                 b = (high - ray.origin[axis]) * inverse;
    t_in = std::max(t_in, std::min(a, b));
    t_out = std::min(t_out, std::max(a, b));
  }
  // The box is padded, so a ray that misses it because of rounding touches nothing.
  return t_in <= t_out;
}

float BoxTree::Beam::end_of(std::span<const double> t_max) const {
  double last = -1;
  for (std::size_t i = 0; i < t_max.size(); ++i) {
    const double here = (t_max[i] - start[i]) * per_t[i];
    last = per_t[i] > 0 && here > last ? here : last;
  }
  return static_cast<float>(last) * kRounding;
}

std::optional<BoxTree::Beam> BoxTree::beam(const Rays& rays) const {
  Beam beam;
  if (nodes_.empty() || rays.count == 0) return beam;
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(rays.direction[axis][0]) > std::abs(rays.direction[longest][0])) longest = axis;
  }
  const double sign = rays.direction[longest][0] < 0 ? -1 : 1;
  BeamBounds bounds;
  beam.inside = bound_beam(rays, {box_.low - padding_, box_.high + padding_}, middle_, longest, sign, beam.start.data(),
                           beam.per_t.data(), bounds);
  if (beam.inside == 0) return beam;
  if (!(bounds.slowest > 0)) return {};
  beam.end = static_cast<float>(bounds.last) * kRounding;
  for (int i = 0; i < 3; ++i) {
    const double flat = bounds.least[i], steep = bounds.most[i];
    if (!(steep - flat <= kWidestBeam && steep <= kSteepestOfBeam && flat >= -kSteepestOfBeam)) return {};
    Beam::Axis& axis = beam.axes[i];
    axis.low = static_cast<float>(bounds.low[i]), axis.high = static_cast<float>(bounds.high[i]);
    // Rays too flat to be distinguished from level ones count as both.
    const auto per = [](double slope) { return slope * kSteepest < 1 ? kSteepest : static_cast<float>(1 / slope); };
    axis.per_up = per(steep), axis.per_down = per(-flat);
    const double flattest = std::max(flat, -steep);
    axis.way = flattest * kSteepest < 1 ? Beam::Way::both : flat > 0 ? Beam::Way::up : Beam::Way::down;
    axis.per_least = per(flattest) * kRounding;
  }
  return beam;
}

}  // namespace scarp
