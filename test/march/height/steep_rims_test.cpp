// SPDX-License-Identifier: MIT
// Nearly vertical rays at borders and rims of holes: they hit at the height of the rim, by every query.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "scarp/field/ground_points.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/height/rounding.h"

namespace scarp::test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kSeamOfScenes = 0x1p-26;

const double kCosineOf90 = std::cos(std::numbers::pi / 2);
// Fields have a relief of 5 at most, and rays start at 20 at most.
constexpr double kMostRelief = 5, kMostHeight = 20;
// A ray at a border moves over the ground beside it by its slant, 2^-30 at most, in a time of kMostHeight; in cells of
// 0.1 at least. The ground may differ from the edge by this fraction of the relief, and rays fall by 1 per unit of t.
constexpr double kMostLean = 0x1p-30, kLeastCell = 0.1;
constexpr double kOff = kMostLean * kMostHeight / kLeastCell * kMostRelief;

// The cosine of 90 degrees, the noise of rotations, and components too small to move a ray at all.
std::vector<double> leans() {
  std::vector<double> all{0, kCosineOf90, 1e-16, 1e-18, 1e-20, 1e-300};
  for (int power = 0; power <= 970; power += 97) all.push_back(std::ldexp(kMostLean, -power));
  for (const double subnormal : {0x1p-1020, 0x1.8p-1022, 0x1.8p-1023, 5e-324}) all.push_back(subnormal);
  const std::size_t count = all.size();
  for (std::size_t i = 1; i < count; ++i) all.push_back(-all[i]);
  return all;
}

// Rays over one field, and their expected hits.
class SteepRays {
 public:
  explicit SteepRays(const HeightField& field, double seam = 0)
      : field_(field), pyramid_(field), target_{&field_, &pyramid_, std::numeric_limits<double>::quiet_NaN(), seam} {}

  const HeightTarget& target() const { return target_; }
  void expect_hit(const Ray& ray, double t) { rays_.push_back(ray), expected_.push_back(t); }
  // No hit, with any status.
  void expect_none(const Ray& ray) { expect_hit(ray, -1); }

