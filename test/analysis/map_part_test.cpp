// SPDX-License-Identifier: MIT
// Bands of maps are the rows of whole maps, bit for bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "analysis/map_fields.h"
#include "cases.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/observer_count.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

// Puts the parts of a map together.
template <class Part>
auto joined(const HeightField& field, int parts, const Part& part) {
  auto map = part(row_band(field.rows(), 1, parts));
  for (int i = 2; i <= parts; ++i) {
    const auto next = part(row_band(field.rows(), i, parts));
    map.insert(map.end(), next.begin(), next.end());
  }
  return map;
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
  return bits;
}

// Mountains of noise, larger than the fields of the judge, with holes.
HeightField mountains(int cols, int rows) {
  std::mt19937 random(7);
  std::vector<float> heights;
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col)
      heights.push_back(random() % 97 == 0 ? std::nanf("")
                                           : static_cast<float>(40 * std::sin(col * 0.11) * std::cos(row * 0.07) +
                                                                static_cast<double>(random() % 1000) / 100));
  return HeightField::own(std::move(heights), cols, rows, {.cell_x = 10, .cell_y = 15});
}

TEST(MapPart, BandsCoverAllRows) {
  for (const int rows : {1, 2, 7, 100, 8192})
    for (const int parts : {1, 2, 3, 7, 64}) {
      if (parts > rows) continue;
      int next = 0;
      for (int i = 1; i <= parts; ++i) {
        const RowBand band = row_band(rows, i, parts);
        EXPECT_EQ(band.first, next);
        EXPECT_TRUE(band.rows() == rows / parts || band.rows() == rows / parts + 1);
        next = band.last;
      }
      EXPECT_EQ(next, rows);
    }
  EXPECT_THROW(row_band(10, 0, 2), Error);
  EXPECT_THROW(row_band(10, 3, 2), Error);
  EXPECT_THROW(row_band(10, 1, 11), Error);
  const auto field = mountains(5, 5);
  EXPECT_THROW(shadow_rows(field, {.altitude = 1}, {3, 3}), Error);
  EXPECT_THROW(shadow_rows(field, {.altitude = 1}, {3, 6}), Error);
}

TEST(MapPart, PartsAddUpToTheWhole) {
  auto fields = map_fields();
  fields.push_back({"mountains", mountains(90, 120)});
  const auto stride = static_cast<std::size_t>(cases(1, 3, 8));
  const auto settings = map_settings();
  const auto suns = map_suns();
  std::size_t turn = 0;
  for (std::size_t k = 0; k < fields.size(); k += stride) {
    const auto& [name, field] = fields[fields.size() - 1 - k];
    for (const int parts : {2, 5}) {
      if (parts > field.rows()) continue;
      for (const Node observer : map_observers(field)) {
        const ViewshedSettings& chosen = settings[turn++ % settings.size()];
        EXPECT_EQ(viewshed(field, observer, chosen), joined(field, parts,
                                                            [&, &field = field](const RowBand& band) {
                                                              return viewshed_rows(field, observer, chosen, band);
                                                            }))
            << name << " from " << observer.col << ", " << observer.row;
        EXPECT_EQ(bits_of(least_visible(field, observer, chosen)),
                  bits_of(joined(field, parts,
                                 [&, &field = field](const RowBand& band) {
                                   return least_visible_rows(field, observer, chosen, band);
                                 })))
            << name << " from " << observer.col << ", " << observer.row;
      }
      std::vector<Viewpoint> views;
      for (const Node observer : map_observers(field))
        views.emplace_back(field, observer, settings[turn++ % settings.size()]);
      if (!views.empty()) {
        EXPECT_EQ(observer_count(views),
                  joined(field, parts, [&](const RowBand& band) { return observer_count_rows(views, band); }))
            << name;
      }
      for (int i = 0; i < 4; ++i) {
        const SunDirection& sun = suns[turn++ % suns.size()];
        EXPECT_EQ(
            shadow(field, sun),
            joined(field, parts, [&, &field = field](const RowBand& band) { return shadow_rows(field, sun, band); }))
            << name << ", sun " << sun.azimuth << ", " << sun.altitude;
      }
    }
  }
}

// Ground above the band casts shadows into it, and distance limits exclude whole bands.
TEST(MapPart, DistantGroundAffectsTheBand) {
  std::vector<float> heights(40 * 200, 0);
  for (int col = 0; col < 40; ++col) heights[static_cast<std::size_t>(col)] = 100;
  const auto field = HeightField::own(std::move(heights), 40, 200);
  // The shadow of the wall in row 0 is 100 m / tan(altitude) long.
  const SunDirection sun{.azimuth = 0, .altitude = std::atan(100 / 150.5)};
  const auto band = shadow_rows(field, sun, {149, 153});
  EXPECT_EQ(band[20], Shade::cast_shadow);
  EXPECT_EQ(band[40 + 20], Shade::cast_shadow);
  EXPECT_EQ(band[80 + 20], Shade::lit);
  const ViewshedSettings near{.max_distance = 20};
  EXPECT_EQ(viewshed_rows(field, {20, 100}, near, {121, 122}), std::vector<Seen>(40, Seen::out_of_range));
  EXPECT_EQ(viewshed_rows(field, {20, 100}, near, {120, 121})[20], Seen::visible);
}

}  // namespace
}  // namespace scarp::test
