// SPDX-License-Identifier: MIT
// Batches of one origin are recognised, and answered as single rays are, to the bit.
#include "scarp/march/height/fan_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"

namespace scarp::test {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr double kPi = std::numbers::pi;

Ray ray_along(const dvec3& eye, const dvec3& direction) {
  Ray ray;
  ray.origin = eye, ray.direction = direction;
  return ray;
}

// Options that take a fan wherever it is possible.
FanOptions always_options() {
  FanOptions options;
  options.always = true;
  return options;
}
const FanOptions always = always_options();

// Rows of pixels from above down, of a camera turned by these angles.
std::vector<Ray> camera(const dvec3& eye, double heading, double down, double roll, bool unit) {
  const dvec3 level(std::sin(heading), std::cos(heading), 0), aside(level.y, -level.x, 0);
  const dvec3 forward = std::cos(down) * level - std::sin(down) * dvec3(0, 0, 1);
  const dvec3 up = std::sin(down) * level + std::cos(down) * dvec3(0, 0, 1);
  const dvec3 x = std::cos(roll) * aside + std::sin(roll) * up, y = std::cos(roll) * up - std::sin(roll) * aside;
  std::vector<Ray> rays;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const dvec3 d =
          forward + 2.0 / kWidth * (col + 0.5 - kWidth / 2) * x - 2.0 / kWidth * (row + 0.5 - kHeight / 2) * y;
      rays.push_back(ray_along(eye, unit ? normalize(d) : d));
    }
  }
  return rays;
}

// A turn of a scanner: in rows of one elevation, or in firings of all elevations.
std::vector<Ray> turn(const dvec3& eye, bool firings) {
  std::vector<Ray> rays;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const int column = firings ? i / kHeight : i % kWidth, row = firings ? i % kHeight : i / kWidth;
    const double azimuth = 2 * kPi * column / kWidth, elevation = 0.2 - 1.2 * row / kHeight;
    const double flat = std::cos(elevation);
    rays.push_back(ray_along(eye, {flat * std::sin(azimuth), flat * std::cos(azimuth), std::sin(elevation)}));
  }
  return rays;
}

// Bit for bit; members of a miss are not set.
testing::AssertionResult is(const Hit& hit, const Hit& expected, std::size_t ray) {
  const bool same = hit.status == expected.status &&
                    (!expected || (hit.t == expected.t && hit.cell == expected.cell && hit.u == expected.u &&
                                   hit.v == expected.v && hit.height == expected.height && hit.wall == expected.wall));
  if (same) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "ray " << ray << ": t " << hit.t << " instead of " << expected.t;
}

void expect_single_answers(const HeightTarget& target, const std::vector<Ray>& rays,
                           const std::optional<FanBatch>& batch = {}) {
  std::vector<Hit> hits(rays.size());
  batch ? closest_hits_in_fan(target, *batch, rays, hits) : closest_hits(target, rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(is(hits[i], march_max_mip(target, rays[i]), i));
}

HeightField hills(Wrap wrap = Wrap::none, double exaggeration = 1) {
  constexpr int kCols = 150, kRows = 140;
  const int shared = wrap == Wrap::shared_border;
  std::vector<float> samples;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const int x = col % (kCols - shared), y = row % (kRows - shared);
      samples.push_back(static_cast<float>(10 * std::sin(0.2 * x) * std::cos(0.15 * y) + std::sin(1.7 * x)));
    }
  }
  return HeightField::own(std::move(samples), kCols, kRows,
                          {.cell_x = 2, .cell_y = 3, .exaggeration = exaggeration, .wrap = wrap});
}

TEST(FanBatch, FindsRowsOfCamerasAndScannersAndFirings) {
  const HeightField field = hills();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const dvec3 eye(101, 140, 12);
  for (const double down : {-0.3, 0.0, 0.5, 1.2}) {
    for (const double roll : {0.0, 0.3, kPi / 2}) {
      for (const bool unit : {false, true}) {
        const std::vector<Ray> rays = camera(eye, 0.7, down, roll, unit);
        const auto batch = fan_batch(target, rays, always);
        ASSERT_TRUE(batch) << down << " " << roll << " " << unit;
        EXPECT_EQ(batch->run, static_cast<std::size_t>(kWidth));
        if (down < 1) {
          EXPECT_TRUE(fan_batch(target, rays)) << down << " " << roll;
        }
        // Seen steeply from above, rows are as good as columns.
        if (down < 1) {
          EXPECT_EQ(batch->columns, roll > 1) << down << " " << roll;
        }
      }
    }
  }
  // Callers may have made directions in float.
  for (const bool floats : {false, true}) {
    for (const bool firings : {false, true}) {
      std::vector<Ray> rays = turn(eye, firings);
      if (floats) {
        for (Ray& ray : rays) ray.direction = dvec3(vec3(ray.direction));
      }
      const auto batch = fan_batch(target, rays);
      ASSERT_TRUE(batch) << floats << firings;
      EXPECT_EQ(batch->run, static_cast<std::size_t>(firings ? kHeight : kWidth)) << floats << firings;
      EXPECT_EQ(batch->columns, firings) << floats << firings;
    }
  }
}