  // Runs all queries; each hit may be up to `off` away in t.
  void check(double off = kOff) const {
    std::vector<Hit> batch(rays_.size()), all;
    std::vector<std::uint8_t> blocked(rays_.size());
    closest_hits(target_, rays_, batch);
    occluded(target_, rays_, blocked);
    int shown = 0;
    for (std::size_t i = 0; i < rays_.size() && shown < 5; ++i) {
      const Ray& ray = rays_[i];
      const double t = expected_[i];
      all_hits_max_mip(target_, ray, all);
      const Hit hits[] = {march_max_mip(target_, ray), march_exhaustive(target_, ray), batch[i],
                          all.empty() ? Hit{} : all[0]};
      bool good = (blocked[i] != 0) == (t >= 0) && occluded_max_mip(target_, ray) == (t >= 0);
      good = good && std::is_sorted(all.begin(), all.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
      for (const Hit& hit : hits) {
        if (t < 0) {
          good = good && !hit;
          continue;
        }
        good = good && hit && std::abs(hit.t - t) <= off && hit.height >= field_.min_height() - off &&
               hit.height <= field_.max_height() + off;
      }
      if (good) continue;
      ++shown;
      ADD_FAILURE() << "ray from " << ray.origin.x << ", " << ray.origin.y << ", " << ray.origin.z << " along "
                    << ray.direction.x << ", " << ray.direction.y << ", " << ray.direction.z << " over cells of "
                    << field_.settings().cell_x << ": expected " << t << ", max-mip "
                    << static_cast<int>(hits[0].status) << " " << hits[0].t << ", exhaustive "
                    << static_cast<int>(hits[1].status) << " " << hits[1].t << ", batch "
                    << static_cast<int>(hits[2].status) << " " << hits[2].t << ", blocked "
                    << static_cast<int>(blocked[i]) << " " << occluded_max_mip(target_, ray);
    }
  }

 private:
  const HeightField& field_;
  MaxPyramid pyramid_;
  HeightTarget target_;
  std::vector<Ray> rays_;
  std::vector<double> expected_;
};

TEST(SteepRims, HitTheBorderWithNearlyVerticalRays) {
  const HeightField flat = HeightField::own(std::vector<float>(81), 9, 9);
  const Ray ray{{-1e-10, 4.5, 10}, {1e-12, 0, -1}};
  SteepRays in_a_scene(flat, kSeamOfScenes), alone(flat);
  in_a_scene.expect_hit(ray, 10);
  in_a_scene.check();
  // Outside of the field by far more than rounding: it enters 90 m below the ground.
  alone.expect_none(ray);
  alone.check();
}

TEST(SteepRims, StartsOnTheBorderFarBelowGroundHitNothing) {
  const HeightField flat = HeightField::own(std::vector<float>(81), 9, 9);
  for (const double seam : {0.0, kSeamOfScenes}) {
    SteepRays rays(flat, seam);
    for (const double lean : leans()) {
      rays.expect_none({{0, 4.5, -500}, {lean, 0, -1}});
      rays.expect_none({{8, 4.5, -500}, {lean, 0, -1}});
      rays.expect_none({{4.5, 0, -500}, {0, lean, -1}});
      rays.expect_none({{4.5, 8, -500}, {0, lean, -1}});
    }
    rays.check();
  }
}

TEST(SteepRims, IgnoreNegligibleTilts) {
  const HeightField flat = HeightField::own(std::vector<float>(81), 9, 9);
  SteepRays rays(flat);
  for (const double lean : leans()) {
    if (std::abs(lean) * kMostHeight > HeightField::rounding_of_line(0, 8)) continue;
    for (const double at : {0.0, 8.0}) {
      rays.expect_hit({{at, 4.5, 10}, {lean, 0, -1}}, 10);
      rays.expect_hit({{4.5, at, 10}, {0, lean, -1}}, 10);
      rays.expect_hit({{at, 8 - at, 10}, {lean, lean, -1}}, 10);
    }
  }
  rays.check();
}

// The height of an edge: samples of both ends at a fraction of its length.
double on_edge(float a, float b, double share) { return a + share * (static_cast<double>(b) - a); }

TEST(SteepRims, HitAllBordersAtTheirEdgeHeight) {
  constexpr int kCols = 11, kRows = 14;
  Random random(7);
  std::vector<float> samples(kCols * kRows);
  for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 5));
  const auto sample = [&](int col, int row) { return samples[static_cast<std::size_t>(row * kCols + col)]; };
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const bool solid : {false, true}) {
      for (const double cell : {1.0, 0.1, 0.3, 0.7, 7.7, 30.7, 92.6, 1.0 / 3}) {
        const HeightField field = HeightField::own(
            samples, kCols, kRows, {.cell_x = cell, .cell_y = cell, .surface = surface, .solid = solid});
        SteepRays rays(field);
        for (const double lean : leans()) {
          const int row = whole(random, 0, kRows - 2), col = whole(random, 0, kCols - 2);
          const double share = uniform(random, 0.01, 0.99), high = uniform(random, 10, 20);
          // On the border, or so far in front of it that the ray is there when it reaches the ground.
          for (const bool before : {false, true}) {
            for (const bool far : {false, true}) {
              const auto add = [&](dvec3 p, dvec3 d, double ground) {
                const double t = high - ground;
                const double moves = std::abs(far == (d.x + d.y > 0) ? lean : 0) * t / cell;
                // Out of the field by more than rounding.
                if (!before && moves > 0x1p-53) return;
                p.z = high;
                rays.expect_hit({before ? dvec3(p.x - d.x * t, p.y - d.y * t, p.z) : p, d}, t);
              };
              const int at_col = far ? kCols - 1 : 0, at_row = far ? 0 : kRows - 1;
              add({at_col * cell, (kRows - 1 - row - share) * cell, 0}, {lean, 0, -1},
                  on_edge(sample(at_col, row), sample(at_col, row + 1), share));
              add({(col + share) * cell, (kRows - 1 - at_row) * cell, 0}, {0, lean, -1},
                  on_edge(sample(col, at_row), sample(col + 1, at_row), share));
            }
          }
        }
        rays.check();
      }
    }
  }
}

// A field with a hole in its middle, or a wrapped one with a hole over its seam.
HeightField with_hole(const std::vector<float>& samples, int side, double cell, Surface surface, bool solid,
                      bool wrapped) {
  std::vector<float> own = samples;
  const int from = wrapped ? -2 : side / 3, to = wrapped ? 2 : 2 * side / 3;
  for (int row = from; row <= to; ++row) {
    for (int col = from; col <= to; ++col)
      own[static_cast<std::size_t>((row + side) % side * side + (col + side) % side)] = kNone;
  }
  return HeightField::own(own, side, side,
                          {.cell_x = cell,
                           .cell_y = cell,
                           .surface = surface,
                           .wrap = wrapped ? Wrap::periodic : Wrap::none,
                           .solid = solid});
}

