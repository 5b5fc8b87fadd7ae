// SPDX-License-Identifier: MIT
// Answers must not depend on the orientation of the field, its scale, the length of the direction, or the splitting of
// a range. Coordinates have so few digits that signs are exact, so ties must be equal, too.
//
// Mirroring flips the diagonals of triangles, so over triangles only half a turn and the transpose apply.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::test {
namespace {

const int kCases = cases(20'000, 20'000, 4'000);

// A field and a ray in grid units.
struct Case {
  std::vector<float> samples;
  int cols, rows;
  HeightFieldSettings settings;
  dvec3 origin, direction;
  double t_min = 0, t_max = HUGE_VAL;

  float& at(int col, int row) { return samples[static_cast<std::size_t>(row * cols + col)]; }
  HeightField field() const { return HeightField::own(samples, cols, rows, settings); }
  Ray ray(const HeightField& field) const {
    const HeightFieldSettings& to = settings;
    return {field.world_from_grid(origin.x, origin.y, origin.z),
            {direction.x * to.cell_x, -direction.y * to.cell_y, direction.z * to.scale * to.exaggeration},
            t_min,
            t_max};
  }
};

Hit closest(const Case& c) {
  const HeightField field = c.field();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const Hit hit = march_max_mip(target, c.ray(field));
  EXPECT_EQ(occluded_max_mip(target, c.ray(field)), hit.status == HitStatus::hit);
  return hit;
}

// As in the exact judge's test: powers of two, as are the sums dx + dy, so that no sign is rounded.
Case any_case(Random& random, Surface surface, Wrap wrap) {
  Case c;
  c.cols = whole(random, 2, 9), c.rows = whole(random, 2, 9);
  c.settings.surface = surface, c.settings.wrap = wrap;
  for (int i = 0; i < c.cols * c.rows; ++i) c.samples.push_back(static_cast<float>(whole(random, 0, 6)));
  const auto sign = [&] { return whole(random, 0, 1) ? 1.0 : -1.0; };
  const double size = std::ldexp(1.0, whole(random, -2, 1));
  c.direction = {sign() * size, sign() * size, -whole(random, -1, 8) / 8.0};
  if (const int along = whole(random, 0, 5); along < 2) c.direction[along] = 0;
  c.origin = {whole(random, -8, 8 * c.cols) / 8.0, whole(random, -8, 8 * c.rows) / 8.0, whole(random, 0, 28) / 4.0};
  if (wrap != Wrap::none) c.t_max = whole(random, 0, 128) / 4.0;
  return c;
}

void expect_same(const Hit& a, const Hit& b) {
  ASSERT_EQ(a.status, b.status);
  // The last quotient and root round; 2^-48 is 32 times that.
  if (a) {
    ASSERT_NEAR(a.t, b.t, 0x1p-48 * (1 + std::abs(a.t)));
  }
}

Case mirrored(Case c, int axis) {
  const int samples = axis == 0 ? c.cols : c.rows;
  const bool periodic = c.settings.wrap == Wrap::periodic;
  // In a periodic field the first sample stays; otherwise first and last are swapped.
  const auto from = [&](int i) { return periodic ? (samples - i) % samples : samples - 1 - i; };
  Case m = c;
  for (int row = 0; row < c.rows; ++row) {
    for (int col = 0; col < c.cols; ++col) {
      m.at(col, row) = axis == 0 ? c.at(from(col), row) : c.at(col, from(row));
    }
  }
  m.origin[axis] = samples - (periodic ? 0 : 1) - c.origin[axis];
  m.direction[axis] = -c.direction[axis];
  return m;
}

Case transposed(Case c) {
  Case m = c;
  std::swap(m.cols, m.rows);
  for (int row = 0; row < c.rows; ++row) {
    for (int col = 0; col < c.cols; ++col) m.at(row, col) = c.at(col, row);
  }
  std::swap(m.origin.x, m.origin.y);
  std::swap(m.direction.x, m.direction.y);
  return m;
}

struct Kind {
  Surface surface;
  Wrap wrap;
};

class Invariance : public testing::TestWithParam<Kind> {
 protected:
  template <class Check>
  void for_each_case(const Check& check) {
    Random random(6);
    int hits = 0;
    for (int i = 0; i < kCases && !HasFatalFailure(); ++i) {
      const Case c = any_case(random, GetParam().surface, GetParam().wrap);
      const Hit hit = closest(c);
      hits += hit.status == HitStatus::hit;
      check(c, hit, random);
    }
    EXPECT_GT(hits, kCases / 10);
  }
};

TEST_P(Invariance, Mirror) {
  int differing = 0;
  for_each_case([&](const Case& c, const Hit& hit, Random&) {
    if (GetParam().surface == Surface::bilinear) {
      expect_same(hit, closest(mirrored(c, 0)));
      expect_same(hit, closest(mirrored(c, 1)));
    } else {
      const Hit other = closest(mirrored(c, 0));
      differing += other.status != hit.status || (hit && std::abs(other.t - hit.t) > 1e-6);
    }
    expect_same(hit, closest(mirrored(mirrored(c, 0), 1)));
  });
  if (GetParam().surface == Surface::triangles) {
    EXPECT_GT(differing, 0) << "diagonals go one way";
  }
}

TEST_P(Invariance, Transpose) {
  for_each_case([](const Case& c, const Hit& hit, Random&) { expect_same(hit, closest(transposed(c))); });
}

TEST_P(Invariance, TranslationByWholeCellsAndPeriods) {
  if (GetParam().wrap == Wrap::none) GTEST_SKIP() << "only a field without borders can be moved along itself";
  for_each_case([](Case c, const Hit& hit, Random& random) {
    Case moved = c;
    moved.origin += dvec3(c.cols * whole(random, -9, 9), c.rows * whole(random, -9, 9), 0);
    expect_same(hit, closest(moved));
    const int right = whole(random, 0, c.cols - 1), down = whole(random, 0, c.rows - 1);
    moved = c;
    for (int row = 0; row < c.rows; ++row) {
      for (int col = 0; col < c.cols; ++col) moved.at((col + right) % c.cols, (row + down) % c.rows) = c.at(col, row);
    }
    moved.origin += dvec3(right, down, 0);
    expect_same(hit, closest(moved));
  });
}

TEST_P(Invariance, PowerOfTwoScalesAreBitIdentical) {
  for_each_case([](const Case& c, const Hit& hit, Random& random) {
    Case scaled = c;
    scaled.settings.cell_x = std::ldexp(1.0, whole(random, -9, 9));
    scaled.settings.cell_y = std::ldexp(1.0, whole(random, -9, 9));
    scaled.settings.scale = std::ldexp(1.0, whole(random, -9, 9));
    scaled.settings.exaggeration = std::ldexp(1.0, whole(random, -3, 3));
    const Hit other = closest(scaled);
    ASSERT_EQ(hit.status, other.status);
    if (hit) {
      ASSERT_EQ(hit.t, other.t);
      ASSERT_EQ(hit.cell, other.cell);
      ASSERT_EQ(hit.u, other.u);
      ASSERT_EQ(hit.v, other.v);
    }
  });
}

TEST_P(Invariance, TScalesExactlyWithTheDirection) {
  for_each_case([](const Case& c, const Hit& hit, Random& random) {
    // Scales large enough for the lengths that marches rescale.
    const int power = whole(random, -700, 700);
    Case longer = c;
    longer.direction = c.direction * std::ldexp(1.0, power);
    longer.t_max = std::ldexp(c.t_max, -power);
    const Hit other = closest(longer);
    ASSERT_EQ(hit.status, other.status);
    if (hit) {
      ASSERT_EQ(std::ldexp(hit.t, -power), other.t);
    }
  });
}

TEST_P(Invariance, SplitRangeFindsTheSameFirstHit) {
  for_each_case([](const Case& c, const Hit& hit, Random& random) {
    Case first = c, second = c;
    first.t_max = second.t_min = std::min(c.t_max, whole(random, 0, 64) / 8.0);
    Hit found = closest(first);
    if (!found) {
      found = closest(second);
      // Split where it leaves the ground, the ray starts with a touch.
      if (found && found.t == second.t_min && !(hit && hit.t == found.t)) return;
    }
    ASSERT_EQ(hit.status == HitStatus::hit, found.status == HitStatus::hit);
    if (hit) expect_same(hit, found);
  });
}

TEST_P(Invariance, LaterStartNeverFindsAnEarlierHit) {
  for_each_case([](const Case& c, const Hit& hit, Random& random) {
    Case later = c;
    later.t_min = std::min(c.t_max, whole(random, 0, 64) / 8.0);
    const Hit found = closest(later);
    if (!found) return;
    ASSERT_GE(found.t, later.t_min);
    // Except for a touch where the later ray starts, on its way out of the ground.
    if (found.t == later.t_min) return;
    ASSERT_TRUE(hit);
    ASSERT_GE(found.t, hit.t - 0x1p-48 * (1 + hit.t));
  });
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Invariance,
                         testing::Values(Kind{Surface::bilinear, Wrap::none}, Kind{Surface::triangles, Wrap::none},
                                         Kind{Surface::bilinear, Wrap::periodic},
                                         Kind{Surface::triangles, Wrap::periodic}),
                         [](const auto& kind) {
                           return std::string(kind.param.surface == Surface::bilinear ? "bilinear" : "triangles") +
                                  (kind.param.wrap == Wrap::none ? "" : "_periodic");
                         });

// If all cells are planar, both surfaces are identical.
TEST(Surfaces, AgreeOnPlanarCells) {
  Random random(7);
  int hits = 0;
  for (int i = 0; i < kCases; ++i) {
    Case c = any_case(random, Surface::bilinear, Wrap::none);
    // Ridges and valleys along columns and along rows: sums of a height per column and one per row.
    std::vector<float> along_row, along_col;
    for (int col = 0; col < c.cols; ++col) along_row.push_back(static_cast<float>(uniform(random, 0, 3)));
    for (int row = 0; row < c.rows; ++row) along_col.push_back(static_cast<float>(uniform(random, 0, 3)));
    const auto quarters = [](double x) { return static_cast<float>(std::round(64 * x) / 64); };
    for (int row = 0; row < c.rows; ++row) {
      for (int col = 0; col < c.cols; ++col) {
        c.at(col, row) =
            quarters(along_row[static_cast<std::size_t>(col)]) + quarters(along_col[static_cast<std::size_t>(row)]);
      }
    }
    c.direction += dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 0));
    Case flat = c;
    flat.settings.surface = Surface::triangles;
    const Hit bilinear = closest(c), triangles = closest(flat);
    hits += bilinear.status == HitStatus::hit;
    ASSERT_EQ(bilinear.status, triangles.status);
    if (!bilinear) continue;
    // Clearances are off by 16 u of their inputs (numerics.md), at most 2^7 here; t by that over the speed at which the
    // ray approaches, either way.
    const HeightField field = c.field();
    const dvec2 slope = field.gradient(bilinear.cell, bilinear.u, bilinear.v);
    const double closing = std::abs(c.direction.z - slope.x * c.direction.x + slope.y * c.direction.y);
    ASSERT_LE(std::abs(bilinear.t - triangles.t) * closing, 2 * 16 * 0x1p-53 * 0x1p7);
  }
  EXPECT_GT(hits, kCases / 10);
}

}  // namespace
}  // namespace scarp::test
