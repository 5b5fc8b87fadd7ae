// SPDX-License-Identifier: MIT
#include "scarp/field/height_field.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/refusal.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// 3 x 2 samples, north row first.
HeightField small(const HeightFieldSettings& settings = {}) {
  return HeightField::own<float>({1, 2, 4, 8, 16, 32}, 3, 2, settings);
}

using test::refusal;

TEST(HeightField, PlacesTheSouthWestSampleAtTheOrigin) {
  const HeightField field = small({.cell_x = 10, .cell_y = 5});
  EXPECT_DOUBLE_EQ(field.width(), 20);
  EXPECT_DOUBLE_EQ(field.depth(), 5);
  EXPECT_DOUBLE_EQ(field.height(0, 0).value(), 8);
  EXPECT_DOUBLE_EQ(field.height(0, 5).value(), 1);
  EXPECT_DOUBLE_EQ(field.height(20, 0).value(), 32);
  EXPECT_DOUBLE_EQ(field.height(20, 5).value(), 4);
  EXPECT_EQ(field.world_from_grid(2, 1, 32), dvec3(20, 0, 32));
}

TEST(HeightField, InterpolatesBilinearly) {
  const HeightField field = small();
  EXPECT_DOUBLE_EQ(field.height(0.25, 0.5).value(), 0.5 * ((0.75 * 8 + 0.25 * 16) + (0.75 * 1 + 0.25 * 2)));
}

TEST(HeightField, HasNoHeightOutsideOrAtNaN) {
  const HeightField field = small();
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{-1e-9, 0.5}, {2.1, 0.5}, {1, 1.0001}, {1, -0.1}, {std::nan(""), 0.5}}) {
    EXPECT_FALSE(field.height(x, y)) << x << ", " << y;
  }
}

TEST(HeightField, AppliesScaleOffsetAndExaggeration) {
  const HeightField field = small({.scale = 0.5, .offset = 100, .exaggeration = 2});
  EXPECT_DOUBLE_EQ(field.height(0, 0).value(), (8 * 0.5 + 100) * 2);
  EXPECT_DOUBLE_EQ(field.min_height(), 201);
  EXPECT_DOUBLE_EQ(field.max_height(), 232);
}

// With a hole far away, the general code returns the same bits.
TEST(HeightField, ShadingNormalsDoNotDependOnHolesElsewhere) {
  constexpr int kSide = 8;
  std::vector<float> samples;
  for (int i = 0; i < kSide * kSide; ++i) samples.push_back(static_cast<float>(std::sin(0.7 * i) * 10));
  std::vector<float> holed = samples;
  holed.back() = kNaN;
  const HeightFieldSettings settings{.cell_x = 3, .cell_y = 2, .scale = 0.1, .exaggeration = 2};
  const HeightField whole = HeightField::own<float>(samples, kSide, kSide, settings);
  const HeightField with_hole = HeightField::own<float>(holed, kSide, kSide, settings);
  for (int col = 0; col < kSide - 3; ++col) {
    for (int row = 0; row < kSide - 3; ++row)
      EXPECT_EQ(whole.shading_normal({col, row}, 0.3, 0.8), with_hole.shading_normal({col, row}, 0.3, 0.8));
  }
}

TEST(HeightField, TreatsCellsThatTouchNodataAsHoles) {
  const HeightField field =
      HeightField::own<std::int16_t>({1, 2, 3, 4, -9999, 6, 7, 8, 9, 10, 11, 12}, 4, 3, {.nodata = -9999});
  EXPECT_EQ(field.nodata_count(), 1);
  EXPECT_EQ(field.min_sample(), 1);
  for (const Cell cell : {Cell{0, 0}, Cell{0, 1}}) EXPECT_FALSE(field.cell_heights(cell));
  for (const Cell cell : {Cell{1, 0}, Cell{2, 1}}) EXPECT_TRUE(field.cell_heights(cell));
}

TEST(HeightField, TreatsNaNAsAHoleForAnyNodataValue) {
  const HeightField field = HeightField::own<float>({1, kNaN, -5, 4}, 2, 2, {.nodata = -5});
  EXPECT_EQ(field.nodata_count(), 2);
  EXPECT_EQ(field.max_sample(), 4);
}

TEST(HeightField, IgnoresANodataValueThatTheSampleTypeCannotHold) {
  EXPECT_EQ(HeightField::own<std::uint16_t>({1, 2, 3, 4}, 2, 2, {.nodata = -9999}).nodata_count(), 0);
  EXPECT_EQ(HeightField::own<std::int16_t>({1, 2, 3, 4}, 2, 2, {.nodata = 2.5}).nodata_count(), 0);
  EXPECT_EQ(HeightField::own<float>({1, 2, 3, 4}, 2, 2, {.nodata = 1e300}).nodata_count(), 0);
  EXPECT_EQ(HeightField::own<float>({0, 2, 3, 4}, 2, 2, {.nodata = 1e-50}).nodata_count(), 0) << "it is not 0";
  EXPECT_EQ(HeightField::own<float>({0, 2, 3, 4}, 2, 2, {.nodata = 0}).nodata_count(), 1);
}

