// SPDX-License-Identifier: MIT
// Rays and hits as arrays of floats, batches on a caller's threads, heights of many points: the answers of single
// queries.
#include "scarp/scene/ray_arrays.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "base/refusal.h"
#include "march/height/spiteful.h"
#include "scarp/base/executor.h"
#include "scarp/base/two_floats.h"
#include "scarp/field/ground_points.h"
#include "scarp/scarp.h"

namespace scarp::test {
namespace {

struct Rays {
  std::vector<float> ox, oy, oz, dx, dy, dz, t_min, t_max;
  std::vector<std::int32_t> col, row;
  std::vector<std::uint32_t> object;
  std::vector<Ray> same;

  explicit Rays(int count) {
    Random random(4);
    for (int i = 0; i < count; ++i) {
      Ray ray;
      const auto number = [&](double low, double high) { return as_float(uniform(random, low, high)); };
      ray.origin = {number(0, 60), number(0, 60), number(-2, 40)};
      ray.direction = {number(-1, 1), number(-1, 1), number(-1, 0.2)};
      ray.t_min = number(0, 2), ray.t_max = i % 3 ? std::numeric_limits<double>::infinity() : number(5, 30);
      if (i % 5 == 0) {
        ray.start = RayStart::on_surface;
        ray.start_cell = {static_cast<int>(ray.at(ray.t_min).x), 64 - static_cast<int>(std::ceil(ray.at(ray.t_min).y))};
        if (ray.start_cell.col < 0 || ray.start_cell.col > 63 || ray.start_cell.row < 0 || ray.start_cell.row > 63)
          ray.start = RayStart::free;
      }
      const bool free = ray.start == RayStart::free;
      if (free) ray.start_cell = {};
      const auto add = [](std::vector<float>& to, double value) { to.push_back(static_cast<float>(value)); };
      add(ox, ray.origin.x), add(oy, ray.origin.y), add(oz, ray.origin.z);
      add(dx, ray.direction.x), add(dy, ray.direction.y), add(dz, ray.direction.z);
      add(t_min, ray.t_min), add(t_max, ray.t_max);
      col.push_back(ray.start_cell.col), row.push_back(ray.start_cell.row), object.push_back(0);
      same.push_back(ray);
    }
  }
  RayArrays arrays() const { return {ox, oy, oz, dx, dy, dz, t_min, t_max, col, row, object}; }
};

Scene ground() {
  return combine({{Terrain(hills(65, 65, Surface::bilinear))},
                  {scene_shape(DistanceField(make_shape(shape::Sphere{4}))), {.origin = {20, 20, 12}}}});
}

TEST(RayArrays, MatchSingleRays) {
  const Rays rays(100'000);
  const Scene scene = ground();
  const std::size_t count = rays.same.size();
  std::vector<float> t(count), u(count), v(count), nx(count), ny(count), nz(count);
  std::vector<HitStatus> status(count);
  std::vector<std::uint32_t> object(count), part(count);
  std::vector<std::int32_t> col(count), row(count);
  std::vector<std::uint8_t> blocked(count);
  cast(scene, rays.arrays(), {t, status, object, part, col, row, u, v, nx, ny, nz});
  occluded(scene, rays.arrays(), blocked);
  int hits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Hit hit = cast(scene, rays.same[i]);
    hits += static_cast<bool>(hit);
    ASSERT_EQ(t[i], static_cast<float>(hit.t)) << i;
    ASSERT_EQ(status[i], hit.status);
    ASSERT_EQ(object[i], hit.object);
    ASSERT_EQ((Cell{col[i], row[i]}), hit.cell);
    ASSERT_EQ(u[i], static_cast<float>(hit.u));
    ASSERT_EQ(v[i], static_cast<float>(hit.v));
    const dvec3 normal = hit ? scene.surface(rays.same[i], hit).normal : dvec3(0.0);
    ASSERT_EQ(nx[i], static_cast<float>(normal.x));
    ASSERT_EQ(nz[i], static_cast<float>(normal.z));
    ASSERT_EQ(blocked[i], occluded(scene, rays.same[i]));
  }
  EXPECT_GT(hits, 30'000);
}

TEST(RayArrays, RejectSpansOfWrongSize) {
  const Rays rays(100);
  const Scene scene = ground();
  std::vector<float> t(100), few(99);
  std::vector<std::uint8_t> blocked(99);
  RayArrays arrays = rays.arrays();
  EXPECT_EQ(refusal([&] { cast(scene, arrays, {.t = few}); }), "batch: 100 rays by origin_x, but 99 values of t");
  EXPECT_EQ(refusal([&] { occluded(scene, arrays, blocked); }),
            "batch: 100 rays by origin_x, but 99 values of blocked");
  EXPECT_EQ(refusal([&] { cast(scene, arrays, {.normal_x = t}); }),
            "batch: normal_x, normal_y and normal_z are given together or not at all");
  arrays.start_row = {};
  EXPECT_EQ(refusal([&] { cast(scene, arrays, {.t = t}); }),
            "batch: start_col and start_row are given together or not at all");
  arrays = rays.arrays();
  arrays.direction_y = {};
  EXPECT_EQ(refusal([&] { cast(scene, arrays, {.t = t}); }),
            "batch: 100 rays by origin_x, but 0 values of direction_y");
  Rays bad(70'000);
  bad.ox[69'000] = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> many(70'000);
  EXPECT_EQ(refusal([&] { cast(scene, bad.arrays(), {.t = many}); }), "ray 69000 of 70000: its origin is not finite");
}

// An engine's threads.
class Pool final : public Executor {
 public:
  void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
    ++runs;
    std::atomic<std::int64_t> next{0};
    const auto work = [&] {
      for (std::int64_t i = next++; i < pieces; i = next++) piece(i);
    };
    std::thread one(work), two(work);
    one.join();
    two.join();
  }
  std::atomic<int> runs{0};
};

TEST(Executor, BatchesMatchOnCallerThreads) {
  const Rays rays(20'000);
  for (const Scene& scene : {ground(), Scene(Terrain(hills(65, 65, Surface::triangles)))}) {
    std::vector<Hit> expected(rays.same.size()), hits(rays.same.size());
    std::vector<std::uint8_t> blocked(rays.same.size()), expected_blocked(rays.same.size());
    cast(scene, rays.same, expected);
    occluded(scene, rays.same, expected_blocked);
    Pool pool;
    for (Executor* executor : {static_cast<Executor*>(&pool), &caller_thread()}) {
      const ExecutorScope scope(*executor);
      std::fill(hits.begin(), hits.end(), Hit{});
      cast(scene, rays.same, hits);
      occluded(scene, rays.same, blocked);
      EXPECT_EQ(hits, expected);
      EXPECT_EQ(blocked, expected_blocked);
    }
    EXPECT_GT(pool.runs, 0);
  }
}

TEST(HeightsAt, MatchSinglePoints) {
  Random random(7);
  const HeightField plain = hills(65, 65, Surface::bilinear);
  std::vector<float> samples(65 * 65);
  for (float& sample : samples)
    sample = uniform(random, 0, 1) < 0.05 ? std::numeric_limits<float>::quiet_NaN()
                                          : static_cast<float>(uniform(random, 0, 9));
  for (const HeightField& field :
       {plain, HeightField::own(samples, 65, 65, {.cell_x = 2, .cell_y = 0.5, .surface = Surface::triangles})}) {
    std::vector<double> xs, ys;
    for (int i = 0; i < 20'000; ++i) {
      xs.push_back(uniform(random, -1, field.width() + 1)), ys.push_back(uniform(random, -1, field.depth() + 1));
      if (i % 4 == 0)
        xs.back() = whole(random, 0, 64) * field.settings().cell_x,
        ys.back() = whole(random, 0, 64) * field.settings().cell_y;
    }
    std::vector<double> heights(xs.size()), of_scene(xs.size());
    std::vector<dvec3> normals(xs.size());
    heights_at(field, xs, ys, heights, normals);
    heights_at(Terrain(field), xs, ys, of_scene);
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const auto height = field.height(xs[i], ys[i]);
      ASSERT_EQ(height.has_value(), !std::isnan(heights[i]));
      ASSERT_EQ(height.has_value(), !std::isnan(of_scene[i]));
      if (!height) {
        EXPECT_EQ(normals[i], dvec3(0.0));
        continue;
      }
      EXPECT_EQ(heights[i], *height);
      EXPECT_EQ(of_scene[i], *height);
      const auto gradient = field.gradient(xs[i], ys[i]);
      if (gradient) {
        EXPECT_LT(glm::length(normals[i] - glm::normalize(dvec3(-gradient->x, -gradient->y, 1))), 1e-12);
      }
    }
    EXPECT_NE(refusal([&] { heights_at(field, xs, ys, std::span(heights).subspan(1)); }), "");
    EXPECT_NE(refusal([&] { heights_at(field, xs, ys, heights, std::span(normals).subspan(1)); }), "");
    EXPECT_NE(refusal([&] { heights_at(Terrain(field), xs, std::span(ys).subspan(1), heights); }), "");
  }
}

}  // namespace
}  // namespace scarp::test
