// SPDX-License-Identifier: MIT
// Maps of more than 2048 x 2048 nodes, checked at random nodes: each against one ray, some also against the slow judge.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "analysis/slow_judge.h"
#include "cases.h"
#include "scarp/analysis/sight_rays.h"

namespace scarp::test {
namespace {

// Ridges in two directions with whole metres of roughness, so that ties occur; an eighth of the nodes of a stripe are
// holes. Oblong cells.
HeightField large_field() {
  const int cols = cases(2113, 2113, 301), rows = cases(2087, 2087, 283);
  std::mt19937 random(1);
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double ridges = 300 * std::sin(0.011 * col + 0.004 * row) * std::cos(0.007 * row - 0.002 * col);
      const auto bits = random();
      const bool hole = std::abs(col - row) < 40 && bits % 8 == 0;
      samples.push_back(hole ? std::nanf("")
                             : static_cast<float>(std::floor(ridges) + static_cast<double>((bits >> 8) % 6)));
    }
  }
  return HeightField::own(std::move(samples), cols, rows, {.cell_x = 20, .cell_y = 25});
}

struct RandomNodes {
  std::mt19937 random{2};
  Node next(const HeightField& field) {
    const int col = static_cast<int>(random() % static_cast<unsigned>(field.cols()));
    return {col, static_cast<int>(random() % static_cast<unsigned>(field.rows()))};
  }
};

std::size_t index_in(const HeightField& field, Node node) {
  return static_cast<std::size_t>(node.row) * static_cast<std::size_t>(field.cols()) +
         static_cast<std::size_t>(node.col);
}

std::string text_of(Node node) { return "column " + std::to_string(node.col) + ", row " + std::to_string(node.row); }

TEST(LargeMaps, ViewshedsMatchRaysAndTheJudge) {
  const HeightField field = large_field();
  const Viewpoint view(field, {field.cols() / 3, field.rows() / 2 + 50}, {.observer_height = 30, .target_height = 1});
  const auto codes = viewshed(field, view.observer(), view.settings());
  RandomNodes nodes;
  const int rays = cases(100'000, 20'000, 500), judged = cases(500, 50, 5);
  int visible = 0;
  for (int i = 0; i < rays; ++i) {
    const Node node = nodes.next(field);
    const Seen code = codes[index_in(field, node)];
    const auto lowered = view.ground().lowered(node);
    const bool seen = lowered && sees(view.ground(), view.observer(), view.eye(), node, view.target(*lowered));
    ASSERT_EQ(code, !lowered ? Seen::hole : seen ? Seen::visible : Seen::hidden) << text_of(node);
    if (i < judged) {
      ASSERT_EQ(code, judge_seen(view, node)) << text_of(node);
    }
    visible += seen;
  }
  EXPECT_GT(visible, rays / 50);
  EXPECT_LT(visible, rays / 2);
}

TEST(LargeMaps, ShadowsMatchRaysAndTheJudge) {
  const HeightField field = large_field();
  const SightGround ground(field);
  const SunDirection sun{2, 0.1};
  const SunRay ray = sun_ray(field, sun);
  const auto codes = shadow(field, sun);
  RandomNodes nodes;
  const int rays = cases(100'000, 20'000, 500), judged = cases(500, 50, 5);
  int lit = 0;
  for (int i = 0; i < rays; ++i) {
    const Node node = nodes.next(field);
    const Shade code = codes[index_in(field, node)];
    ASSERT_EQ(code, shade(ground, ray, node)) << text_of(node);
    if (i < judged) {
      ASSERT_EQ(code, judge_shade(ground, ray, node)) << text_of(node);
    }
    lit += code == Shade::lit;
  }
  EXPECT_GT(lit, rays / 10);
  EXPECT_LT(lit, rays * 9 / 10);
}

}  // namespace
}  // namespace scarp::test
