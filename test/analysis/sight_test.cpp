// SPDX-License-Identifier: MIT
// Lines of sight, profiles, and maps whose answer is known by geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include "analysis/map_fields.h"
#include "analysis/slow_judge.h"
#include "cases.h"
#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/profile.h"
#include "scarp/analysis/sight_parts.h"
#include "scarp/analysis/visible_lines.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const SightCurvature kFlat{.coefficient = 0};
// In metres: 16 roundings of numbers below 2^17, which heights and drops in these fields do not exceed.
constexpr double kHeightRounding = 0x1p17 * 16 * 0x1p-53;

HeightField field_of(int cols, int rows, double cell, const std::function<double(int, int)>& height) {
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) samples.push_back(static_cast<float>(height(col, row)));
  return HeightField::own(std::move(samples), cols, rows, {.cell_x = cell, .cell_y = cell});
}

// A position in the field, rounded as lines of sight are.
SightEnd random_end(const HeightField& field, std::mt19937& random) {
  const auto along = [&](int samples) {
    const auto steps = static_cast<unsigned>((samples - 1) * kSubcells);
    // Nodes and grid lines are as frequent as positions between them.
    const auto place = static_cast<unsigned>(random() % (steps + 1));
    constexpr auto kCell = static_cast<unsigned>(kSubcells);
    return (random() % 2 ? place / kCell * kCell : place) / static_cast<double>(kCell);
  };
  return {along(field.cols()), along(field.rows()), static_cast<double>(random() % 3)};
}

TEST(LineOfSight, CellsOfALineAreThoseOfAFieldWithThem) {
  std::mt19937 random(5);
  const auto height = [&](int, int) { return static_cast<double>(random() % 9); };
  const HeightField field = field_of(70, 80, 10, height);
  const BlockMaxima maxima(field);
  HeightFieldSettings settings = field.settings();
  settings.cell_x = 12.5, settings.cell_y = 9.25;
  const HeightField other = field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
  const SightCurvature curvature{.coefficient = 1, .diameter = 3e4};
  const dvec2 cells{12.5, 9.25};
  int different = 0;
  for (int i = 0; i < cases(200, 30, 6); ++i) {
    const SightEnd from = random_end(field, random), to = random_end(field, random);
    const LineOfSight wanted = line_of_sight(other, from, to, curvature);
    for (const BlockMaxima* skipped : {static_cast<const BlockMaxima*>(nullptr), &maxima}) {
      const LineOfSight found = line_of_sight(field, from, to, curvature, skipped, cells);
      ASSERT_EQ(wanted.visible, found.visible);
      ASSERT_EQ(wanted.distance, found.distance);
      ASSERT_EQ(wanted.clearance, found.clearance);
      ASSERT_EQ(wanted.target, found.target);
    }
    different += line_of_sight(field, from, to, curvature).distance != wanted.distance;
  }
  EXPECT_GT(different, 0);
  EXPECT_THROW(line_of_sight(field, {.col = 1}, {.col = 3}, {}, nullptr, dvec2(0, 1)), Error);
  EXPECT_THROW(line_of_sight(field, {.col = 1}, {.col = 3}, {}, nullptr, dvec2(1, NAN)), Error);
}

TEST(LineOfSight, MatchesTheJudgeEverywhere) {
  std::mt19937 random(1);
  int visible = 0, blocked = 0;
  for (const MapField& kind : map_fields())
    for (int i = 0; i < cases(200, 30, 6); ++i) {
      const SightEnd from = random_end(kind.field, random), to = random_end(kind.field, random);
      const SightCurvature curvature{.coefficient = i % 2 ? 1. : 0., .diameter = 300};
      try {
        const SightLine line(kind.field, from, to, curvature);
        const LineOfSight answer = line_of_sight(kind.field, from, to, curvature);
        const bool judged = judge_line(line.ground(), from.col, from.row, line.eye(), to.col, to.row, line.target());
        ASSERT_EQ(answer.visible, judged)
            << kind.name << ": " << from.col << "," << from.row << " to " << to.col << "," << to.row;
        EXPECT_EQ(answer.visible, !answer.obstruction);
        // Clearance is rounded; its sign is that of the answer except for grazing lines.
        if (std::abs(answer.clearance) > kHeightRounding) {
          EXPECT_EQ(answer.clearance > 0, answer.visible);
        }
        ++(judged ? visible : blocked);
      } catch (const Error&) {  // an end on a hole
      }
    }
  EXPECT_GT(visible, 100);
  EXPECT_GT(blocked, 100);
}