TEST(SteepRims, HitHoleRimsAtTheirEdgeHeight) {
  constexpr int kSide = 24;
  Random random(8);
  std::vector<float> samples(kSide * kSide);
  for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 5));
  const auto sample = [&](int col, int row) { return samples[static_cast<std::size_t>(row * kSide + col)]; };
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const bool wrapped : {false, true}) {
      for (const double cell : {1.0, 0.1, 0.7, 7.7, 92.6}) {
        const bool solid = cell == 0.7;
        const HeightField field = with_hole(samples, kSide, cell, surface, solid, wrapped);
        SteepRays rays(field);
        // The last column and row of ground before the hole, and the first after it.
        const int first = wrapped ? kSide - 3 : kSide / 3 - 1, last = wrapped ? 3 : 2 * kSide / 3 + 1;
        for (const double lean : leans()) {
          for (const int line : {first, last}) {
            const int along = wrapped ? whole(random, 0, 1) : whole(random, kSide / 3, 2 * kSide / 3 - 1);
            // A quarter of them at nodes.
            const double share = std::max(0.0, uniform(random, -0.33, 0.99)), high = uniform(random, 10, 20);
            const auto add = [&](dvec3 p, dvec3 d, double ground) {
              const double t = high - ground;
              p.x -= d.x * t, p.y -= d.y * t, p.z = high;
              rays.expect_hit({.origin = p, .direction = d, .t_max = 1000}, t);
            };
            add({line * cell, (kSide - 1 - along - share) * cell, 0}, {lean, 0, -1},
                on_edge(sample(line, along), sample(line, along + 1), share));
            add({(along + share) * cell, (kSide - 1 - line) * cell, 0}, {0, lean, -1},
                on_edge(sample(along, line), sample(along + 1, line), share));
          }
        }
        rays.check();
      }
    }
  }
}

// A ray along a rim, slower across it than rounding of the line, sinks through the rim between two nodes.
TEST(SteepRims, AreHitByRaysAlongThem) {
  constexpr int kSide = 24;
  const std::vector<float> flat(kSide * kSide);
  for (const double cell : {1.0, 0.1, 7.7}) {
    for (const bool hole : {false, true}) {
      const HeightField field = hole ? with_hole(flat, kSide, cell, Surface::bilinear, false, false)
                                     : HeightField::own(flat, kSide, kSide, {.cell_x = cell, .cell_y = cell});
      SteepRays rays(field);
      for (const double lean : leans()) {
        if (std::abs(lean) * kSide > HeightField::rounding_of_line(0, kSide)) continue;
        for (const int line : {hole ? kSide / 3 - 1 : 0, hole ? 2 * kSide / 3 + 1 : kSide - 1}) {
          const double middle = (kSide / 2 + 0.3) * cell;
          const dvec3 d(lean * cell, cell, -0.4);
          rays.expect_hit({dvec3(line * cell, middle, 0) - 5.0 * d, d}, 5);
        }
      }
      rays.check();
    }
  }
}

// From the ground into the hole, not steep enough to be followed all the way: by rounding, such rays may cross the line
// above the ground and sink through its height behind it.
TEST(SteepRims, AreHitByRaysThatLeaveTheGround) {
  constexpr int kSide = 24;
  Random random(9);
  std::vector<float> samples(kSide * kSide);
  for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 5));
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const double cell : {1.0, 0.7, 7.7, 92.6}) {
      const HeightField field = with_hole(samples, kSide, cell, surface, false, false);
      SteepRays rays(field);
      for (int i = 0; i < 2000; ++i) {
        const int col = kSide / 3 - 1, row = whole(random, kSide / 3, 2 * kSide / 3 - 1);
        const double share = uniform(random, 0.01, 0.99), high = uniform(random, 10, 20);
        const double ground = on_edge(samples[static_cast<std::size_t>(row * kSide + col)],
                                      samples[static_cast<std::size_t>((row + 1) * kSide + col)], share);
        const dvec3 p(col * cell, (kSide - 1 - row - share) * cell, ground);
        const dvec3 d(std::ldexp(uniform(random, 0.5, 1) * cell, -whole(random, 4, 12)), 0, -(high - ground));
        rays.expect_hit({.origin = p - d, .direction = d, .t_max = 2}, 1);
      }
      // These rays may cross the rim quickly (rounding.h), and they fall by at least 5.
      rays.check(kQuickRim * HeightField::rounding_of_line(kSide, kSide) * kMostRelief / 5);
    }
  }
}