TEST(HeightField, RejectsInvalidFieldsInOneLine) {
  EXPECT_NE(refusal([] {
              HeightField::own<float>({1, 2, 3}, 2, 2);
            }).find("3 samples given for 2 x 2"),
            std::string::npos);
  EXPECT_NE(refusal([] { HeightField::own<float>({}, 0, 0); }).find("at least 1 x 1"), std::string::npos);
  EXPECT_NE(refusal([] { small({.cell_x = 0}); }).find("cell_x"), std::string::npos);
  EXPECT_NE(refusal([] { small({.scale = -1}); }).find("scale"), std::string::npos);
  for (const HeightFieldSettings& absurd : {HeightFieldSettings{.cell_x = 1e300},
                                            {.cell_y = 1e-300},
                                            {.scale = 1e300},
                                            {.scale = 1e-300},
                                            {.scale = 1e60, .exaggeration = 1e60},
                                            {.offset = -1e300},
                                            {.exaggeration = 1e308}}) {
    EXPECT_NE(refusal([&] { small(absurd); }).find("2^300 m"), std::string::npos);
  }
  EXPECT_NE(refusal([] { small({.exaggeration = std::nan("")}); }).find("exaggeration"), std::string::npos);
  EXPECT_NE(refusal([] {
              HeightField::own<float>({1, 2, 3, HUGE_VALF}, 2, 2);
            }).find("column 1, row 1 is infinite"),
            std::string::npos);
}

TEST(HeightField, AcceptsInfinityDeclaredAsNodata) {
  EXPECT_EQ(HeightField::own<float>({1, 2, 3, HUGE_VALF}, 2, 2, {.nodata = HUGE_VAL}).nodata_count(), 1);
}

TEST(HeightField, ViewsCallerMemoryWithoutCopying) {
  std::array<float, 12> memory{0, 1, 2, -1, 3, 4, 5, -1, 6, 7, 8, -1};
  const HeightField field = HeightField::view(memory.data(), 3, 3, {}, 4);
  EXPECT_DOUBLE_EQ(field.height(0, 0).value(), 6);
  EXPECT_EQ(field.min_sample(), 0);
  const HeightField flipped = HeightField::view(memory.data() + 8, 3, 3, {}, -4);
  EXPECT_DOUBLE_EQ(flipped.height(0, 0).value(), 0);
  memory[8] = 60;
  EXPECT_DOUBLE_EQ(field.height(0, 0).value(), 60);
}

TEST(HeightField, HasNoCellsWithASingleRowOrColumn) {
  EXPECT_FALSE(HeightField::own<float>({1, 2, 3}, 3, 1).has_cells());
  EXPECT_FALSE(HeightField::own<float>({1, 2, 3}, 1, 3).has_cells());
  EXPECT_FALSE(HeightField::own<float>({1, 2, 3}, 3, 1).height(1, 0));
}

TEST(HeightField, NormalPointsDownhill) {
  // Rises by 3 m per metre to the east and by 2 to the north.
  std::vector<float> samples;
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 5; ++col) samples.push_back(static_cast<float>(3 * col - 2 * row));
  }
  const HeightField field = HeightField::own(samples, 5, 4);
  EXPECT_EQ(field.gradient(1.5, 1.5).value(), dvec2(3, 2));
  const dvec3 expected = normalize(dvec3(-3, -2, 1));
  for (const dvec3& n :
       {field.normal({1, 1}, 0.3, 0.6), field.shading_normal({1, 1}, 0.3, 0.6), field.shading_normal({0, 2}, 0, 1)}) {
    EXPECT_NEAR(length(n - expected), 0, 4 * 0x1p-52);
  }
}

RC_GTEST_PROP(HeightField, GradientMatchesFiniteDifferences, ()) {
  const auto value = [] { return static_cast<float>(*rc::gen::inRange(-1000, 1000)); };
  const HeightField field =
      HeightField::own<float>({value(), value(), value(), value()}, 2, 2, {.cell_x = 3, .cell_y = 7, .scale = 0.25});
  const double x = *rc::gen::inRange(1, 99) * 0.03, y = *rc::gen::inRange(1, 99) * 0.07;
  const dvec2 slope = field.gradient(x, y).value();
  // Along one axis a bilinear surface is linear: central differences are exact except for the rounding of heights up to
  // 250 m over a step of 1/64 m.
  const double d = 0x1p-6, rounding = 8 * 250 * 0x1p-52 / d;
  RC_ASSERT(std::abs((field.height(x + d, y).value() - field.height(x - d, y).value()) / (2 * d) - slope.x) < rounding);
  RC_ASSERT(std::abs((field.height(x, y + d).value() - field.height(x, y - d).value()) / (2 * d) - slope.y) < rounding);
}

TEST(HeightField, CountsHolesInLongRows) {
  // Rows longer than a chunk of the count, with scattered holes; 0 also marks -0.
  constexpr int kCols = 150;
  std::vector<float> samples(2 * kCols, 3);
  samples[5] = 0, samples[70] = -0.0f, samples[149] = std::numeric_limits<float>::quiet_NaN(), samples[160] = -7;
  samples[299] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(HeightField::own(samples, kCols, 2, {.nodata = 0}), Error);
  samples[299] = 9;
  const HeightField field = HeightField::own(samples, kCols, 2, {.nodata = 0});
  EXPECT_EQ(field.nodata_count(), 3);
  EXPECT_EQ(field.min_sample(), -7);
  EXPECT_EQ(field.max_sample(), 9);
  const HeightField all_holes = HeightField::own(std::vector<float>(2 * kCols, -0.0f), kCols, 2, {.nodata = 0});
  EXPECT_TRUE(all_holes.all_nodata());
  samples[299] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(HeightField::own(samples, kCols, 2, {.nodata = HUGE_VAL}).nodata_count(), 2) << "an infinite one and NaN";
}

}  // namespace
}  // namespace scarp
