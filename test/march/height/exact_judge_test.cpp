// SPDX-License-Identifier: MIT
// Ties: the marches against rational arithmetic, on small fields and rays whose numbers are exact in doubles. There the
// answers must be the documented ones, touches, corners and seams included.
//
// Coordinates are multiples of 1/4, cells and directions powers of two; over triangles dx + dy is also a power of two,
// or zero, so that the diagonal's time is exact. Only t is rounded, by its last division and square root.
#include "march/height/exact_judge.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cases.h"
#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::test {
namespace {

const int kRays = cases(20'000, 4000, 600);
constexpr int kRaysPerField = 20;

struct Kind {
  const char* name;
  Surface surface;
  Wrap wrap;
  bool holes, solid;
};

HeightField make(const Kind& kind, Random& random) {
  const int least = kind.wrap == Wrap::periodic ? 1 : 2;
  const int cols = whole(random, least, 6), rows = whole(random, least, 6), tallest = whole(random, 1, 4);
  std::vector<float> samples;
  for (int i = 0; i < cols * rows; ++i) {
    const bool hole = kind.holes && whole(random, 0, 9) == 0;
    samples.push_back(hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(whole(random, 0, tallest)));
  }
  if (kind.wrap == Wrap::shared_border) {
    const auto at = [&](int col, int row) -> float& { return samples[static_cast<std::size_t>(row * cols + col)]; };
    for (int row = 0; row < rows; ++row) at(cols - 1, row) = at(0, row);
    for (int col = 0; col < cols; ++col) at(col, rows - 1) = at(col, 0);
  }
  const auto power = [&] { return std::ldexp(1.0, whole(random, -1, 1)); };
  HeightFieldSettings settings;
  settings.cell_x = power(), settings.cell_y = power(), settings.scale = power(),
  settings.offset = whole(random, -2, 2);
  settings.surface = kind.surface, settings.wrap = kind.wrap, settings.solid = kind.solid;
  return HeightField::own(std::move(samples), cols, rows, settings);
}

bool is_round(double x) { return x == 0 || std::abs(x) == std::ldexp(1.0, std::ilogb(x)); }

Ray make_ray(const HeightField& field, Random& random) {
  const HeightFieldSettings& to = field.settings();
  const auto power = [&] {
    return whole(random, 0, 4) ? std::ldexp(whole(random, 0, 1) ? 1 : -1, whole(random, -1, 1)) : 0.0;
  };
  double dx, dy, dz;
  do {
    dx = power(), dy = power(), dz = std::ldexp(whole(random, -3, 2), -whole(random, 0, 2));
  } while ((dx == 0 && dy == 0 && dz == 0) || (to.surface == Surface::triangles && !is_round(dx + dy)));
  Ray ray;
  ray.direction = {dx * to.cell_x, -dy * to.cell_y, dz * to.scale};
  const double col = whole(random, -8, 4 * field.cols() + 8) / 4.0, row = whole(random, -8, 4 * field.rows() + 8) / 4.0;
  ray.origin = field.world_from_grid(col, row, whole(random, -2, 14) / 2.0);
  if (whole(random, 0, 2) == 0 && field.has_cells()) {
    const Cell cell{whole(random, 0, field.cell_cols() - 1), whole(random, 0, field.cell_rows() - 1)};
    if (const auto h = field.cell_heights(cell)) {
      const double u = whole(random, 0, 4) / 4.0, v = whole(random, 0, 4) / 4.0;
      const int copy = field.wraps() ? whole(random, -2, 2) : 0;
      ray.origin = field.world_from_grid(cell.col + u + copy * field.cell_cols(),
                                         cell.row + v - copy * field.cell_rows(), height_in_cell(to.surface, *h, u, v));
      ray.start = RayStart::on_surface;
      ray.start_cell = cell;
    }
  } else if (whole(random, 0, 2) == 0) {
    ray.t_min = whole(random, -4, 4) / 2.0;
  }
  if (field.wraps() || whole(random, 0, 3) == 0) ray.t_max = ray.t_min + whole(random, 0, 24) / 2.0;
  return ray;
}

std::string text(const HeightField& field, const Ray& ray) {
  const HeightFieldSettings& to = field.settings();
  std::string all = fmt::format(
      "cells {} x {}, scale {}, offset {}; origin ({}, {}, {}) direction ({}, {}, {}) t [{}, "
      "{}] {} cell ({}, {})\n  samples",
      to.cell_x, to.cell_y, to.scale, to.offset, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
      ray.direction.y, ray.direction.z, ray.t_min, ray.t_max, ray.start == RayStart::free ? "free" : "on surface",
      ray.start_cell.col, ray.start_cell.row);
  field.visit([&](const auto& grid) {
    for (int row = 0; row < grid.rows; ++row) {
      all += "\n   ";
      for (int col = 0; col < grid.cols; ++col) all += fmt::format(" {}", grid.at(col, row));
    }
  });
  return all;
}

std::string text(HitStatus status, const std::vector<Hit>& hits) {
  std::string all = fmt::format("status {}", static_cast<int>(status));
  for (const Hit& hit : hits) {
    all += fmt::format("\n    t={} cell ({}, {}) u={} v={}{}", hit.t, hit.cell.col, hit.cell.row, hit.u, hit.v,
                       hit.wall ? " wall" : "");
  }
  return all;
}

std::string text(const ExactAnswer& answer) {
  std::string all = fmt::format("status {}", static_cast<int>(answer.status));
  for (const ExactHit& hit : answer.hits) {
    all += fmt::format("\n    in [{}, {}]{}{}", static_cast<double>(hit.begin), static_cast<double>(hit.end),
                       hit.at_begin ? " at its begin" : "", hit.wall ? " wall" : "");
  }
  return all;
}

// The quotient and the root carry a few roundings each; 2^-48 is 32 of them.
bool is_at(const ExactHit& expected, const Hit& hit) {
  return expected.is_at(hit.t, 0x1p-48 * (1 + std::abs(hit.t))) && expected.wall == hit.wall;
}

bool agree(const ExactAnswer& expected, HitStatus status, const std::vector<Hit>& hits) {
  return status == expected.status && hits.size() == expected.hits.size() &&
         std::equal(hits.begin(), hits.end(), expected.hits.begin(),
                    [](const Hit& hit, const ExactHit& exact) { return is_at(exact, hit); });
}

class Exact : public testing::TestWithParam<Kind> {};

TEST_P(Exact, BreaksTiesAsDocumented) {
  Random random(5);
  int bad = 0, hits_seen = 0;
  std::vector<Hit> hits;
  for (int done = 0; done < kRays && bad < 3; done += kRaysPerField) {
    const HeightField field = make(GetParam(), random);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for (int i = 0; i < kRaysPerField && bad < 3; ++i) {
      const Ray ray = make_ray(field, random);
      const ExactAnswer exact = cast_exactly(field, ray);
      hits_seen += exact.status == HitStatus::hit;
      const Hit hit = march_max_mip(target, ray);
      if (hit.status != exact.status || (hit && !is_at(exact.hits.front(), hit))) {
        ++bad;
        ADD_FAILURE() << "max-mip: " << text(field, ray) << "\n  exact " << text(exact) << "\n  march "
                      << text(hit.status, {hit});
      }
      EXPECT_EQ(occluded_max_mip(target, ray), hit.status == HitStatus::hit) << text(field, ray);
      const HitStatus status = all_hits_max_mip(target, ray, hits);
      if (!agree(exact, status, hits)) {
        ++bad;
        ADD_FAILURE() << "all hits: " << text(field, ray) << "\n  exact " << text(exact) << "\n  march "
                      << text(status, hits);
      }
      // At corners of holes the exhaustive march takes every cell that the ray touches, not the chain.
      if (GetParam().holes) continue;
      const HitStatus judged = all_hits_exhaustive(target, ray, hits);
      const Hit closest = march_exhaustive(target, ray);
      EXPECT_TRUE(closest.status == judged && (!closest || closest.t == hits.front().t)) << text(field, ray);
      if (!agree(exact, judged, hits)) {
        ++bad;
        ADD_FAILURE() << "exhaustive: " << text(field, ray) << "\n  exact " << text(exact) << "\n  march "
                      << text(judged, hits);
      }
    }
  }
  // The rays are aimed so that both hits and misses occur.
  EXPECT_GT(hits_seen, kRays / 10 * (bad == 0));
}

// The ray enters over the border on the surface, rises and descends again, all in its first cell.
TEST(Exact, FindsASecondHitInTheCellOfATouch) {
  const HeightField field = HeightField::own<float>({0, 1, 2, 0}, 2, 2);
  const MaxPyramid pyramid(field);
  // Along the diagonal from the north-east the ground is at 1 - 2 s + 3 s^2, and the ray at 1, so the ray is on the
  // surface again at s = 2/3.
  const Ray ray{{2, 2, 1}, {-1, -1, 0}};
  const ExactAnswer exact = cast_exactly(field, ray);
  ASSERT_EQ(exact.hits.size(), 2u);
  std::vector<Hit> hits;
  for (const auto all : {all_hits_exhaustive, all_hits_max_mip}) {
    const HitStatus status = all({&field, &pyramid}, ray, hits);
    EXPECT_TRUE(agree(exact, status, hits)) << text(exact) << text(status, hits);
  }
}

std::string name_of_kind(const testing::TestParamInfo<Kind>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Ties, Exact,
                         testing::Values(Kind{"bilinear", Surface::bilinear, Wrap::none, false, false},
                                         Kind{"triangles", Surface::triangles, Wrap::none, false, false},
                                         Kind{"holes", Surface::bilinear, Wrap::none, true, false},
                                         Kind{"triangles_with_holes", Surface::triangles, Wrap::none, true, false},
                                         Kind{"periodic", Surface::bilinear, Wrap::periodic, false, false},
                                         Kind{"shared_border", Surface::bilinear, Wrap::shared_border, false, false},
                                         Kind{"periodic_triangles", Surface::triangles, Wrap::periodic, false, false},
                                         Kind{"periodic_with_holes", Surface::bilinear, Wrap::periodic, true, false},
                                         Kind{"solid", Surface::bilinear, Wrap::none, false, true},
                                         Kind{"solid_with_holes", Surface::bilinear, Wrap::none, true, true},
                                         Kind{"solid_periodic_triangles", Surface::triangles, Wrap::periodic, true,
                                              true}),
                         name_of_kind);

}  // namespace
}  // namespace scarp::test
