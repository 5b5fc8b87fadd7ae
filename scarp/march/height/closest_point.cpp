// SPDX-License-Identifier: MIT
#include "scarp/march/height/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/world_box.h"

namespace scarp {
namespace {

// A bilinear cell is split until two triangles are within half of this of it, as a share of the shorter side of a cell.
constexpr double kFlat = 0x1p-20;

double square(double x) { return x * x; }

// Ericson, 5.1.5: by the region of the triangle's plane in which p is.
dvec3 closest_of_triangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const dvec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const dvec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

// What is still to be looked at: a block of a level, or a part of a cell.
struct Node {
  double bound;  // nothing in it is closer
  int level;     // 0: a part of the cell (col, row)
  int col, row;
  double u, v, side;  // the part: u..u+side, v..v+side
};

class Search {
 public:
  Search(const HeightTarget& target, const dvec3& p, double max_distance)
      : field_(*target.field),
        pyramid_(*target.pyramid),
        p_(p),
        best_(max_distance),
        cell_x_(field_.settings().cell_x),
        cell_y_(field_.settings().cell_y) {}

  std::optional<ClosestPoint> run() {
    push_block(pyramid_.top_level(), 0, 0);
    while (!nodes_.empty()) {
      std::pop_heap(nodes_.begin(), nodes_.end(), farther);
      const Node node = nodes_.back();
      nodes_.pop_back();
      if (node.bound > best_ || (found_ && node.bound == best_)) break;
      if (node.level > 0) {
        for (int i = 0; i < 4; ++i) push_block(node.level - 1, 2 * node.col + i % 2, 2 * node.row + i / 2);
      } else {
        open(node);
      }
    }
    if (!found_) return {};
    answer_.distance = best_;
    answer_.normal = field_.normal(answer_.cell, answer_.u, answer_.v);
    return answer_;
  }

 private:
  static bool farther(const Node& a, const Node& b) { return a.bound > b.bound; }

  void push(const Node& node) {
    if (node.bound > best_) return;
    nodes_.push_back(node);
    std::push_heap(nodes_.begin(), nodes_.end(), farther);
  }

  void push_block(int level, int col, int row) {
    const int first_col = col << level, first_row = row << level;
    if (first_col >= field_.cell_cols() || first_row >= field_.cell_rows()) return;
    if (level == 0) {
      if (const auto h = field_.cell_heights({col, row})) push_part(*h, col, row, 0, 0, 1);
      return;
    }
    const int last_col = std::min(first_col + (1 << level), field_.cell_cols()),
              last_row = std::min(first_row + (1 << level), field_.cell_rows());
    const double low = std::max(pyramid_.minimum(level, col, row), field_.min_sample());
    const WorldBox box{world(first_col, last_row, low),
                       world(last_col, first_row, std::max(low, pyramid_.maximum(level, col, row)))};
    push({distance(box), level, col, row, 0, 0, 0});
  }

  void push_part(const CellHeights& h, int col, int row, double u, double v, double side) {
    const auto [z00, z10, z01, z11] = corners(h, u, v, side);
    const WorldBox box{world(col + u, row + v + side, std::min({z00, z10, z01, z11})),
                       world(col + u + side, row + v, std::max({z00, z10, z01, z11}))};
    push({distance(box), 0, col, row, u, v, side});
  }

  // Compares the triangles of a part with the best point; splits the part where it is not as flat as they are.
  void open(const Node& node) {
    const CellHeights h = field_.cell_heights({node.col, node.row}).value();
    const auto [z00, z10, z01, z11] = corners(h, node.u, node.v, node.side);
    const double col = node.col + node.u, row = node.row + node.v, side = node.side;
    const dvec3 nw = world(col, row, z00), ne = world(col + side, row, z10), sw = world(col, row + side, z01),
                se = world(col + side, row + side, z11);
    const bool bilinear = field_.settings().surface == Surface::bilinear;
    // In the middle of the diagonal, where two triangles are farthest from the patch.
    const double off = bilinear ? 0.25 * std::abs(nw.z + se.z - ne.z - sw.z) : 0;
    // Both the point that is found and the closest one are within that of the triangles.
    const bool flat = 2 * off <= kFlat * std::min(cell_x_, cell_y_);
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : {std::array{nw, sw, ne}, std::array{se, ne, sw}}) {
      const dvec3 q = closest_of_triangle(p_, a, b, c);
      nearest = std::min(nearest, length(q - p_));
      const double u = std::clamp(q.x / cell_x_ - node.col, 0.0, 1.0),
                   v = std::clamp(field_.rows() - 1 - q.y / cell_y_ - node.row, 0.0, 1.0);
      // On the patch itself, above or below the triangle.
      take(bilinear ? world(node.col + u, node.row + v, height_in_cell(Surface::bilinear, h, u, v)) : q, node, u, v);
    }
    if (flat || nearest - off > best_) return;
    for (int i = 0; i < 4; ++i)
      push_part(h, node.col, node.row, node.u + i % 2 * 0.5 * side, node.v + i / 2 * 0.5 * side, 0.5 * side);
  }

  void take(const dvec3& q, const Node& node, double u, double v) {
    const double away = length(q - p_);
    if (!(away < best_ || (!found_ && away <= best_))) return;
    best_ = away;
    found_ = true;
    answer_ = {.point = q, .cell = {node.col, node.row}, .u = u, .v = v};
  }

  // Samples at the corners of a part.
  static CellHeights corners(const CellHeights& h, double u, double v, double side) {
    const auto at = [&](double x, double y) { return height_in_cell(Surface::bilinear, h, x, y); };
    return {at(u, v), at(u + side, v), at(u, v + side), at(u + side, v + side)};
  }
  dvec3 world(double col, double row, double sample) const { return field_.world_from_grid(col, row, sample); }
  double distance(const WorldBox& box) const {
    return std::sqrt(square(std::max({box.low.x - p_.x, p_.x - box.high.x, 0.0})) +
                     square(std::max({box.low.y - p_.y, p_.y - box.high.y, 0.0})) +
                     square(std::max({box.low.z - p_.z, p_.z - box.high.z, 0.0})));
  }

  const HeightField& field_;
  const MaxPyramid& pyramid_;
  dvec3 p_;
  double best_;
  double cell_x_, cell_y_;
  bool found_ = false;
  ClosestPoint answer_;
  std::vector<Node> nodes_;  // a heap, the nearest on top
};

}  // namespace

std::optional<ClosestPoint> closest_point(const HeightTarget& target, const dvec3& p, double max_distance) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  if (field.wraps()) throw Error("closest point: the field wraps round (ask a field without wrap)");
  if (!field.has_cells() || field.all_nodata() || !(max_distance >= 0)) return {};
  return Search(target, p, max_distance).run();
}

}  // namespace scarp
