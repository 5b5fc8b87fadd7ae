// SPDX-License-Identifier: MIT
#include "analysis/map_fields.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace scarp::test {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
constexpr float kMicrometre = 1e-6f;
constexpr double kGrazingSun = 1e-6;  // radians above the horizon
using Shape = std::function<float(int col, int row)>;

HeightField sampled(int cols, int rows, double cell_x, double cell_y, const Shape& shape) {
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) samples.push_back(shape(col, row));
  return HeightField::own(std::move(samples), cols, rows, {.cell_x = cell_x, .cell_y = cell_y});
}

// Whole metres, so that exact ties are common; `levels` is the number of different heights.
Shape steps(unsigned seed, int levels) {
  return [random = std::mt19937(seed), levels](int, int) mutable {
    return static_cast<float>(random() % static_cast<unsigned>(levels));
  };
}
Shape rough(unsigned seed, float relief) {
  return [random = std::mt19937(seed), relief](int, int) mutable {
    return relief * std::uniform_real_distribution<float>(0, 1)(random);
  };
}
// One sample in `every` is a hole.
Shape with_holes(Shape shape, unsigned seed, unsigned every) {
  return [shape = std::move(shape), random = std::mt19937(seed), every](int col, int row) {
    auto& engine = const_cast<std::mt19937&>(random);
    const float height = shape(col, row);
    return engine() % every == 0 ? kHole : height;
  };
}

const std::vector<std::pair<std::string, Shape>>& shapes() {
  static const std::vector<std::pair<std::string, Shape>> all = {
      {"flat", [](int, int) { return 100.f; }},
      {"plane", [](int col, int row) { return static_cast<float>(3 * col - 2 * row); }},
      {"steep plane", [](int col, int row) { return static_cast<float>(1000 * col + 777 * row); }},
      {"cone",
       [](int col, int row) { return 50 - 5 * std::hypot(static_cast<float>(col - 6), static_cast<float>(row - 6)); }},
      {"pit",
       [](int col, int row) { return 5 * std::hypot(static_cast<float>(col - 6), static_cast<float>(row - 6)); }},
      {"dome",
       [](int col, int row) { return -0.5f * static_cast<float>((col - 5) * (col - 5) + (row - 6) * (row - 6)); }},
      {"cliff", [](int col, int) { return col < 5 ? 120.f : 0.f; }},
      {"diagonal cliff", [](int col, int row) { return col + row < 11 ? 0.f : 30.f; }},
      {"pillar", [](int col, int row) { return col == 6 && row == 5 ? 255.f : 0.f; }},
      {"well", [](int col, int row) { return col == 6 && row == 5 ? -255.f : 0.f; }},
      {"wall", [](int, int row) { return row == 4 ? 10.f : 0.f; }},
      {"comb", [](int col, int) { return col % 2 ? 1.f : 0.f; }},
      {"checkerboard", [](int col, int row) { return (col + row) % 2 ? 1.f : 0.f; }},
      {"terraces", [](int col, int row) { return static_cast<float>((col + row) / 3); }},
      {"stairs up to the east", [](int col, int) { return static_cast<float>(col * col); }},
      {"two levels", steps(1, 2)},
      {"three levels", steps(2, 3)},
      {"ten levels", steps(3, 10)},
      {"rough", rough(4, 10)},
      {"rough and high", [shape = rough(5, 30)](int col, int row) { return 8000 + shape(col, row); }},
      {"very rough", rough(6, 10000)},
      {"almost flat", rough(7, kMicrometre)},
  };
  return all;
}

}  // namespace

std::vector<MapField> map_fields() {
  std::vector<MapField> fields;
  const auto add = [&](std::string name, HeightField field) { fields.push_back({std::move(name), std::move(field)}); };
  for (const auto& [name, shape] : shapes()) {
    add(name, sampled(13, 12, 1, 1, shape));
    add(name + ", oblong cells", sampled(9, 16, 30, 10, shape));
  }
  // Holes: scattered, a moat, everything except a cross, one corner.
  for (unsigned every : {2u, 3u, 7u, 20u}) {
    add("scattered holes", sampled(12, 11, 2, 2, with_holes(steps(every, 4), every, every)));
    add("rough with holes", sampled(11, 14, 1, 3, with_holes(rough(every, 9), every + 1, every)));
  }
  add("moat", sampled(13, 13, 1, 1, [](int col, int row) {
        const int ring = std::max(std::abs(col - 6), std::abs(row - 6));
        return ring == 3 ? kHole : ring > 3 ? 9.f : 0.f;
      }));
  add("cross", sampled(11, 11, 1, 1, [](int col, int row) { return col == 5 || row == 5 ? 1.f : kHole; }));
  add("hole in a corner",
      sampled(8, 8, 1, 1, [](int col, int row) { return col + row == 0 ? kHole : static_cast<float>(col); }));
  add("hole in a wall",
      sampled(9, 9, 1, 1, [](int col, int row) { return row == 4 ? (col == 4 ? kHole : 5.f) : 0.f; }));
  // Sizes: single samples, rows and columns; powers of two and one more; primes.
  const std::pair<int, int> sizes[] = {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {2, 17}, {16, 16}, {17, 17}, {23, 19}};
  for (const auto& [cols, rows] : sizes) add("steps", sampled(cols, rows, 1, 1, steps(11, 5)));
  // 16-bit samples with a scale.
  std::vector<std::int16_t> samples;
  std::mt19937 random(12);
  for (int i = 0; i < 12 * 12; ++i) samples.push_back(static_cast<std::int16_t>(random() % 9));
  add("decimetres",
      HeightField::own(samples, 12, 12, {.cell_x = 7, .cell_y = 7, .scale = 0.1, .offset = -3, .nodata = 8}));
  return fields;
}

std::vector<Node> map_observers(const HeightField& field) {
  const int cols = field.cols(), rows = field.rows();
  std::vector<Node> observers;
  const SightGround ground(field);
  for (const Node node :
       {Node{0, 0}, {cols - 1, 0}, {0, rows - 1}, {cols / 2, rows / 2}, {cols / 3, rows - 1}, {cols - 1, rows / 2}})
    if (ground.height(node) && std::find(observers.begin(), observers.end(), node) == observers.end())
      observers.push_back(node);
  return observers;
}

std::vector<ViewshedSettings> map_settings() {
  ViewshedSettings on_ground{.observer_height = 0, .curvature = {.coefficient = 0}};
  ViewshedSettings person{.observer_height = 1.75, .target_height = 1};
  ViewshedSettings tower{.observer_height = 40, .curvature = {.coefficient = 1, .diameter = 500}};
  ViewshedSettings aircraft{.observer_z = 1e7};
  ViewshedSettings limited{
      .min_distance = 3, .max_distance = 8, .first_azimuth = 5, .last_azimuth = 2, .low_pitch = -1};
  return {on_ground, person, tower, aircraft, limited};
}

std::vector<SunDirection> map_suns() {
  constexpr double kDegree = std::numbers::pi / 180;
  std::vector<SunDirection> suns;
  for (const double azimuth : {0, 45, 90, 135, 180, 225, 270, 315}) suns.push_back({azimuth * kDegree, 30 * kDegree});
  for (const double azimuth : {1, 63, 200, 333}) suns.push_back({azimuth * kDegree, 5 * kDegree});
  // Rays that fall by exactly one metre per metre, where grazing counts.
  suns.push_back({90 * kDegree, std::atan(1.0)});
  suns.push_back({2.5, 89 * kDegree});
  suns.push_back({2.5, std::numbers::pi / 2});
  suns.push_back({-1, kGrazingSun});
  return suns;
}

}  // namespace scarp::test
