// SPDX-License-Identifier: MIT
// Batches answer as single rays do, on all threads; and what rays from outside are refused for.
#include "scarp/march/queries.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "march/spiteful.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

// Bit for bit; exhaustive has no t, NaN, for directions of extreme length.
bool identical(const Hit& a, const Hit& b) {
  const auto same = [](double x, double y) { return x == y || (x != x && y != y); };
  return same(a.t, b.t) && a.cell == b.cell && same(a.u, b.u) && same(a.v, b.v) && same(a.height, b.height);
}

TEST(Queries, ABatchAnswersAsItsRaysDo) {
  Random random(5);
  for (const FieldKind& fields : spiteful_fields()) {
    const HeightField field = fields.make(random);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid, slope_bound(field)};
    std::vector<Ray> rays;
    for (int i = 0; i < 60; ++i) {
      for (const RayKind& kind : spiteful_rays()) rays.push_back(kind.make(field, random));
    }
    for (const MarchEntry& march : marches()) {
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

TEST(Queries, SpansOfOneLengthAreAskedFor) {
  const HeightField field = HeightField::own<float>({1, 2, 3, 4}, 2, 2);
  const MaxPyramid pyramid(field);
  const std::vector<Ray> rays(3);
  std::vector<Hit> hits(2);
  std::vector<std::uint8_t> blocked(4);
  EXPECT_THROW(closest_hits({&field, &pyramid}, rays, hits), Error);
  EXPECT_THROW(occluded({&field, &pyramid}, rays, blocked), Error);
}

TEST(Queries, RaysFromOutsideAreChecked) {
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

}  // namespace
}  // namespace scarp::test
