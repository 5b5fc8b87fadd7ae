// SPDX-License-Identifier: MIT
#include "scarp/scene/mesh/mesh_inside.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace scarp {
namespace {

using Edge = std::pair<vec3, vec3>;

bool before(const vec3& a, const vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

Edge in_order(const vec3& a, const vec3& b) { return before(b, a) ? Edge{b, a} : Edge{a, b}; }

// Whether the edge passes east of the point.
bool is_east(const vec3& a, const vec3& b, const dvec3& p) {
  const auto [from, to] = in_order(a, b);
  const dvec3 f(from), t(to);
  if ((f.y > p.y) == (t.y > p.y)) return false;
  return p.x < f.x + (p.y - f.y) / (t.y - f.y) * (t.x - f.x);
}

// The height of the triangle's plane above (p.x, p.y), limited to the heights of its corners.
double height(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& p) {
  const dvec3 n = cross(b - a, c - a);
  const double low = std::min({a.z, b.z, c.z}), high = std::max({a.z, b.z, c.z});
  if (n.z == 0) return low;
  return std::clamp(a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z, low, high);
}

}  // namespace

MeshEdges count_edges(std::span<const vec3> corners) {
  std::vector<Edge> edges;
  edges.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    edges.push_back(in_order(corners[i], corners[i % 3 == 2 ? i - 2 : i + 1]));
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return before(a.first, b.first) || (a.first == b.first && before(a.second, b.second));
  });
  MeshEdges count;
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [&](const Edge& edge) { return edge != *begin; });
    ++count.all;
    count.open += (end - begin) % 2 != 0;
    begin = end;
  }
  return count;
}

MeshInside::MeshInside(std::span<const vec3> corners) : corners_(corners), closed_(count_edges(corners).open == 0) {
  if (!closed_) return;
  std::vector<WorldBox> boxes;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const dvec3 a(corners[i]), b(corners[i + 1]), c(corners[i + 2]);
    boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
  }
  tree_ = BoxTree(boxes);
}

std::optional<std::uint32_t> MeshInside::above(const dvec3& p) const {
  if (!closed_) return {};
  Ray up;
  up.origin = p, up.direction = {0, 0, 1};
  bool inside = false;
  std::uint32_t nearest = 0;
  double lowest = std::numeric_limits<double>::infinity();
  tree_.traverse(up, [&](std::uint32_t triangle) {
    const vec3 *a = &corners_[3 * std::size_t{triangle}], *b = a + 1, *c = a + 2;
    if ((is_east(*a, *b, p) != is_east(*b, *c, p)) != is_east(*c, *a, p)) {
      const double z = height(dvec3(*a), dvec3(*b), dvec3(*c), p);
      if (z >= p.z) {
        inside = !inside;
        if (z < lowest) lowest = z, nearest = triangle;
      }
    }
    return up.t_max;
  });
  return inside ? std::optional(nearest) : std::nullopt;
}

}  // namespace scarp