// Parts of 1 to 40 cells; lines along and between grid lines, over holes and ties.
TEST(LineOfSight, IsTheSameOverParts) {
  std::mt19937 random(11);
  int blocked = 0, lines = 0;
  for (const MapField& kind : map_fields())
    for (int i = 0; i < cases(200, 30, 6); ++i) {
      const HeightField& field = kind.field;
      const SightEnd from = random_end(field, random), to = random_end(field, random);
      const SightCurvature curvature{.coefficient = i % 2 ? 1. : 0., .diameter = 300};
      const SightParts parts(field.cols(), field.rows(), static_cast<int>(1 + random() % 40));
      const auto read = [&](const NodeRect& nodes) {
        return field.visit([&](const auto& grid) {
          return HeightField::view(grid.row(nodes.row_begin) + nodes.col_begin, nodes.col_end - nodes.col_begin,
                                   nodes.row_end - nodes.row_begin, field.settings(), grid.row_stride);
        });
      };
      std::optional<LineOfSight> expected;
      std::optional<FresnelClearance> zone;
      std::string expected_error, error;
      try {
        expected = line_of_sight(field, from, to, curvature);
        zone = fresnel_clearance(SightLine(field, from, to, curvature), 0.05);
      } catch (const Error& bad) {
        expected_error = bad.what();
      }
      try {
        const SightAnswer answer = parts.answer(from, to, curvature, 0.05, read);
        ASSERT_TRUE(expected) << kind.name;
        ++lines, blocked += !answer.line.visible;
        EXPECT_EQ(answer.line.visible, expected->visible);
        EXPECT_EQ(answer.line.distance, expected->distance);
        EXPECT_EQ(answer.line.eye, expected->eye);
        EXPECT_EQ(answer.line.target, expected->target);
        EXPECT_EQ(answer.line.clearance, expected->clearance);
        EXPECT_EQ(answer.line.clearance_along, expected->clearance_along);
        EXPECT_EQ(answer.fresnel.share, zone->share);
        EXPECT_EQ(answer.fresnel.along, zone->along);
        ASSERT_EQ(answer.line.obstruction.has_value(), expected->obstruction.has_value());
        if (!expected->obstruction) continue;
        EXPECT_EQ(answer.line.obstruction->along, expected->obstruction->along);
        EXPECT_EQ(answer.line.obstruction->col, expected->obstruction->col);
        EXPECT_EQ(answer.line.obstruction->row, expected->obstruction->row);
        EXPECT_EQ(answer.line.obstruction->height, expected->obstruction->height);
      } catch (const Error& bad) {
        error = bad.what();
      }
      EXPECT_EQ(error.empty(), expected_error.empty()) << error << expected_error;
    }
  EXPECT_GT(blocked, 100);
  EXPECT_GT(lines - blocked, 100);
}

// Skipping does not change the answer, on fields of several blocks and with holes.
TEST(LineOfSight, IsUnchangedByMaxima) {
  std::mt19937 random(3);
  const auto ridges = [](int col, int row) {
    return 30 * std::sin(0.11 * col) * std::cos(0.07 * row) + (col * row) % 3;
  };
  for (const bool holes : {false, true}) {
    const auto field = field_of(300, 290, 10, [&](int col, int row) {
      return holes && (col * 7 + row * 3) % 5 == 0 ? std::nan("") : ridges(col, row);
    });
    const BlockMaxima maxima(field);
    int visible = 0, blocked = 0;
    for (int i = 0; i < cases(20000, 2000, 300); ++i) {
      SightEnd from = random_end(field, random), to = random_end(field, random);
      from.height = i % 3 * 20;
      to.height = i % 5 * 10;
      const SightCurvature curvature{.coefficient = 1, .diameter = i % 2 ? 1.3e7 : 1e5};
      try {
        const LineOfSight slow = line_of_sight(field, from, to, curvature);
        const LineOfSight fast = line_of_sight(field, from, to, curvature, &maxima);
        ASSERT_EQ(slow.visible, fast.visible);
        ASSERT_EQ(slow.clearance, fast.clearance);
        if (slow.obstruction) {
          ASSERT_EQ(slow.obstruction->along, fast.obstruction->along);
        }
        ++(slow.visible ? visible : blocked);
      } catch (const Error&) {
      }
    }
    EXPECT_GT(visible, 20);
    EXPECT_GT(blocked, 20);
  }
}

