// SPDX-License-Identifier: MIT
// Correct answers for maps, at all nodes or at random ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "scarp/analysis/shadow.h"
#include "scarp/analysis/viewshed.h"

namespace scarp::bench {

/// Nodes of a field and their correct answers: visible, or lit.
struct MapTruth {
  std::vector<std::size_t> nodes;  ///< row * columns + column
  std::vector<char> positive;      ///< 0 or 1 for each
};

/// Nodes drawn at random, the same for all maps of a field.
std::vector<scarp::Node> random_nodes(const HeightField& field, std::int64_t count);

/// Returns the number of wrong nodes, on all threads. `is_right` gets the node and its index in a map.
std::int64_t wrong_nodes(const HeightField& field, const std::vector<scarp::Node>& nodes,
                         const std::function<bool(scarp::Node, std::size_t)>& is_right);

/// For up to 2048 x 2048 samples, computes all nodes by a sweep, and compares it with rays at `judged` random nodes.
/// For larger fields, computes this many random nodes by rays. Throws Error if a sweep and a ray differ.
MapTruth viewshed_truth(const Viewpoint& view, std::int64_t judged);
MapTruth shadow_truth(const HeightField& field, const SunDirection& sun, std::int64_t judged);

}  // namespace scarp::bench