// Level rays that start below the ground, along the rim of the hole and beside it by rounding. They touch the lowest
// nodes from below, which does not count as a hit.
TEST(SteepRims, AreNotHitFromBelow) {
  constexpr int kSide = 24;
  std::vector<float> samples(kSide * kSide, 4);
  const int line = kSide / 3 - 1;
  for (int i = 1; i < kSide; i += 2) {
    samples[static_cast<std::size_t>(i * kSide + line)] = samples[static_cast<std::size_t>(line * kSide + i)] = 0;
  }
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const double cell : {1.0, 0.1, 7.7, 30.7, 1.0 / 3}) {
      const HeightField field = with_hole(samples, kSide, cell, surface, false, false);
      SteepRays rays(field);
      for (int ulps = -3; ulps <= 3; ++ulps) {
        for (const double lean : {0.0, kCosineOf90, -kCosineOf90}) {
          // One row or column of ground on both sides before the hole.
          const double x = line * cell * (1 + 0x1p-53 * ulps), y = (kSide - 1 - line) * cell * (1 + 0x1p-53 * ulps);
          rays.expect_none({{x, (kSide - 1 - 2.5) * cell, 0}, {lean * cell, -cell, 0}});
          rays.expect_none({{2.5 * cell, y, 0}, {cell, lean * cell, 0}});
        }
      }
      rays.check();
    }
  }
}

// Rays that rise along the border from below ground whose zero is far from the samples: rounding counts from that zero.
TEST(SteepRims, AreNotHitFromBelowWithAnOffset) {
  const std::vector<std::int16_t> flat(12);
  for (const double offset : {1000.0, -1e6}) {
    for (const double cell : {1.0, 0.1, 7.7}) {
      const HeightField field =
          HeightField::own(flat, 4, 3, {.cell_x = cell, .cell_y = cell, .scale = 0.1, .offset = offset});
      SteepRays alone(field), in_a_scene(field, kSeamOfScenes);
      for (const double lean : leans()) {
        for (SteepRays* rays : {&alone, &in_a_scene}) {
          rays->expect_none({{0, 1.3 * cell, offset - 1}, {lean, 0, 1}});
          rays->expect_none({{3 * cell, 1.3 * cell, offset - 1}, {lean, 0, 1}});
          rays->expect_none({{1.3 * cell, 0, offset - 1}, {0, lean, 1}});
          rays->expect_none({{1.3 * cell, 2 * cell, offset - 1}, {lean, lean, 1}});
        }
      }
      alone.check();
      in_a_scene.check();
    }
  }
}

// Nodes at col * cell are on the rim although their coordinates are rounded.
TEST(SteepRims, HaveHeightsAtTheirNodes) {
  constexpr int kCols = 300, kRows = 8;
  for (const double cell : {7.7, 0.7, 0.1, 92.6, 30.7, 0.01, 1.23, 1.0 / 3, 1.0, 10.0}) {
    for (int hole = 2; hole + 3 < kCols; hole += 7) {
      // Ground to the west of column `hole`, and from hole + 2 on.
      std::vector<float> samples(kCols * kRows);
      for (int row = 0; row < kRows; ++row) samples[static_cast<std::size_t>(row * kCols + hole + 1)] = kNone;
      const HeightField field = HeightField::own(samples, kCols, kRows, {.cell_x = cell, .cell_y = cell});
      SteepRays rays(field);
      for (const int col : {hole, hole + 2}) {
        for (int row = 0; row < kRows; ++row) {
          const double x = col * cell, y = row * cell;
          EXPECT_TRUE(field.height(x, y)) << cell << " " << col << " " << row;
          rays.expect_hit({{x, y, 10}}, 10);
          const double xs[] = {x}, ys[] = {y};
          double heights[] = {kNone};
          heights_at(field, xs, ys, heights, {});
          EXPECT_EQ(heights[0], 0);
        }
      }
      rays.check();
    }
  }
}

