// SPDX-License-Identifier: MIT
#include "bench/map_truth.h"

#include <fmt/format.h>

#include <atomic>
#include <numeric>

#include "bench/random.h"
#include "scarp/analysis/sight_rays.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

constexpr std::size_t kAllUpTo = std::size_t{2048} * 2048;
constexpr std::int64_t kGrain = 64;  // rays

std::size_t index_of(const HeightField& field, scarp::Node node) {
  return static_cast<std::size_t>(node.row) * static_cast<std::size_t>(field.cols()) +
         static_cast<std::size_t>(node.col);
}

// `sweep` returns whether each node is positive; `ray` returns this for one node.
template <class Sweep, class Ray>
MapTruth truth(const HeightField& field, std::int64_t judged, const Sweep& sweep, const Ray& ray) {
  const auto sample = random_nodes(field, judged);
  MapTruth truth;
  const std::size_t count = index_of(field, {0, field.rows()});
  if (count <= kAllUpTo) {
    truth.positive = sweep();
    truth.nodes.resize(count);
    std::iota(truth.nodes.begin(), truth.nodes.end(), std::size_t{0});
    const auto wrong =
        wrong_nodes(field, sample, [&](scarp::Node node, std::size_t i) { return truth.positive[i] == ray(node); });
    if (wrong > 0) throw Error(fmt::format("maps: {} of {} nodes differ from their rays", wrong, judged));
    return truth;
  }
  truth.positive.resize(sample.size());
  for (const scarp::Node node : sample) truth.nodes.push_back(index_of(field, node));
  parallel_for(judged, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      truth.positive[i] = ray(sample[i]);
  });
  return truth;
}

}  // namespace

std::vector<scarp::Node> random_nodes(const HeightField& field, std::int64_t count) {
  Random random(1, 0);
  std::vector<scarp::Node> nodes;
  for (std::int64_t n = 0; n < count; ++n) {
    const int col = random.below(field.cols());
    nodes.push_back({col, random.below(field.rows())});
  }
  return nodes;
}

std::int64_t wrong_nodes(const HeightField& field, const std::vector<scarp::Node>& nodes,
                         const std::function<bool(scarp::Node, std::size_t)>& is_right) {
  std::atomic<std::int64_t> wrong = 0;
  parallel_for(static_cast<std::int64_t>(nodes.size()), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      wrong += !is_right(nodes[i], index_of(field, nodes[i]));
  });
  return wrong;
}

MapTruth viewshed_truth(const Viewpoint& view, std::int64_t judged) {
  return truth(
      view.ground().field(), judged,
      [&] {
        std::vector<char> visible;
        for (const Seen code : viewshed(view.ground().field(), view.observer(), view.settings()))
          visible.push_back(code == Seen::visible);
        return visible;
      },
      [&](scarp::Node node) {
        const auto lowered = view.ground().lowered(node);
        return lowered && sees(view.ground(), view.observer(), view.eye(), node, view.target(*lowered));
      });
}

MapTruth shadow_truth(const HeightField& field, const SunDirection& sun, std::int64_t judged) {
  const SightGround ground(field);
  const SunRay ray = sun_ray(field, sun);
  return truth(
      field, judged,
      [&] {
        std::vector<char> lit;
        for (const Shade code : shadow(field, sun)) lit.push_back(code == Shade::lit);
        return lit;
      },
      [&](scarp::Node node) { return shade(ground, ray, node) == Shade::lit; });
}

}  // namespace scarp::bench
