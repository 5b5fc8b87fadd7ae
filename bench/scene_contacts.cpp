// SPDX-License-Identifier: MIT
#include "bench/scene_contacts.h"

#include <glm/geometric.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "bench/protocol.h"
#include "bench/random.h"
#include "scarp/scene/scene_query.h"

namespace scarp::bench {
namespace {

struct Place {
  Capsule sphere;
  dvec3 motion;
};

SceneFieldPtr voxel_ball() {
  VoxelGrid grid({8, 8, 8});
  grid.fill_sphere(dvec3(4), 4, 1);
  return scene_voxels(
      {.models = {std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"))},
       .places = {{0, glm::dmat3(0.25), dvec3(0)}}});
}

SceneFieldPtr hills() {
  Random random(4, 0);
  std::vector<float> samples(81);
  for (float& sample : samples) sample = static_cast<float>(random.uniform(0, 1));
  return scene_heights(HeightField::own(std::move(samples), 9, 9, {.cell_x = 0.25, .cell_y = 0.25}));
}

// Microseconds of processor time per query, the median pass.
template <class Query>
double time_each(const std::vector<Place>& places, int repeats, const Query& query) {
  std::vector<double> us;
  for (int pass = 0; pass < repeats; ++pass) {
    const Stopwatch watch;
    for (const Place& place : places) query(place);
    us.push_back(1e6 * watch.cpu_s() / static_cast<double>(places.size()));
  }
  return median(us);
}

}  // namespace

nlohmann::ordered_json measure_contacts(const std::vector<SceneObject>& objects, double side, int queries,
                                        int repeats) {
  const Scene scene({voxel_ball(), hills()}, objects);
  const SceneQuery query = scene.query({});
  Random random(5, 0);
  std::vector<Place> places;
  for (int i = 0; i < queries; ++i) {
    const auto inside = [&](double low, double high) {
      return dvec3(random.uniform(low, high), random.uniform(low, high), random.uniform(low, high));
    };
    const dvec3 at = inside(0, side);
    places.push_back({{at, at, 0.25}, normalize(inside(-1, 1))});
  }
  std::int64_t touched = 0, met = 0;
  for (const Place& place : places) {
    touched += query.sweep(place.sphere, place.motion).has_value();
    met += query.overlaps({place.sphere.a, dvec3(0.5)});
  }
  nlohmann::ordered_json row;
  row["contact_queries"] = queries;
  row["sweep_us"] = time_each(places, repeats,
                              [&](const Place& place) { return query.sweep(place.sphere, place.motion).has_value(); });
  row["sweeps_touch"] = touched;
  row["overlap_us"] = time_each(places, repeats, [&](const Place& place) {
    return query.overlaps({place.sphere.a, dvec3(0.5)});
  });
  row["boxes_overlap"] = met;
  row["closest_us"] =
      time_each(places, repeats, [&](const Place& place) { return query.closest_point(place.sphere.a)->distance; });
  return row;
}

}  // namespace scarp::bench