// A ray passes a corner of the ground over its column's line into a block without ground, just before the row's line.
// The walk skips the block if the ray ends above all its heights, but the corner is next to it.
TEST(SteepRims, HitsCornersNextToEmptyBlocksForAnyRangeEnd) {
  constexpr int kSide = 9, kCol = 4, kRow = 3;
  constexpr double kCorner = 0.125, kDrop = 16, kAcross = 0x1p-6, kAlong = 5.5;
  for (int turn = 0; turn < 8; ++turn) {
    const bool west = turn & 1, north = turn & 2, swap = turn & 4;
    // Column and row of the pattern as column and row of the field.
    const auto at = [&](double col, double row) {
      const dvec2 place(west ? kSide - 1 - col : col, north ? kSide - 1 - row : row);
      return swap ? dvec2(place.y, place.x) : place;
    };
    std::vector<float> samples(kSide * kSide, kNone);
    for (int row = kRow; row < kSide; ++row) {
      for (int col = kCol; col < kSide; ++col) {
        const dvec2 place = at(col, row);
        float& sample = samples[static_cast<std::size_t>(place.y) * kSide + static_cast<std::size_t>(place.x)];
        sample = row == kRow && col == kCol ? static_cast<float>(kCorner) : row + col < 2 * (kSide - 1) ? 2.0f : 0.0f;
      }
    }
    const HeightField field = HeightField::view(samples.data(), kSide, kSide);
    SteepRays rays(field);
    for (const double late : {0.0, 2.0, 4.0, 8.0}) {
      for (const double t_max : {1.00001, 1.001, 1.01, 1.02, 1.1}) {
        // It crosses the column's line a few roundings before t = 1.
        const dvec2 from = at(kCol + kAcross - late * 0x1p-51, kRow - kAlong);
        const dvec2 along = at(-kAcross, kAlong) - at(0, 0);
        Ray ray{{from.x, field.depth() - from.y, kCorner + kDrop}, {along.x, -along.y, -kDrop}};
        ray.t_max = t_max;
        rays.expect_hit(ray, 1);
      }
    }
    rays.check();
  }
}

// Rays beside the border, over a hole that ends there: they sink below the ground before they reach the next cell.
TEST(SteepRims, MissHolesThatReachTheBorder) {
  const std::vector<float> samples{1, 2, 3, 4, 5, 6, 7, 8, kNone};
  for (const double cell : {1.0, 0.1, 7.7}) {
    const HeightField field = HeightField::own(samples, 3, 3, {.cell_x = cell, .cell_y = cell});
    for (const double seam : {0.0, kSeamOfScenes}) {
      SteepRays rays(field, seam);
      for (const double lean : leans()) {
        for (const double drift : {1e-3, 1e-10, 1e-17, 1e-300, 5e-324}) {
          rays.expect_none({{2 * cell, 0.5 * cell, 10}, {lean * cell, drift * cell, -1}});
          rays.expect_none({{1.5 * cell, 0, 10}, {-drift * cell, lean * cell, -1}});
        }
      }
      rays.check();
    }
  }
}

// Rays along the border, below its rim where they start: they emerge where the rim is low, and hit its next rise.
TEST(SteepRims, FollowRaysThatEmergeAlongTheBorder) {
  constexpr int kSide = 5;
  const float heights[kSide] = {9, 1, 1, 9, 1};
  std::vector<float> by_row, by_col;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) by_row.push_back(heights[row]), by_col.push_back(heights[col]);
  }
  const HeightField rows = HeightField::own(by_row, kSide, kSide), cols = HeightField::own(by_col, kSide, kSide);
  for (const double seam : {0.0, kSeamOfScenes}) {
    SteepRays along_y(rows, seam), along_x(cols, seam);
    for (const double lean : leans()) {
      if (std::abs(lean) * kSide > HeightField::rounding_of_line(0, kSide - 1)) continue;
      for (const double border : {0.0, kSide - 1.0}) {
        along_y.expect_hit({{border, kSide - 1, 5}, {lean, -1, 0}}, 2.5);
        along_x.expect_hit({{0, border, 5}, {1, lean, 0}}, 2.5);
      }
    }
    along_y.check();
    along_x.check();
  }
}