// On small fields with ties and holes, and on fields of several blocks.
TEST(VisibleLines, MatchLinesOfSight) {
  std::mt19937 random(4);
  auto fields = map_fields();
  const auto ridges = [](int col, int row) {
    return 30 * std::sin(0.11 * col) * std::cos(0.07 * row) + (col * row) % 3;
  };
  fields.push_back({"ridges", field_of(300, 290, 10, ridges)});
  fields.push_back({"ridges with holes", field_of(290, 300, 10, [&](int col, int row) {
                      return (col * 7 + row * 3) % 5 == 0 ? std::nan("") : ridges(col, row);
                    })});
  std::size_t visible = 0, blocked = 0;
  for (const MapField& kind : fields) {
    const BlockMaxima maxima(kind.field);
    const int count = kind.field.cols() > 100 ? cases(20000, 4000, 400) : cases(400, 100, 20);
    for (const double coefficient : {0., 1.}) {
      const SightCurvature curvature{coefficient, kind.field.cols() > 100 ? 1e5 : 300};
      std::vector<LineEnds> lines;
      std::vector<char> expected;
      for (int i = 0; i < count; ++i) {
        LineEnds ends{random_end(kind.field, random), random_end(kind.field, random)};
        if (i % 4 == 0) ends.from.height = ends.to.height = 25;
        try {
          expected.push_back(line_of_sight(kind.field, ends.from, ends.to, curvature).visible);
          lines.push_back(ends);
        } catch (const Error&) {  // an end on a hole
        }
      }
      const auto answers = visible_lines(kind.field, lines, maxima, curvature);
      ASSERT_EQ(answers.size(), expected.size());
      for (std::size_t i = 0; i < answers.size(); ++i)
        ASSERT_EQ(answers[i], expected[i]) << kind.name << ": " << lines[i].from.col << "," << lines[i].from.row
                                           << " to " << lines[i].to.col << "," << lines[i].to.row;
      const auto seen = static_cast<std::size_t>(std::count(answers.begin(), answers.end(), 1));
      visible += seen;
      blocked += answers.size() - seen;
    }
  }
  EXPECT_GT(visible, 500u);
  EXPECT_GT(blocked, 500u);
}

TEST(LineOfSight, IsReciprocal) {
  std::mt19937 random(2);
  for (const MapField& kind : map_fields())
    for (int i = 0; i < cases(200, 40, 10); ++i) {
      const SightEnd from = random_end(kind.field, random), to = random_end(kind.field, random);
      try {
        const LineOfSight there = line_of_sight(kind.field, from, to, kFlat),
                          back = line_of_sight(kind.field, to, from, kFlat);
        ASSERT_EQ(there.visible, back.visible) << kind.name;
        const SightCurvature round{.coefficient = 1, .diameter = 1000};
        const LineOfSight over = line_of_sight(kind.field, from, to, round);
        // With curvature, results agree except within the rounding of the lowered heights.
        if (std::abs(over.clearance) > kHeightRounding) {
          ASSERT_EQ(over.visible, line_of_sight(kind.field, to, from, round).visible);
        }
      } catch (const Error&) {
      }
    }
}

TEST(LineOfSight, AgreesWithTheViewshedAtNodes) {
  const MapField kind = map_fields()[36];
  for (const Node observer : map_observers(kind.field)) {
    const ViewshedSettings settings{.observer_height = 1, .target_height = 0.5};
    const auto codes = viewshed(kind.field, observer, settings);
    for (int row = 0; row < kind.field.rows(); ++row)
      for (int col = 0; col < kind.field.cols(); ++col) {
        const auto line =
            line_of_sight(kind.field, {1. * observer.col, 1. * observer.row, 1}, {1. * col, 1. * row, 0.5});
        EXPECT_EQ(line.visible, codes[static_cast<std::size_t>(row * kind.field.cols() + col)] == Seen::visible);
      }
  }
}

