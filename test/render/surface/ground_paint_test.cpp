// SPDX-License-Identifier: MIT
#include "scarp/render/surface/ground_paint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

const dvec3 kSun = normalize(dvec3(-1, 0, 1));

// Paint for ground of 10 x 10 cells of 10 m, with heights from 0 to 100 m.
class Paint {
 public:
  explicit Paint(const GroundPaintSettings& settings)
      : paint_(settings, {.low = 0, .high = 100, .cell = 10, .size = {100, 100}}, Ramp("grey", 0, 100), kSun) {}

  vec3 operator()(const dvec3& position, double height, const dvec3& normal, double footprint) const {
    return paint_.over(paint_.ground(position, height, normal, footprint), position, height, normal, footprint);
  }

 private:
  GroundPaint paint_;
};

Paint paint(const GroundPaintSettings& settings) { return Paint(settings); }

TEST(GroundPaint, ContoursHaveTheRightHeightAndWidth) {
  const Paint with = paint({.contours = 20}), without = paint({});
  const dvec3 normal = normalize(dvec3(-1, 0, 1));
  constexpr double kPixel = 0.25;
  for (double height = 1; height < 99; height += 0.05) {
    const dvec3 p(height, 50, height);
    const bool inked = with(p, height, normal, kPixel) != without(p, height, normal, kPixel);
    const double line = std::round(height / 20);
    // Slope 1: as many metres sideways as upwards. Every fifth line is heavier: half of 2.0 pixels instead of 1.1, and
    // half a pixel of blur on both.
    const double reach = (line == 0 || line == 5 ? 1.5 : 1.05) * kPixel, off = std::abs(height - line * 20);
    if (std::abs(off - reach) < 1e-6) continue;
    EXPECT_EQ(inked, off < reach) << height;
  }
  // Lines closer than three pixels are not drawn.
  EXPECT_EQ(with({20, 50, 20}, 20, normal, 8), without({20, 50, 20}, 20, normal, 8));
}

TEST(GroundPaint, ContoursAppearOnVerticalSurfacesOnly) {
  const Paint with = paint({.contours = 20}), without = paint({});
  const dvec3 upright(1, 0, 0), up(0, 0, 1);
  constexpr double kPixel = 0.25;
  const auto inked = [&](double height, const dvec3& normal) {
    const dvec3 p(50, 50, height);
    return with(p, height, normal, kPixel) != without(p, height, normal, kPixel);
  };
  // On an upright surface, a pixel covers a height equal to its side.
  EXPECT_TRUE(inked(40, upright));
  EXPECT_TRUE(inked(40 + 1.0 * kPixel, upright));
  EXPECT_FALSE(inked(40 + 1.1 * kPixel, upright));
  EXPECT_FALSE(inked(40, up));
  EXPECT_FALSE(inked(40, normalize(dvec3(1e-7, 0, 1)))) << "rounding of the samples";
}

TEST(GroundPaint, RockIsSteepAndSnowIsHigh) {
  const Paint natural = paint({.natural = true, .snow_share = 0.7});
  const auto at = [&](double height, const dvec3& normal) {
    return natural({50, 50, height}, height, normalize(normal), 1e9);
  };
  const vec3 meadow = at(20, {0, 0, 1}), rock = at(20, {1, 0, 0.5}), snow = at(95, {0, 0, 1}),
             cliff = at(95, {1, 0, 0.3});
  EXPECT_GT(meadow.y, meadow.x) << "green";
  EXPECT_GT(rock.x, rock.y);
  EXPECT_GT(snow.x, 0.7f);
  EXPECT_LT(cliff.x, 0.5f) << "too steep for snow";
  // Just below the snow line there is more snow on the side away from the sun, in the west.
  EXPECT_GT(at(68, {0.4, 0, 1}).z, at(68, {-0.4, 0, 1}).z);
}

TEST(GroundPaint, DrapesAPictureOverTheField) {
  auto drape = std::make_shared<Drape>(Drape{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 0}});
  const Paint paper = paint({.drape = drape});
  const auto at = [&](double x, double y) { return paper({x, y, 0}, 100, {0, 0, 1}, 1); };
  EXPECT_EQ(at(0, 100), vec3(1, 0, 0)) << "the north-west";
  EXPECT_EQ(at(100, 100), vec3(0, 1, 0));
  EXPECT_EQ(at(0, 0), vec3(0, 0, 1));
  EXPECT_EQ(at(100, 0), vec3(1, 1, 1)) << "transparent: the ramp below, white at its top";
  const vec3 middle = at(50, 100);
  EXPECT_NEAR(middle.x, 0.5, 1e-6);
  EXPECT_NEAR(middle.y, 0.5, 1e-6);
}

