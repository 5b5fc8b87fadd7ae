// SPDX-License-Identifier: MIT
// Batches return the answers of single rays, on all threads; and errors for invalid rays.
#include "scarp/march/height/queries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/march/height/ground_order.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::test {
namespace {

// Bit for bit; for directions of extreme length, the t of exhaustive is NaN.
bool identical(const Hit& a, const Hit& b) {
  const auto same = [](double x, double y) { return x == y || (x != x && y != y); };
  return same(a.t, b.t) && a.cell == b.cell && same(a.u, b.u) && same(a.v, b.v) && same(a.height, b.height);
}

#ifdef NDEBUG
constexpr int kRaysPerPair = 60;
#else
constexpr int kRaysPerPair = 15;
#endif

TEST(Queries, BatchMatchesSingleRays) {
  Random random(5);
  for (const FieldKind& fields : spiteful_fields()) {
    const HeightField field = fields.make(random);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid, slope_bound(field)};
    std::vector<Ray> rays;
    for (int i = 0; i < kRaysPerPair; ++i) {
      for (const RayKind& kind : spiteful_rays()) rays.push_back(kind.make(field, random));
    }
    for (const HeightMarchEntry& march : height_marches()) {
      if (!takes(march.fields, field)) continue;
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> blocked(rays.size(), 7);
      closest_hits(target, rays, hits, march);
      occluded(target, rays, blocked, march);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit one = march.cpu(target, rays[i], {}, nullptr);
        ASSERT_EQ(hits[i].status, one.status) << march.name << " on " << fields.name << ", ray " << i;
        ASSERT_EQ(blocked[i], one.status == HitStatus::hit ? 1 : 0)
            << march.name << " on " << fields.name << ", ray " << i;
        ASSERT_TRUE(!one || identical(hits[i], one)) << march.name << " on " << fields.name << ", ray " << i;
      }
    }
  }
}

TEST(Queries, RejectSpansOfDifferentLengths) {
  const HeightField field = HeightField::own<float>({1, 2, 3, 4}, 2, 2);
  const MaxPyramid pyramid(field);
  const std::vector<Ray> rays(3);
  std::vector<Hit> hits(2);
  std::vector<std::uint8_t> blocked(4);
  EXPECT_THROW(closest_hits({&field, &pyramid}, rays, hits), Error);
  EXPECT_THROW(occluded({&field, &pyramid}, rays, blocked), Error);
}

TEST(Queries, ValidateCallerRays) {
  const float hole = std::numeric_limits<float>::quiet_NaN();
  const HeightField field = HeightField::own<float>({1, 2, hole, 3, 4, 5}, 3, 2);
  const HeightField wrapped = HeightField::own<float>({1, 2, 3, 4}, 2, 2, {.wrap = Wrap::periodic});
  const auto refused = [](const HeightField& over, auto change) {
    Ray ray;
    change(ray);
    try {
      validate(ray, over);
    } catch (const Error& error) {
      return std::string(error.what()).find('\n') == std::string::npos;
    }
    return false;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(refused(field, [](Ray&) {}));
  EXPECT_TRUE(refused(field, [](Ray& ray) { ray.origin.y = kNaN; }));
  EXPECT_TRUE(refused(field, [](Ray& ray) { ray.direction.x = kInfinity; }));
  EXPECT_TRUE(refused(field, [](Ray& ray) { ray.direction = dvec3(0.0); }));
  EXPECT_TRUE(refused(field, [](Ray& ray) { ray.t_min = -kInfinity; }));
  EXPECT_TRUE(refused(field, [](Ray& ray) { ray.t_max = -1; }));
  EXPECT_TRUE(refused(wrapped, [](Ray&) {}));
  EXPECT_FALSE(refused(wrapped, [](Ray& ray) { ray.t_max = 9; }));
  const auto from = [](int col) {
    return [col](Ray& ray) { ray.start = RayStart::on_surface, ray.start_cell = {col, 0}; };
  };
  EXPECT_FALSE(refused(field, from(0)));
  EXPECT_TRUE(refused(field, from(1)));
  EXPECT_TRUE(refused(field, from(2)));
}

TEST(Queries, AnyHitLooksAheadAndAgreesWithClosestHit) {
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const HeightField field = hills(1025, 769, surface);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    Random random(31);
    int hits = 0, far = 0;
    for (int i = 0; i < 50'000; ++i) {
      Ray ray = along_hills(field, random, i % 2);
      // Some rays end just in front of their hit, or just behind it.
      const Hit first = march_max_mip(target, ray);
      if (first && i % 3 == 0) ray.t_max = first.t * uniform(random, 0.98, 1.02);
      const Hit hit = march_max_mip(target, ray);
      ASSERT_EQ(occluded_max_mip(target, ray), hit.status == HitStatus::hit) << "ray " << i;
      hits += bool(hit);
      far += hit && hit.t > 128;
    }
    EXPECT_GT(hits, 20'000);
    EXPECT_GT(far, 2'000);
  }
}

// A field larger than any cache: large batches over it are reordered.
HeightField large() {
  const int cols = 4200, rows = 2100;
  std::vector<std::int16_t> samples;
  samples.reserve(static_cast<std::size_t>(cols) * rows);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) samples.push_back(static_cast<std::int16_t>((col * 7919 + row * 104729) % 97));
  }
  return HeightField::own(std::move(samples), cols, rows);
}

std::vector<Ray> anywhere(const HeightField& field, std::size_t count, Random& random) {
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = {uniform(random, 0, field.width()), uniform(random, 0, field.depth()), uniform(random, 50, 300)};
    ray.direction = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 0.2)};
  }
  return rays;
}

TEST(Queries, AnswersKeepTheOrderOfTheRays) {
  const HeightField field = large();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  Random random(23);
  const std::vector<Ray> rays = anywhere(field, 20000, random);

  std::vector<std::uint32_t> order = ground_order(field, rays);
  ASSERT_EQ(order.size(), rays.size());
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  closest_hits(target, rays, hits);
  occluded(target, rays, blocked);
  int found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = march_max_mip(target, rays[i]);
    found += bool(hit);
    ASSERT_EQ(hits[i].status, hit.status);
    ASSERT_EQ(hits[i].t, hit.t);
    ASSERT_EQ(blocked[i] != 0, bool(hit));
  }
  EXPECT_GT(found, 5000);

  // The order contains each ray once, and is a fixed point of the sort.
  std::vector<Ray> ordered;
  for (const std::uint32_t i : order) ordered.push_back(rays[i]);
  EXPECT_TRUE(ground_order(field, ordered).empty());
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

TEST(Queries, DoNotReorderSmallBatches) {
  const HeightField field = large();
  Random random(24);
  EXPECT_TRUE(ground_order(field, anywhere(field, 100, random)).empty());
  const HeightField small = HeightField::own(std::vector<float>(10000, 0.f), 100, 100);
  EXPECT_TRUE(ground_order(small, anywhere(small, 20000, random)).empty());
}

}  // namespace
}  // namespace scarp::test
