// SPDX-License-Identifier: MIT
// The conversions of doc/library/axes.md, as they stand there: heights and rays of an engine in its own axes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scarp/scarp.h"

namespace scarp::test {
namespace {

constexpr int side = 4;
constexpr double cell = 2.5;

// Differs in every row and column.
int sample(int col, int row) { return 3 * col + 17 * row + col * row % 5; }

// Heights in metres, by the convention of an engine: `place(col, row, height)` is where it has a sample.
template <class Place, class Into, class From>
void expect_engine(const Terrain& terrain, const Into& scarp_from_engine, const From& engine_from_scarp,
                   const Place& place, const dvec3& up) {
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const dvec3 p = place(col, row);
      const dvec3 start = scarp_from_engine(p + up), end = scarp_from_engine(p - up);
      const Hit hit = cast(terrain, {.origin = start, .direction = end - start});
      ASSERT_TRUE(hit) << col << ", " << row;
      const dvec3 back = engine_from_scarp(start + hit.t * (end - start));
      // There, the hit and back are fewer than 64 roundings of numbers below those of the ray's ends.
      const double largest = length(start) + length(end) + length(p) + length(up);
      EXPECT_LT(length(back - p), 64 * 0x1p-53 * largest) << col << ", " << row;
    }
  }
}

TEST(Axes, OfUnity) {
  std::vector<float> samples;
  for (int i = 0; i < side * side; ++i) samples.push_back(static_cast<float>(sample(i % side, i / side)) / 128);
  const float* const heights = samples.data();
  const double height = 128;
  // [unity]
  const auto terrain = Terrain::view(heights + side * (side - 1), side, side, {cell, cell, height}, -side);
  const auto scarp_from_unity = [](const dvec3& p) { return dvec3(p.x, p.z, p.y); };
  const auto unity_from_scarp = [](const dvec3& p) { return dvec3(p.x, p.z, p.y); };
  // [end]
  expect_engine(terrain, scarp_from_unity, unity_from_scarp,
                [](int col, int row) { return dvec3(col * cell, sample(col, row), row * cell); }, {0, 200, 0});
}

TEST(Axes, OfJoltAndGodot) {
  std::vector<float> samples;
  for (int i = 0; i < side * side; ++i) samples.push_back(static_cast<float>(sample(i % side, i / side)));
  const float* const heights = samples.data();
  // [jolt]
  const auto terrain = Terrain::view(heights, side, side, {.cell_x = cell, .cell_y = cell});
  const auto scarp_from_jolt = [=](const dvec3& p) { return dvec3(p.x, (side - 1) * cell - p.z, p.y); };
  const auto jolt_from_scarp = [=](const dvec3& p) { return dvec3(p.x, p.z, (side - 1) * cell - p.y); };
  // [end]
  expect_engine(terrain, scarp_from_jolt, jolt_from_scarp,
                [](int col, int row) { return dvec3(col * cell, sample(col, row), row * cell); }, {0, 200, 0});
}

TEST(Axes, OfUnreal) {
  std::vector<std::uint16_t> samples;
  for (int i = 0; i < side * side; ++i)
    samples.push_back(static_cast<std::uint16_t>(32768 + 128 * sample(i % side, i / side)));
  const std::uint16_t* const heights = samples.data();
  // [unreal]
  const auto terrain = Terrain::view(heights, side, side, {cell, cell, 1 / 128.0, -256});
  const auto scarp_from_unreal = [=](const dvec3& p) { return dvec3(p.x, (side - 1) * 100 * cell - p.y, p.z) / 100.0; };
  const auto unreal_from_scarp = [=](const dvec3& p) { return dvec3(p.x, (side - 1) * cell - p.y, p.z) * 100.0; };
  // [end]
  expect_engine(terrain, scarp_from_unreal, unreal_from_scarp,
                [](int col, int row) { return 100.0 * dvec3(col * cell, row * cell, sample(col, row)); },
                {0, 0, 20'000});
}

std::string text_of(const std::string& name) {
  std::ifstream in(std::string(SCARP_SOURCE_DIR) + name);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Axes, DocumentHasTheseLines) {
  const std::string page = text_of("/doc/library/axes.md"), source = text_of("/test/scene/axes_test.cpp");
  for (const char* name : {"[unity]", "[jolt]", "[unreal]"}) {
    const std::size_t begin = source.find('\n', source.find(std::string("// ") + name)) + 1,
                      end = source.find("  // [end]", begin);
    std::string lines;
    for (std::size_t at = begin; at < end; at = source.find('\n', at) + 1)
      lines += source.substr(at + 2, source.find('\n', at) - at - 1);
    EXPECT_NE(page.find("```cpp\n" + lines + "```\n"), std::string::npos) << name << "\n" << lines;
  }
}

}  // namespace
}  // namespace scarp::test