TEST(GroundPaint, PartialDrapesLeaveTheRest) {
  Drape part{1, 1, {255, 0, 0, 255}, {0.25, 0.5}, {0.75, 1}};
  const auto red_at = [](const Paint& paper, double x, double y) {
    return paper({x, y, 0}, 100, {0, 0, 1}, 1) == vec3(1, 0, 0);
  };
  const Paint once = paint({.drape = std::make_shared<Drape>(part)});
  part.mirrored = true;
  const Paint mirrored = paint({.drape = std::make_shared<Drape>(part)});
  // In a mirrored field the raster is the south-west quarter.
  const auto in_part = [](double x, double y) { return x >= 25 && x <= 75 && y <= 50; };
  for (int y = 1; y < 100; y += 4) {
    for (int x = 1; x < 100; x += 4) {
      EXPECT_EQ(in_part(x, y), red_at(once, x, y)) << x << ' ' << y;
      EXPECT_EQ(in_part(x < 50 ? 2 * x : 200 - 2 * x, y < 50 ? 2 * y : 200 - 2 * y), red_at(mirrored, x, y))
          << x << ' ' << y;
    }
  }
  EXPECT_TRUE(red_at(once, 25, 0)) << "the corners belong to it";
  EXPECT_TRUE(red_at(once, 75, 50));
}

TEST(GroundPaint, DrapesRepeatWithTheField) {
  auto drape = std::make_shared<Drape>(Drape{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 0}});
  const GroundPaint paper({.drape = drape}, {.origin = {5, 7}, .size = {100, 50}, .repeats = true}, Ramp("grey", 0, 1),
                          kSun);
  const auto at = [&](double x, double y) { return paper.over(vec3(0), {x, y, 0}, 0, {0, 0, 1}, 1); };
  for (const double x : {-300.0, 0.0, 4000.0}) {
    for (const double y : {-50.0, 0.0, 5000.0}) {
      EXPECT_EQ(at(15 + x, 50 + y), vec3(1, 0, 0));
      EXPECT_EQ(at(95 + x, 50 + y), vec3(0, 1, 0));
      EXPECT_EQ(at(15 + x, 12 + y), vec3(0, 0, 1));
    }
  }
}

TEST(GroundPaint, DetailFadesWithDistance) {
  const Paint rough = paint({.detail = 0.5, .detail_size = 10}), smooth = paint({});
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const dvec3 p(7.3 * i, 3.9 * i, 0);
    different += rough(p, 60, {0, 0, 1}, 0.1) != smooth(p, 60, {0, 0, 1}, 0.1);
    EXPECT_EQ(rough(p, 60, {0, 0, 1}, 10), smooth(p, 60, {0, 0, 1}, 10));
  }
  EXPECT_GT(different, 90);
}

TEST(GroundPaint, FileRampsKeepTheirValues) {
  RampStops stops;
  stops.slices = {{-10, 0, {0, 0, 1}, {0, 0, 1}}, {0, 50, {0, 1, 0}, {1, 0, 0}}};
  const Ramp ramp(stops, 0, 100, 2);  // twice exaggerated
  EXPECT_EQ(ramp(-5), vec3(0, 0, 1));
  EXPECT_EQ(ramp(1e-9).z, 0) << "a break";
  EXPECT_EQ(ramp(100), vec3(1, 0, 0));
  EXPECT_EQ(ramp(1e9), vec3(1, 0, 0));
  EXPECT_EQ(ramp(-1e9), vec3(0, 0, 1));
  EXPECT_NEAR(ramp(50).x, linear_from_srgb(vec3(0.5f)).x, 1e-6) << "mixed as the file's colours are";
  stops.slices = {{-1, 0, {0, 0, 0}, {1, 1, 1}}, {0, 1, {0, 0, 0}, {1, 0, 0}}};
  stops.stretched = stops.hinged = true;
  const Ramp hinged(stops, -20, 400);
  EXPECT_EQ(hinged(-20), vec3(0, 0, 0));
  EXPECT_NEAR(hinged(-1e-9).y, 1, 1e-6);
  EXPECT_EQ(hinged(400), vec3(1, 0, 0));
}

TEST(GroundPaint, RejectsValuesOutOfRange) {
  EXPECT_THROW(validate(GroundPaintSettings{.detail = 2}), Error);
  EXPECT_THROW(validate(GroundPaintSettings{.detail_size = -1}), Error);
  EXPECT_THROW(validate(GroundPaintSettings{.contours = -1}), Error);
  EXPECT_THROW(validate(GroundPaintSettings{.snow_share = NAN}), Error);
}

}  // namespace
}  // namespace scarp
