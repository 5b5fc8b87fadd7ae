// SPDX-License-Identifier: MIT
// Horizons by strips in little memory are those of the whole field in memory, to the bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/horizon_errors.h"
#include "scarp/analysis/horizon_state.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

// Hills with holes, and one wide hole.
HeightField hills(int cols, int rows) {
  std::mt19937 random(static_cast<unsigned>(cols));
  std::uniform_int_distribution<int> rough(0, 30), hole(0, 90);
  std::vector<std::int16_t> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double hill = 150 * std::sin(col / 41.0) * std::cos(row / 29.0);
      const bool in_hole = hole(random) == 0 || std::hypot(col - cols / 3, row - rows / 2) < 20;
      samples.push_back(in_hole ? -1 : static_cast<std::int16_t>(400 + rough(random) + std::lround(hill)));
    }
  }
  HeightFieldSettings settings;
  settings.cell_x = 10, settings.cell_y = 12.5, settings.nodata = -1;
  return HeightField::own(std::move(samples), cols, rows, settings);
}

// Enough for a strip, and less than the whole.
double little_memory(const HeightField& field, HorizonEngine engine) {
  const double nodes = static_cast<double>(field.cols()) * field.rows();
  return (engine == HorizonEngine::exact ? 9 : 8) * nodes - 1;
}

void expect_same(const std::vector<float>& found, const std::vector<float>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  int differences = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    differences += std::bit_cast<std::uint32_t>(found[i]) != std::bit_cast<std::uint32_t>(expected[i]);
  EXPECT_EQ(differences, 0);
}

TEST(HorizonStrips, AreThoseOfTheWholeField) {
  const int sizes[][2] = {{600, 430}, {330, 610}, {1300, 260}};
  for (const auto& [cols, rows] : sizes) {
    const HeightField field = hills(cols, rows);
    for (const HorizonEngine engine : {HorizonEngine::exact, HorizonEngine::sweep}) {
      HorizonSettings settings;
      settings.engine = engine, settings.eye_height = 1.5;
      const Horizons whole(field, settings);
      settings.memory = little_memory(field, engine);
      const Horizons strips(field, settings);
      ASSERT_TRUE(state_of(strips).relief->tiles);
      // All sides, diagonals, and lines that hardly leave their row or column.
      for (const double degrees : {0.0, 0.4, 31.0, 45.0, 89.7, 90.0, 118.0, 180.5, 225.0, 254.0, 270.0, 300.0, 341.0}) {
        SCOPED_TRACE(std::to_string(cols) + " columns, " + std::to_string(degrees) + " degrees");
        const double azimuth = degrees * std::numbers::pi / 180;
        const NodeRect part{37, 21, cols - 45, rows - 29};
        const HorizonRows expected = whole.block(azimuth, part, true), found = strips.block(azimuth, part, true);
        expect_same(found.angle, expected.angle);
        expect_same(found.distance, expected.distance);
      }
    }
  }
}

TEST(HorizonStrips, KeepTheMaximumDistance) {
  const HeightField field = hills(600, 430);
  HorizonSettings settings;
  settings.max_distance = 700;
  const Horizons whole(field, settings);
  settings.memory = little_memory(field, settings.engine);
  const Horizons strips(field, settings);
  for (const double azimuth : {0.3, 1.4, 3.0, 4.4})
    expect_same(strips.rows(azimuth, 100, 260).angle, whole.rows(azimuth, 100, 260).angle);
}

TEST(HorizonStrips, GiveTheSameSkyViews) {
  const HeightField field = hills(700, 500);
  for (const HorizonEngine engine : {HorizonEngine::exact, HorizonEngine::sweep}) {
    HorizonSettings settings;
    settings.engine = engine;
    const std::vector<SkyMeasure> measures{SkyMeasure::sky_view_factor, SkyMeasure::negative_openness};
    const auto expected = SkyView(field, settings, 5, measures).rows(0, field.rows());
    // Shared by the ground and the same upside down.
    settings.memory = 2 * little_memory(field, engine);
    const auto found = SkyView(field, settings, 5, measures).rows(0, field.rows());
    for (std::size_t m = 0; m < measures.size(); ++m) expect_same(found[m], expected[m]);
  }
}

TEST(HorizonStrips, StateTheSameErrors) {
  const HeightField field = hills(600, 430);
  HorizonSettings settings;
  settings.engine = HorizonEngine::sweep;
  const std::vector<double> azimuths{0.2, 1.0, 2.9};
  const HorizonErrors expected = sampled_horizon_errors(field, settings, azimuths, {10, 420}, 300);
  settings.memory = little_memory(field, settings.engine);
  const HorizonErrors found = sampled_horizon_errors(field, settings, azimuths, {10, 420}, 300);
  // Heights are whole metres: floats hold them.
  EXPECT_EQ(found.count, expected.count);
  EXPECT_EQ(found.p99, expected.p99);
  EXPECT_EQ(found.largest, expected.largest);
  EXPECT_GT(found.largest, 0);
}

TEST(HorizonStrips, NeedRoomForOne) {
  const HeightField field = hills(600, 430);
  HorizonSettings settings;
  settings.memory = 1000;
  EXPECT_THROW(Horizons(field, settings).rows(0, 0, 1), Error);
  settings.engine = HorizonEngine::sweep;
  EXPECT_THROW(Horizons(field, settings).rows(0, 0, 1), Error);
  settings.memory = 0;
  EXPECT_THROW(Horizons(field, settings), Error);
}

}  // namespace
}  // namespace scarp
