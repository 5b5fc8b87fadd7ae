// SPDX-License-Identifier: MIT
// Fields and azimuths for tests of horizons.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "scarp/analysis/horizon.h"

namespace scarp::test {

struct HorizonShape {
  HeightField field;
  float eye;
  HorizonSettings settings;
};

// Fields that tempt a march to skip too much or too little, of 8 kinds.
constexpr int kShapes = 48;
inline HorizonShape shape(int number) {
  std::mt19937 random(static_cast<unsigned>(number) + 1);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  const int cols = 1 + below(90), rows = number % 9 == 8 ? 1 : 1 + below(90);
  std::vector<float> heights;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const float noise = static_cast<float>(below(65536)) / 65536;
      const std::array<float, 8> kinds{
          50 * noise,
          7,
          col > cols / 2 ? 300.0f : 0.0f,
          static_cast<float>(30 * std::abs(row - rows / 2)),
          1e6f + noise,
          below(37) == 0 ? 4000.0f : 0.0f,
          std::ldexp(below(2) ? 1.0f : -1.0f, below(40) - 20),
          30 * std::sin(0.2f * static_cast<float>(col)) * std::cos(0.13f * static_cast<float>(row))};
      const bool hole = (number % 3 == 1 || number % 6 == 5) && below(14) == 0;
      heights.push_back(hole ? std::numeric_limits<float>::quiet_NaN() : kinds[static_cast<std::size_t>(number % 8)]);
    }
  }
  HeightFieldSettings settings{.cell_x = 25, .cell_y = 25};
  if (number % 2 == 1) settings.cell_x = 10 + below(30), settings.cell_y = 10 + below(30);
  // Azimuths of 45 degrees then meet every second or third node, and cross holes beside them.
  if (number % 6 == 1) settings.cell_x = 10, settings.cell_y = 30;
  if (number % 6 == 5) settings.cell_x = 20, settings.cell_y = 30;
  HorizonShape made{HeightField::own(std::move(heights), cols, rows, settings), number % 5 == 0 ? 2.0f : 0.0f, {}};
  made.settings.eye_height = static_cast<double>(made.eye);
  if (number % 7 == 6) made.settings.max_distance = 400;
  if (number % 4 == 3) made.settings.curvature.coefficient = 0.5, made.settings.curvature.diameter = 1e4;
  if (number % 4 == 1) made.settings.curvature.coefficient = 0;
  return made;
}

// Axes, diagonals, beside them, and between.
constexpr int kAzimuths = 21;
inline double azimuth(int number) {
  // Far more than the rounding of an angle, and less than a float's weight can tell within a few cells.
  constexpr double kBeside = 0x1p-23;
  if (number < 8) return number * std::numbers::pi / 4;
  if (number < 12) return (number - 8) * std::numbers::pi / 4 + kBeside;
  if (number == 12) return std::atan(0.5);
  if (number == 20) return std::atan(1.0 / 3);
  std::mt19937 random(static_cast<unsigned>(number));
  return static_cast<double>(random()) / 4294967296.0 * 2 * std::numbers::pi;
}

// Unoptimised code under sanitizers takes fifty times as long: there, each azimuth meets one field of each kind.
#ifdef NDEBUG
constexpr int kFieldsPerKind = 6;
#else
constexpr int kFieldsPerKind = 1;
#endif
inline bool is_drawn(int shape, int azimuth) { return (shape / 8 + azimuth) % 6 < kFieldsPerKind; }

}  // namespace scarp::test