TEST(LineOfSight, FindsTheObstruction) {
  const auto field = field_of(101, 5, 10, [](int col, int) { return col == 40 ? 50. : 0.; });
  const auto line = line_of_sight(field, {0, 2, 10}, {100, 2, 0}, kFlat);
  ASSERT_FALSE(line.visible);
  // The slope up to the wall rises above the line of sight before the wall; the first crossing above it is the wall.
  EXPECT_DOUBLE_EQ(line.obstruction->col, 40);
  EXPECT_DOUBLE_EQ(line.obstruction->height, 50);
  EXPECT_DOUBLE_EQ(line.clearance, 10 * 0.6 - 50);
  EXPECT_DOUBLE_EQ(line.distance, 1000);
}

TEST(LineOfSight, RejectsBadEndpoints) {
  const auto field = HeightField::own(std::vector<float>{1, 2, 3, std::nanf(""), 5, 6}, 3, 2);
  EXPECT_NO_THROW(line_of_sight(field, {0, 0}, {2, 0}));
  EXPECT_THROW(line_of_sight(field, {0, 0}, {2.01, 0}), Error);
  EXPECT_THROW(line_of_sight(field, {0, -0.01}, {2, 0}), Error);
  EXPECT_THROW(line_of_sight(field, {std::nan(""), 0}, {2, 0}), Error);
  EXPECT_THROW(line_of_sight(field, {0, 1}, {2, 0}), Error);  // a hole
  EXPECT_NO_THROW(line_of_sight(field, {0, 1, 50, HeightDatum::sea}, {2, 0}));
  EXPECT_THROW(line_of_sight(field, {0, 0, 0.5, HeightDatum::sea}, {2, 0}), Error);  // below ground
  EXPECT_THROW(line_of_sight(field, {0, 0, -1}, {2, 0}), Error);
}

TEST(Profile, ListsEachCrossingOnceWithItsGroundHeight) {
  const auto field = field_of(30, 20, 10, [](int col, int row) { return 3. * col - 2. * row; });
  const SightLine line(field, {1, 2, 5}, {25, 14, 5}, {.coefficient = 1, .diameter = 1e4});
  const auto points = profile(line);
  // 23 column lines and 11 row lines between the ends; 11 column and row crossings coincide at nodes; plus the two
  // ends.
  EXPECT_EQ(points.size(), 23u + 11 - 11 + 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].ground, 3 * points[i].col - 2 * points[i].row, kHeightRounding);
    if (i > 0) {
      EXPECT_GT(points[i].along, points[i - 1].along);
    }
  }
  EXPECT_DOUBLE_EQ(points.back().distance, line.distance());
}

TEST(Profile, HidesGroundBehindTheRidge) {
  const auto field = field_of(11, 3, 10, [](int col, int) { return col == 5 ? 20. : 0.; });
  const auto points = profile(SightLine(field, {0, 1, 2}, {10, 1, 0}, kFlat));
  for (const ProfilePoint& p : points) EXPECT_EQ(p.visible, p.col <= 5) << p.col;
}

TEST(Profile, MarksHoles) {
  const auto field = field_of(11, 3, 10, [](int col, int) { return col == 4 || col == 5 ? std::nan("") : 0.; });
  for (const double row : {1., 0.5}) {
    const auto points = profile(SightLine(field, {0, row, 2}, {10, row, 2}, kFlat));
    EXPECT_EQ(points.size(), 9u);
    for (const ProfilePoint& p : points) EXPECT_EQ(p.after_hole, p.col == 6) << p.col;
  }
  // An end on a hole.
  const auto points = profile(SightLine(field, {0, 1, 2}, {5, 1, 2, HeightDatum::sea}, kFlat));
  ASSERT_EQ(points.size(), 5u);
  for (const ProfilePoint& p : points) EXPECT_EQ(p.after_hole, p.col == 5) << p.col;
}

TEST(Viewshed, SeesAllOfAPlaneFromAbove) {
  const auto field = field_of(40, 30, 5, [](int col, int row) { return 2. * col + row; });
  for (const double height : {0., 2.})
    for (const Seen code : viewshed(field, {7, 11}, {.observer_height = height, .curvature = kFlat}))
      EXPECT_EQ(code, Seen::visible);
}