TEST(FanBatch, FindsFansOverWrappedFields) {
  for (const Wrap wrap : {Wrap::periodic, Wrap::shared_border}) {
    const HeightField field = hills(wrap);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for (const dvec3& eye : {dvec3(101, 140, 12), dvec3(-5000.5, 7000, 12), dvec3(0, 0, 14)}) {
      std::vector<Ray> rays = camera(eye, 0.7, 0.1, 0, true);
      EXPECT_FALSE(fan_batch(target, rays)) << "rays do not end";
      for (Ray& ray : rays) ray.t_max = 2000;
      EXPECT_TRUE(fan_batch(target, rays));
      expect_single_answers(target, rays);
      // Ranges of different lengths, and infinite ones, in which cells cannot be counted.
      for (std::size_t i = 6; i + 1 < rays.size(); i += 7)
        rays[i].t_max = i % 3 ? 10 * static_cast<double>(i) : std::numeric_limits<double>::infinity();
      EXPECT_TRUE(fan_batch(target, rays));
      expect_single_answers(target, rays);
    }
  }
}

TEST(FanBatch, LeavesOtherBatchesAlone) {
  const HeightField field = hills();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const dvec3 eye(101, 140, 12);
  const std::vector<Ray> rays = camera(eye, 0.7, 0.3, 0, true);
  EXPECT_FALSE(fan_batch(target, {}));
  EXPECT_FALSE(fan_batch(target, std::span(rays).first(200))) << "few";
  EXPECT_FALSE(fan_batch(target, std::span(rays).first(kWidth))) << "one row";
  EXPECT_FALSE(fan_batch(target, std::vector<Ray>(2000, rays[0]))) << "one direction";
  EXPECT_FALSE(fan_batch(target, camera(eye, 0.7, kPi / 2, 0, true))) << "straight down";
  const HeightField steep = hills(Wrap::none, 30);
  const MaxPyramid of_steep(steep);
  const HeightTarget steep_target{&steep, &of_steep};
  const dvec3 over(101, 140, 330);
  EXPECT_FALSE(fan_batch(steep_target, camera(over, 0.7, 0.7, 0.3, true))) << "links break";
  EXPECT_FALSE(fan_batch(target, camera(over, 0.7, -0.3, 0, true))) << "most miss";
  EXPECT_FALSE(fan_batch(target, camera({101, 140, 13}, 0.7, 1.3, 0, true))) << "all hit at once";
  EXPECT_FALSE(fan_batch(target, camera({101, 140, -50}, 0.7, 0.3, 0, true))) << "below the ground";
  // From above, few rows that cross many lines take longer together.
  const HeightField wide = HeightField::own(std::vector<float>(3001 * 5, 1.0f), 3001, 5, {});
  const MaxPyramid of_wide(wide);
  EXPECT_FALSE(fan_batch({&wide, &of_wide}, camera({1, 2, 40}, kPi / 2, 0.3, 0, true))) << "few rows";
  EXPECT_TRUE(fan_batch(target, camera({101, 140, 40}, 0.7, 0.3, 0, true))) << "few lines";
  Random random(3);
  std::vector<Ray> scattered = rays, elsewhere = rays;
  std::shuffle(scattered.begin(), scattered.end(), random);
  elsewhere.back().origin.z += 1;
  EXPECT_FALSE(fan_batch(target, elsewhere));
  const auto batch = fan_batch(target, scattered);
  EXPECT_TRUE(!batch || batch->run != static_cast<std::size_t>(kWidth));
  expect_single_answers(target, scattered);
}

TEST(FanBatch, AnswersAreThoseOfSingleRays) {
  Random random(11);
  std::vector<FieldKind> fields = spiteful_fields();
  fields.push_back({"hills", [](Random&) { return hills(); }});
  fields.push_back({"periodic hills", [](Random&) { return hills(Wrap::periodic); }});
  fields.push_back({"hills with a shared border", [](Random&) { return hills(Wrap::shared_border); }});
  int followed = 0;
  for (const FieldKind& kind : fields) {
    const HeightField field = kind.make(random);
    SCOPED_TRACE(kind.name);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    const double top = field.all_nodata() ? 0 : field.max_height(), tall = std::max(1.0, top - field.min_height());
    const dvec3 eye(uniform(random, -0.3, 1.3) * field.width(), uniform(random, -0.3, 1.3) * field.depth(),
                    top + uniform(random, -0.3, 1) * tall);
    if (!std::isfinite(eye.z)) continue;
    const double heading = uniform(random, 0, 2 * kPi), down = uniform(random, -0.2, kPi / 2);
    for (std::vector<Ray> rays : {camera(eye, heading, down, uniform(random, -0.5, 0.5), true),
                                  camera(eye, heading, 0.2, kPi / 2, false), turn(eye, true), turn(eye, false)}) {
      // Over a field that wraps, ranges end.
      if (field.wraps()) {
        for (Ray& ray : rays) ray.t_max = 20 * field.width();
      }
      if (const auto batch = fan_batch(target, rays, always)) {
        ++followed;
        expect_single_answers(target, rays, batch);
      }
      expect_single_answers(target, rays);
      // The end is missing, and some rays are of other kinds.
      rays.resize(rays.size() - 7);
      expect_single_answers(target, rays);
      for (std::size_t i = 33; i + 1 < rays.size(); i += 97) {
        switch (i % 5) {
          case 0:
            rays[i].t_max = uniform(random, 0, 2) * tall;
            break;
          case 1:
            rays[i].t_min = 0.5 * tall;
            break;
          case 2:
            rays[i].origin.x += 1;
            break;
          case 3:
            rays[i].direction *= 0x1p-200;
            break;
          default:
            rays[i].direction = -rays[i].direction;
        }
      }
      expect_single_answers(target, rays);
    }
  }
  EXPECT_GT(followed, 20);
}

}  // namespace
}  // namespace scarp::test
