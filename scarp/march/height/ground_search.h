// SPDX-License-Identifier: MIT
// Best-first search of the ground: blocks of the pyramid, then cells, then ever smaller parts of bilinear cells until
// the query knows their result, or two triangles approximate the part.
//
//   query.bound(box)          lower bound of the result (a distance or a time) over the ground in a box, or infinity
//   query.bound(part)         the same for a part, by its triangles and its maximum distance from them
//   query.best()              the best result so far: boxes that cannot improve it are skipped
//   query.compare(part, flat) examines a part, if it is `flat` by its two triangles; unless it returns true, its
//   quarters
//                             follow
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scarp/accel/max_pyramid.h"
#include "scarp/base/kept_memory.h"
#include "scarp/base/world_box.h"
#include "scarp/march/closest_of.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/height/patch_contact.h"

namespace scarp {

/// A part of a cell that has ground, from (u, v) to (u + side, v + side).
struct GroundPart {
  Cell cell;
  CellHeights heights;  ///< of the cell
  double u, v, side;
  /// The part's two triangles, counter-clockwise from above: north-west, south-east.
  std::array<Triangle, 2> triangles;
  /// Maximum distance in metres between the surface of the part and its triangles.
  double off;

  /// The part of a bilinear cell.
  Patch patch() const {
    const auto& [nw, sw, ne] = triangles[0];
    return {nw, ne - nw, sw - nw, nw.z - ne.z + (triangles[1][0].z - sw.z)};
  }
};

template <class Query>
class GroundSearch {
 public:
  /// A part is flat if twice GroundPart::off is at most this fraction of the shorter side of a cell.
  static constexpr double kFlat = 0x1p-20;

  GroundSearch(const HeightTarget& target, Query& query)
      : field_(*target.field), pyramid_(*target.pyramid), query_(query), flat_(2 * slack(field_)) {}

  /// Maximum error of a bilinear surface, in metres.
  static double slack(const HeightField& field) {
    return 0.5 * kFlat * std::min(field.settings().cell_x, field.settings().cell_y);
  }

  void run() {
    if (!field_.has_cells() || field_.all_nodata()) return;
    push_block(pyramid_.top_level(), 0, 0);
    while (!nodes_.empty()) {
      std::pop_heap(nodes_.begin(), nodes_.end(), later);
      const Node node = nodes_.back();
      nodes_.pop_back();
      if (!(node.bound < query_.best())) break;
      if (node.level > 0) {
        for (int i = 0; i < 4; ++i) push_block(node.level - 1, 2 * node.col + i % 2, 2 * node.row + i / 2);
      } else {
        open(node);
      }
    }
  }

 private:
  // A block of a level; at level 0, a part of a cell.
  struct Node {
    double bound;
    int level;
    int col, row;
    double u, v, side;
  };
  static bool later(const Node& a, const Node& b) { return a.bound > b.bound; }

  void push(const Node& node) {
    if (!(node.bound < query_.best())) return;
    nodes_.push_back(node);
    std::push_heap(nodes_.begin(), nodes_.end(), later);
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
    push({query_.bound(box), level, col, row, 0, 0, 0});
  }

  void push_part(const CellHeights& h, int col, int row, double u, double v, double side) {
    const auto [z00, z10, z01, z11] = corners(h, u, v, side);
    const WorldBox box{world(col + u, row + v + side, std::min({z00, z10, z01, z11})),
                       world(col + u + side, row + v, std::max({z00, z10, z01, z11}))};
    double bound = query_.bound(box);
    if (!(bound < query_.best())) return;
    const GroundPart part = part_at(h, col, row, u, v, side);
    // For a curved part the triangles give a tighter bound than the box: their error is quadratic in its size.
    if (part.off > 0) bound = std::max(bound, query_.bound(part));
    push({bound, 0, col, row, u, v, side});
  }

  void open(const Node& node) {
    const CellHeights h = field_.cell_heights({node.col, node.row}).value();
    const GroundPart part = part_at(h, node.col, node.row, node.u, node.v, node.side);
    if (query_.compare(part, 2 * part.off <= flat_)) return;
    const double half = 0.5 * node.side;
    for (int i = 0; i < 4; ++i) push_part(h, node.col, node.row, node.u + i % 2 * half, node.v + i / 2 * half, half);
  }

  GroundPart part_at(const CellHeights& h, int cell_col, int cell_row, double u, double v, double side) const {
    const auto [z00, z10, z01, z11] = corners(h, u, v, side);
    const double col = cell_col + u, row = cell_row + v;
    const dvec3 nw = world(col, row, z00), ne = world(col + side, row, z10), sw = world(col, row + side, z01),
                se = world(col + side, row + side, z11);
    // Two triangles are farthest from a bilinear patch at the middle of the diagonal.
    const bool bilinear = field_.settings().surface == Surface::bilinear;
    const double off = bilinear ? 0.25 * std::abs(nw.z + se.z - ne.z - sw.z) : 0;
    return {{cell_col, cell_row}, h, u, v, side, {Triangle{nw, sw, ne}, {se, ne, sw}}, off};
  }

  // Samples at the corners of a part.
  static CellHeights corners(const CellHeights& h, double u, double v, double side) {
    const auto at = [&](double x, double y) { return height_in_cell(Surface::bilinear, h, x, y); };
    return {at(u, v), at(u + side, v), at(u, v + side), at(u + side, v + side)};
  }
  dvec3 world(double col, double row, double sample) const { return field_.world_from_grid(col, row, sample); }

  const HeightField& field_;
  const MaxPyramid& pyramid_;
  Query& query_;
  double flat_;
  KeptVector<Node> nodes_;  // a heap with the smallest bound on top
};

}  // namespace scarp