// An eye at the height of a cone's base sees the part of its flank that faces it: up to the tangents from the eye to
// the base, where the cosine of the angle around the axis is radius over distance. From the tip it sees everything.
TEST(Viewshed, SeesTheNearSideOfACone) {
  const auto field =
      field_of(81, 81, 10, [](int col, int row) { return std::max(0., 200 - 10 * std::hypot(col - 40, row - 40)); });
  const auto codes = viewshed(field, {40, 78}, {.observer_height = 0.01, .curvature = kFlat});
  const double tangent = 20. / 38, margin = 0.1;  // the flank is made of facets
  for (int row = 20; row <= 60; ++row) {
    for (int col = 20; col <= 60; ++col) {
      const double radius = std::hypot(col - 40, row - 40), cosine = (row - 40) / radius;
      if (radius < 2 || radius > 19 || std::abs(cosine - tangent) < margin) continue;
      EXPECT_EQ(codes[static_cast<std::size_t>(row * 81 + col)], cosine > tangent ? Seen::visible : Seen::hidden)
          << col << "," << row;
    }
  }
  EXPECT_EQ(codes[40 + 81 * 2], Seen::hidden);
  for (const Seen code : viewshed(field, {40, 40}, {.observer_height = 1, .curvature = kFlat}))
    EXPECT_EQ(code, Seen::visible);
}

// The foot of a cliff of height H is hidden from an eye of height e, a cells behind its edge, up to a H / e cells.
TEST(Viewshed, HidesTheFootOfACliff) {
  const auto field = field_of(100, 3, 10, [](int col, int) { return col <= 10 ? 30. : 0.; });
  const auto codes = viewshed(field, {5, 1}, {.observer_height = 5, .curvature = kFlat});
  // Ray over the edge at column 10: falls 5 m in 5 cells, so it reaches the foot 35 cells from the observer.
  for (int col = 11; col < 100; ++col)
    EXPECT_EQ(codes[static_cast<std::size_t>(100 + col)], col < 40 ? Seen::hidden : Seen::visible) << col;
}

// Over a flat sea the horizon is at sqrt(2 R h / cc) = sqrt(D h / cc).
TEST(Viewshed, EndsAtTheSeaHorizon) {
  const double cell = 100, height = 25;
  const SightCurvature curvature;
  const auto field = field_of(400, 1, cell, [](int, int) { return 0.; });
  const double horizon = std::sqrt(curvature.diameter * height / curvature.coefficient);
  const auto codes = viewshed(field, {0, 0}, {.observer_height = height, .curvature = curvature});
  const auto hidden = std::find(codes.begin(), codes.end(), Seen::hidden) - codes.begin();
  EXPECT_NEAR(static_cast<double>(hidden) * cell, horizon, 1.5 * cell);
  EXPECT_TRUE(std::all_of(codes.begin() + hidden, codes.end(), [](Seen code) { return code == Seen::hidden; }));
  // A mast beyond the horizon is visible from the height (d - horizon)^2 cc / D.
  const auto least = least_visible(field, {0, 0}, {.observer_height = height, .curvature = curvature});
  const SightGround ground(field, 0, 0, curvature);
  const double beyond = 390 * cell - horizon;
  EXPECT_NEAR(least_height(ground, {390, 0}, least[390], HeightDatum::ground),
              beyond * beyond * curvature.coefficient / curvature.diameter, 0.05);
}

TEST(Viewshed, IsMonotoneInTargetHeightAndNestedInDistance) {
  for (const MapField& kind : map_fields()) {
    const Node observer = map_observers(kind.field).front();
    std::vector<Seen> lower;
    for (const double height : {0., 0.5, 3., 100.}) {
      const auto codes = viewshed(kind.field, observer, {.target_height = height});
      for (std::size_t i = 0; i < lower.size(); ++i)
        if (lower[i] == Seen::visible) {
          EXPECT_EQ(codes[i], Seen::visible);
        }
      lower = codes;
    }
    const auto all = viewshed(kind.field, observer, {.target_height = 100});
    const auto near = viewshed(kind.field, observer, {.target_height = 100, .max_distance = 6});
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_TRUE(near[i] == all[i] || near[i] == Seen::out_of_range);
  }
}