// The end of the range changes no hit, and a hit at the end counts: at nodes, edges and borders, from all directions.
TEST(SteepRims, KeepHitsAtTheEndOfTheRange) {
  Random random(12);
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (int i = 0; i < cases(400, 40, 4); ++i) {
      std::vector<float> samples(12);
      for (float& sample : samples) sample = static_cast<float>(whole(random, 0, 9));
      const HeightField field = HeightField::own(samples, 4, 3, {.surface = surface});
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid, 0, i % 2 == 0 ? 0.0 : kSeamOfScenes};
      for (int j = 0; j < 200; ++j) {
        const int col = whole(random, 0, 3), row = whole(random, 0, 2);
        const dvec3 node(col, 2 - row, samples[static_cast<std::size_t>(row * 4 + col)]);
        Ray ray{.origin = {uniform(random, -1, 4), uniform(random, -1, 3), 20}};
        if (j % 2 == 0) ray.origin = {node.x, node.y, node.z + uniform(random, 1, 60)};
        ray.direction = node - ray.origin;
        const std::vector<double> all = leans();
        if (j % 2 == 0) ray.direction.x = all[static_cast<std::size_t>(whole(random, 0, 20))];
        if (j % 4 == 0) ray.direction.y = all[static_cast<std::size_t>(whole(random, 0, 20))];
        const Hit hit = march_max_mip(target, ray);
        if (!hit) continue;
        ray.t_max = hit.t;
        ASSERT_EQ(march_max_mip(target, ray), hit) << i << " " << j;
        ASSERT_TRUE(occluded_max_mip(target, ray)) << i << " " << j;
        ray.t_max = std::nextafter(hit.t, -1e300);
        ASSERT_FALSE(ray.t_max >= ray.t_min && march_max_mip(target, ray)) << i << " " << j;
      }
    }
  }
}

// A random field of any kind: cells, formats, surfaces, holes, walls and wraps; half of the flat ones at height 0.
HeightField field_of_any_kind(Random& random, bool wraps) {
  const int cols = whole(random, 2, 8), rows = whole(random, 2, 8), most = whole(random, 0, 2) * 5;
  const double cell[] = {1, 0.1, 0.7, 7.7, 1.0 / 3}, hole = whole(random, 0, 2) * 0.2;
  const bool offset = whole(random, 0, 3) == 0;
  const HeightFieldSettings settings{.cell_x = cell[whole(random, 0, 4)],
                                     .cell_y = cell[whole(random, 0, 4)],
                                     .scale = offset ? 0.1 : 1.0,
                                     .offset = offset ? 1000.0 : 0.0,
                                     .nodata = -1,
                                     .surface = whole(random, 0, 1) ? Surface::bilinear : Surface::triangles,
                                     .wrap = wraps ? Wrap::periodic : Wrap::none,
                                     .solid = whole(random, 0, 3) == 0};
  std::vector<std::int16_t> samples(static_cast<std::size_t>(cols * rows));
  for (std::int16_t& sample : samples)
    sample = static_cast<std::int16_t>(uniform(random, 0, 1) < hole ? -1 : whole(random, 0, most));
  if (whole(random, 0, 1)) return HeightField::own(samples, cols, rows, settings);
  return HeightField::own(std::vector<float>(samples.begin(), samples.end()), cols, rows, settings);
}

// Rays through a node of the field or past it by rounding, steep, along lines, level, or from anywhere. Without offset
// and relief, some rays have heights below the smallest normal number.
Ray ray_at_node(const HeightField& field, Random& random) {
  const HeightFieldSettings& to = field.settings();
  const int col = whole(random, 0, field.cols() - 1), row = whole(random, 0, field.rows() - 1);
  const auto beside = [&] { return whole(random, 0, 2) ? 0.0 : whole(random, -2, 2) * 0x1p-53 * field.cols(); };
  const dvec3 node((col + beside()) * to.cell_x, (field.rows() - 1 - row + beside()) * to.cell_y,
                   whole(random, 0, 1) ? field.max_height() : uniform(random, field.min_height(), field.max_height()));
  static const std::vector<double> all = leans();
  const auto lean = [&] { return all[static_cast<std::size_t>(whole(random, 0, static_cast<int>(all.size()) - 1))]; };
  Ray ray{.origin = {}, .direction = {lean() * to.cell_x, lean() * to.cell_y, whole(random, 0, 4) ? -1 : 1}};
  double back = uniform(random, 0, 20);
  switch (whole(random, 0, 3)) {
    case 0:  // along a line, level or sinking
      ray.direction[whole(random, 0, 1)] = whole(random, 0, 1) ? 1 : -1;
      ray.direction.z = whole(random, 0, 1) ? lean() : -uniform(random, 0, 1);
      break;
    case 1:
      ray.direction = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -2, 0.5)};
      break;
    case 2:
      if (field.min_height() != 0 || field.max_height() != 0) break;
      ray = {{node.x, node.y, whole(random, 0, 20) * 5e-324},
             {uniform(random, -1, 1), uniform(random, -1, 1), -whole(random, 0, 3) * 5e-324}};
      if (whole(random, 0, 1)) ray.direction[whole(random, 0, 1)] = lean();
      ray.origin -= dvec3(ray.direction.x, ray.direction.y, 0) * uniform(random, 0, 10);
      return ray;
    default:
      break;
  }
  if (whole(random, 0, 3) == 0) back = std::round(back);
  ray.origin = node - back * ray.direction;
  return ray;
}

