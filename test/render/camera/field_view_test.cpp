// SPDX-License-Identifier: MIT
#include "scarp/render/camera/field_view.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "render/terrain.h"

namespace scarp {
namespace {

constexpr int kSide = 33, kMiddle = kSide / 2;
constexpr double kGround = 700;

// 32 x 32 cells of 100 m, level ground changed by edit(sample(col, row)).
template <class Edit>
HeightField field_of(Edit&& edit, Wrap wrap = Wrap::none) {
  std::vector<float> samples(std::size_t{kSide} * kSide, static_cast<float>(kGround));
  edit([&](int col, int row) -> float& { return samples[static_cast<std::size_t>(row * kSide + col)]; });
  return HeightField::own(std::move(samples), kSide, kSide, {.cell_x = 100, .cell_y = 100, .wrap = wrap});
}
const auto kLevel = [](const auto&) {};

WorldBox box_of(const HeightField& field, bool plinth) {
  return picture_box(plinth ? test::terrain_on_plinth(field) : test::terrain(field));
}

FieldView view_of(const HeightField& field, const ViewSettings& settings, bool plinth = true) {
  return view_of_field(field, box_of(field, plinth), settings, 0.2, 640, 360);
}

TEST(FieldView, StaysAboveLevelGround) {
  const HeightField field = field_of(kLevel);
  for (const bool plinth : {true, false}) {
    for (const double elevation : {5.0, 10.0, 20.0, 35.0, 60.0}) {
      for (double distance = 1; distance > 0.0005; distance /= 1.3) {
        const FieldView view = view_of(field, {.elevation_deg = elevation, .distance = distance}, plinth);
        EXPECT_EQ(view.raised, 0) << elevation << ", " << distance;
        EXPECT_GT(view.camera.eye().z, kGround) << elevation << ", " << distance;
      }
    }
  }
}

TEST(FieldView, ApproachesTheGroundInTheMiddle) {
  const HeightField hill = field_of([](const auto& sample) { sample(kMiddle, kMiddle) = 1500; });
  const HeightField hole = field_of([](const auto& sample) {
    sample(kMiddle, kMiddle) = std::numeric_limits<float>::quiet_NaN();
    sample(3, 5) = 900;
  });
  for (const auto& [field, height] : {std::pair(&hill, 1500.0), {&hole, 900.0}}) {
    const dvec3 eye = view_of(*field, {.elevation_deg = 60, .distance = 1e-6}).camera.eye();
    // Some 8 km away at distance 1.
    EXPECT_NEAR(length(eye - dvec3(0.5 * field->width(), 0.5 * field->depth(), height)), 0, 0.05);
  }
}

// A ridge along the whole field, in front of the ground in the middle.
TEST(FieldView, IsRaisedOutOfHills) {
  const HeightField field = field_of([](const auto& sample) {
    for (int col = 0; col < kSide; ++col) {
      for (int row = kMiddle + 2; row < kSide; ++row) sample(col, row) = 5000;
    }
  });
  const ViewSettings south{.azimuth_deg = 180, .elevation_deg = 20, .distance = 0.1};
  const FieldView view = view_of(field, south);
  const dvec3 eye = view.camera.eye(), focus(1600, 1600, kGround);
  ASSERT_TRUE(field.height(eye.x, eye.y));
  EXPECT_GT(view.raised, 1000);
  const dvec3 before(eye.x, eye.y, eye.z - view.raised);
  // field_view.h: a hundredth of its path; some dozen roundings of coordinates below 2^13 m.
  constexpr double kClear = 0.01, kRounding = 0x1p-34;
  EXPECT_NEAR(eye.z - *field.height(eye.x, eye.y), kClear * length(before - focus), kRounding);
  EXPECT_EQ(view.camera.forward(), Camera::framed(box_of(field, true), south, 0.2, 640, 360).forward());
}

// Level views of ground that continues beyond its border start at half of the plinth's height.
TEST(FieldView, IsRaisedOutOfWrappedGround) {
  const HeightField field = field_of(kLevel, Wrap::periodic);
  const FieldView view = view_of(field, {.elevation_deg = 0});
  EXPECT_GT(view.raised, 0);
  EXPECT_GT(view.camera.eye().z, kGround);
}

}  // namespace
}  // namespace scarp