// Least heights decide visibility: a target is visible at that height and above, but not one double below it.
TEST(Viewshed, LeastVisibleHeightsAreTight) {
  for (const MapField& kind : map_fields()) {
    const Node observer = map_observers(kind.field).front();
    const Viewpoint view(kind.field, observer, {});
    const auto least = least_visible(kind.field, observer, view.settings());
    for (std::size_t i = 0; i < least.size(); ++i) {
      if (!std::isfinite(least[i])) continue;
      const int col = static_cast<int>(i) % kind.field.cols(), row = static_cast<int>(i) / kind.field.cols();
      EXPECT_TRUE(judge_line(view.ground(), observer.col, observer.row, view.eye(), col, row, least[i]));
      EXPECT_FALSE(judge_line(view.ground(), observer.col, observer.row, view.eye(), col, row,
                              std::nextafter(least[i], -1e300)));
      if (i > 40) break;
    }
  }
}

// Mirror images of the field have mirror images of the map.
TEST(Maps, MirroredFieldsGiveMirroredMaps) {
  const auto height = [](int col, int row) { return std::fmod(7.3 * col * col + 3.1 * row * row + col * row, 9.); };
  const int n = 21;
  const auto plain = field_of(n, n, 3, height);
  const auto mirrored = field_of(n, n, 3, [&](int col, int row) { return height(n - 1 - col, row); });
  const auto turned = field_of(n, n, 3, [&](int col, int row) { return height(row, col); });
  const ViewshedSettings settings{.observer_height = 1};
  const auto seen = viewshed(plain, {4, 9}, settings), seen_mirrored = viewshed(mirrored, {n - 1 - 4, 9}, settings),
             seen_turned = viewshed(turned, {9, 4}, settings);
  const auto lit = shadow(plain, {50 * kDegree, 20 * kDegree}),
             lit_mirrored = shadow(mirrored, {-50 * kDegree, 20 * kDegree});
  for (int row = 0; row < n; ++row)
    for (int col = 0; col < n; ++col) {
      const auto at = [&](int c, int r) { return static_cast<std::size_t>(r * n + c); };
      EXPECT_EQ(seen[at(col, row)], seen_mirrored[at(n - 1 - col, row)]);
      EXPECT_EQ(seen[at(col, row)], seen_turned[at(row, col)]);
      EXPECT_EQ(lit[at(col, row)], lit_mirrored[at(n - 1 - col, row)]);
    }
}

TEST(Maps, DoNotDependOnThreads) {
  const auto field =
      field_of(60, 50, 4, [](int col, int row) { return 5 * std::sin(0.7 * col) * std::cos(0.4 * row); });
  const auto seen = viewshed(field, {20, 20});
  const auto lit = shadow(field, {1, 0.3});
  const ThreadLimit one(1);
  EXPECT_EQ(viewshed(field, {20, 20}), seen);
  EXPECT_EQ(shadow(field, {1, 0.3}), lit);
}

// The length of a pillar's shadow is its height divided by the tangent of the sun's altitude; its width is at most one
// cell.
TEST(Shadow, MatchesAPillar) {
  const double height = 50, cell = 2, altitude = 30 * kDegree;
  const auto field = field_of(80, 21, cell, [&](int col, int row) { return col == 60 && row == 10 ? height : 0.; });
  const auto codes = shadow(field, {90 * kDegree, altitude});
  const double length = height / std::tan(altitude) / cell;
  for (int row = 0; row < 21; ++row)
    for (int col = 0; col < 80; ++col) {
      const Shade code = codes[static_cast<std::size_t>(row * 80 + col)];
      const int away = 60 - col;
      if (row != 10 || away <= 0 || away > length) {
        EXPECT_EQ(code, Shade::lit) << col << "," << row;
      } else {
        EXPECT_EQ(code, away == 1 ? Shade::self_shaded : Shade::cast_shadow) << col;
      }
    }
}

// A plane that rises towards the sun is self-shaded where it is steeper than the sun's rays, and lit otherwise.
TEST(Shadow, MatchesAPlane) {
  const auto field = field_of(20, 20, 10, [](int col, int) { return 10. * col; });
  const auto count = [](const std::vector<Shade>& codes, Shade code) {
    return std::count(codes.begin(), codes.end(), code);
  };
  // The last column has no ground behind it.
  EXPECT_EQ(count(shadow(field, {90 * kDegree, 44.9 * kDegree}), Shade::self_shaded), 19 * 20);
  EXPECT_EQ(count(shadow(field, {90 * kDegree, 45.1 * kDegree}), Shade::lit), 20 * 20);
  EXPECT_EQ(count(shadow(field, {270 * kDegree, 1 * kDegree}), Shade::lit), 20 * 20);
}

}  // namespace
}  // namespace scarp::test