// The end of the range changes no hit: a hit at the end counts, and no query finds an earlier one.
void expect_same_hit_for_any_range(const HeightTarget& target, Ray ray, double longest) {
  SCOPED_TRACE(testing::Message() << "from " << ray.origin.x << ", " << ray.origin.y << ", " << ray.origin.z
                                  << " along " << ray.direction.x << ", " << ray.direction.y << ", " << ray.direction.z
                                  << " over cells of " << target.field->settings().cell_x);
  ray.t_max = longest;
  for (const auto march : {+[](const HeightTarget&on, const Ray&of) { return march_max_mip(on, of); },
                           +[](const HeightTarget&on, const Ray&of) { return march_exhaustive(on, of); }}) {
    Ray cut = ray;
    const Hit hit = march(target, ray);
    if (!hit) continue;
    ASSERT_TRUE(std::isfinite(hit.t) && std::isfinite(hit.height));
    for (const double t_max : {hit.t, std::nextafter(hit.t, longest), hit.t + std::abs(hit.t), hit.t + 1}) {
      cut.t_max = std::min(t_max, longest);
      ASSERT_EQ(march(target, cut), hit) << t_max;
    }
    cut.t_max = std::nextafter(hit.t, -1e300);
    if (cut.t_max >= cut.t_min) {
      ASSERT_FALSE(march(target, cut)) << hit.t;
    }
  }
  const Hit hit = march_max_mip(target, ray);
  if (!hit) return;
  ray.t_max = hit.t;
  Hit batch;
  std::uint8_t blocked = 0;
  closest_hits(target, {&ray, 1}, {&batch, 1});
  occluded(target, {&ray, 1}, {&blocked, 1});
  ASSERT_EQ(batch, hit);
  ASSERT_TRUE(blocked && occluded_max_mip(target, ray));
  ray.t_max = std::nextafter(hit.t, -1e300);
  if (ray.t_max >= ray.t_min) {
    ASSERT_FALSE(occluded_max_mip(target, ray));
  }
}

TEST(SteepRims, HitTheSamePointWhereverTheRangeEnds) {
  Random random(14);
  for (int i = 0; i < cases(3000, 600, 60); ++i) {
    const bool wraps = i % 4 == 0;
    const HeightField field = field_of_any_kind(random, wraps);
    if (field.all_nodata()) continue;
    const MaxPyramid pyramid(field);
    const double seams[] = {0, 0x1p-30, kSeamOfScenes};
    const HeightTarget target{&field, &pyramid, 0, wraps ? 0 : seams[i % 3]};
    for (int j = 0; j < 100; ++j) {
      const Ray ray = ray_at_node(field, random);
      expect_same_hit_for_any_range(target, ray, wraps ? 40 : std::numeric_limits<double>::infinity());
      if (HasFatalFailure()) return;
    }
  }
}

// Rays over a hole reach its rim after 10^307 units of t, far above or below all ground.
TEST(SteepRims, MissWhenNumbersOverflow) {
  constexpr int kSide = 24;
  Random random(15);
  std::vector<float> samples(kSide * kSide);
  for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 5));
  for (const double cell : {1.0, 0.1, 7.7, 1.0 / 3}) {
    const HeightField field = with_hole(samples, kSide, cell, Surface::bilinear, false, false);
    SteepRays rays(field);
    for (int i = 0; i < 1000; ++i) {
      const auto place = [&] { return whole(random, 9, 14) + (whole(random, 0, 1) ? 0 : uniform(random, 0, 1)); };
      const auto lean = [&] { return std::ldexp(uniform(random, -1, 1), -whole(random, 1018, 1080)) * cell; };
      const dvec3 d(lean(), whole(random, 0, 1) ? 0 : lean(), (whole(random, 0, 1) ? 1 : -1) * uniform(random, 1, 8));
      rays.expect_none({{place() * cell, place() * cell, 10}, d});
    }
    rays.check();
  }
}

