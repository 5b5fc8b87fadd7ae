// SPDX-License-Identifier: MIT
// A character, modelled as an upright capsule, walks over terrain and slides along a tower: each step is a sweep,
// followed by another along the surface that it touched.
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

#include "scarp/scarp.h"
#include "scarp/scene/scene_query.h"

namespace {

constexpr int kSide = 65;
constexpr double kRadius = 0.4, kHeight = 1.0, kGap = 0.01;
// In metres: far more than the rounding of doubles in a world of 64 m, far less than is visible.
constexpr double kRounding = 1e-9;

scarp::Scene world() {
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col)
      samples.push_back(static_cast<float>(2 * std::sin(0.2 * col) * std::cos(0.15 * row)));
  }
  const auto ground = scarp::Terrain::own(std::move(samples), kSide, kSide, {.surface = scarp::Surface::triangles});
  auto tower = scarp::VoxelGrid::built(
      {8, 24, 16}, 8, [](const scarp::ivec3&, std::span<std::uint32_t, 64>) { return ~std::uint64_t{0}; });
  const auto model =
      std::make_shared<const scarp::VoxelModel>(std::move(tower), scarp::find_voxel_march("voxel-bricks"));
  return scarp::combine({{ground}, {scarp::scene_voxels({.models = {model}, .places = {{.origin = {28, 16, -4}}}})}});
}

// Moves up to the first contact, then along the touched surface, at most three times. Returns the number of contacts
// with the tower.
int step(const scarp::SceneQuery& query, scarp::Capsule& walker, scarp::dvec3 motion) {
  int towers = 0;
  for (int i = 0; i < 3 && length(motion) > kGap; ++i) {
    const auto contact = query.sweep(walker, motion);
    // Stops slightly before contact, so that the next step does not start in contact.
    const double t = contact ? std::max(0.0, contact->t - kGap / length(motion)) : 1;
    walker.a += t * motion, walker.b += t * motion;
    if (!contact) break;
    towers += contact->object == 1;
    const scarp::dvec3 rest = (1 - t) * motion;
    motion = rest - std::min(0.0, dot(rest, contact->normal)) * contact->normal;
  }
  return towers;
}

}  // namespace

int main() {
  const scarp::Scene scene = world();
  const scarp::SceneQuery query = scene.query({});
  scarp::Capsule walker{{10, 30, 5}, {10, 30, 5 + kHeight}, kRadius};
  int towers = 0, sunk = 0;
  for (int i = 0; i < 500; ++i) {
    towers += step(query, walker, {0.1, 0, 0}) > 0;
    step(query, walker, {0, 0, -0.2});
    const auto closest = query.closest_point(walker.a);
    sunk += closest && closest->distance < kRadius - kRounding;
  }
  std::printf("walked to x = %.1f, y = %.1f; steps along the tower: %s; steps below ground: %d\n", walker.a.x,
              walker.a.y, towers > 10 ? "many" : "few", sunk);
}