// Rays that pass a node of the border by less than the distance at which placed fields meet, rising and falling.
TEST(SteepRims, TouchBorderNodesAlikeInAllQueries) {
  Random random(13);
  int hits = 0;
  for (const int side : {3, 5, 40}) {
    std::vector<float> samples(static_cast<std::size_t>(side * side));
    for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 100));
    const HeightField field = HeightField::own(samples, side, side);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid, 0, kSeamOfScenes};
    std::vector<Ray> rays;
    for (int i = 0; i < cases(200000, 20000, 2000); ++i) {
      const int at = whole(random, 0, side - 1), border = whole(random, 0, 1) * (side - 1);
      const int col = i % 2 == 0 ? at : border, row = i % 2 == 0 ? border : at;
      const auto beside = [&] { return std::ldexp(uniform(random, -1, 1), -whole(random, 25, 60)); };
      const dvec3 node(col + beside(), side - 1 - row + beside(), samples[static_cast<std::size_t>(row * side + col)]);
      const dvec3 d(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -100, 100));
      rays.push_back({.origin = node - d * uniform(random, 0, 2), .direction = d});
    }
    std::vector<Hit> batch(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    closest_hits(target, rays, batch);
    occluded(target, rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = march_max_mip(target, rays[i]);
      hits += hit ? 1 : 0;
      ASSERT_EQ(batch[i], hit) << side << " " << i;
      ASSERT_EQ(blocked[i] != 0, static_cast<bool>(hit)) << side << " " << i;
      ASSERT_EQ(occluded_max_mip(target, rays[i]), static_cast<bool>(hit)) << side << " " << i;
    }
  }
  EXPECT_GT(hits, 1000);
}

// Level ground without rounding, with a hole elsewhere.
HeightField level_with_hole(double height, double cell, Surface surface) {
  std::vector<float> samples(9 * 5, static_cast<float>(height));
  samples[6] = kNone;
  return HeightField::own(samples, 9, 5, {.cell_x = cell, .cell_y = cell, .surface = surface});
}

TEST(SteepRims, HitLevelGroundOnWhichTheyStart) {
  Random random(61);
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const double cell : {46.315, 30.7, 1.0, 0.1}) {
      const HeightField field = level_with_hole(500, cell, surface);
      SteepRays rays(field, kSeamOfScenes);
      for (int i = 0; i < cases(4000, 1000, 200); ++i) {
        // On a line of constant row or column, or in between; the hole is in the north.
        dvec3 p(uniform(random, 0, 8) * cell, uniform(random, 0, 2.9) * cell, 500);
        const int line = whole(random, 0, 2);
        if (line < 2) p[line] = whole(random, 0, 2) * cell;
        const double lean = whole(random, 0, 1) ? 0.0 : uniform(random, -1, 1);
        rays.expect_hit({.origin = p, .direction = {0, line == 1 ? 0 : lean, -0.5}}, 0);
      }
      rays.check(0);
    }
  }
}

// Rays that reach the height of the rim just where they cross it.
TEST(SteepRims, KeepTouchesAtTheEndOfTheRange) {
  Random random(62);
  int hits = 0;
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    for (const double cell : {0.1, 1.0, 7.7}) {
      const HeightField field = level_with_hole(0, cell, surface);
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid, 0, kSeamOfScenes};
      for (int i = 0; i < cases(200'000, 20'000, 2'000); ++i) {
        dvec3 p(whole(random, 0, 80) * 0.1 * cell, whole(random, 0, 40) * 0.1 * cell, 0);
        if (whole(random, 0, 1)) {
          p.y = whole(random, 0, 4) * cell;
        } else {
          p.x = whole(random, 0, 8) * cell;
        }
        const dvec3 d(whole(random, -10, 10) * 0.1, whole(random, -10, 10) * 0.1, std::pow(10.0, -whole(random, 0, 4)));
        const double t = std::pow(10.0, -whole(random, 0, 3));
        Ray ray{.origin = p + t * dvec3(d.x, d.y, d.z), .direction = -d};
        const Hit hit = march_max_mip(target, ray);
        if (!hit) continue;
        ++hits;
        ray.t_max = hit.t;
        ASSERT_EQ(march_max_mip(target, ray), hit) << i << ", cell " << cell;
        ASSERT_TRUE(occluded_max_mip(target, ray)) << i << ", cell " << cell;
      }
    }
  }
  EXPECT_GT(hits, 1000);
}

}  // namespace
}  // namespace scarp::test
