// SPDX-License-Identifier: MIT
// A surface over bare ground (--ground), and visible heights of targets, against crossings in whole numbers.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"

namespace scarp::test {
namespace {

constexpr int kModelSide = 17;
constexpr std::size_t kUnderTrees = 5 * kModelSide + 4;

struct Place {
  int col, row;
};

// Random ground of whole metres, and a surface with trees 9 m high on a third of it.
class BareGround : public testing::Test {
 protected:
  BareGround() {
    std::mt19937 random(3);
    for (int i = 0; i < kModelSide * kModelSide; ++i) {
      ground_.push_back(static_cast<int>(random() % 12));
      surface_.push_back(ground_.back() + (random() % 3 == 0 ? 9 : 0));
    }
    surface_[kUnderTrees] = ground_[kUnderTrees] + 9;
    dtm_ = write("dtm.asc", ground_);
    dsm_ = write("dsm.asc", surface_);
  }
  std::string write(const std::string& name, const std::vector<int>& heights, int corner = 0) const {
    std::string text =
        fmt::format("ncols {0}\nnrows {0}\nxllcenter {1}\nyllcenter 0\ncellsize 10\n", kModelSide, corner);
    for (std::size_t i = 0; i < heights.size(); ++i)
      text += fmt::format("{}{}", heights[i], (i + 1) % kModelSide == 0 ? '\n' : ' ');
    return scratch_.write(name, text);
  }
  static int at(const std::vector<int>& heights, int col, int row) {
    return heights[static_cast<std::size_t>(row * kModelSide + col)];
  }

  // Calls visit(steps, of, scaled): the ray is at steps / of of its way, and the ground there is scaled / of.
  void crossings(const std::vector<int>& blocks, const Place& from, const Place& to,
                 const std::function<void(int, int, int)>& visit) const {
    const int dc = to.col - from.col, dr = to.row - from.row;
    const auto along = [&](int steps, int across, const auto& height) {
      const int of = std::abs(steps);
      for (int k = 1; k < of; ++k) {
        const int whole = (k * across - (((k * across) % of + of) % of)) / of, part = k * across - whole * of;
        const int near = height(k, whole), far = part > 0 ? height(k, whole + 1) : near;
        visit(k, of, near * (of - part) + far * part);
      }
    };
    along(dc, dr, [&](int k, int across) { return at(blocks, from.col + (dc > 0 ? k : -k), from.row + across); });
    along(dr, dc, [&](int k, int across) { return at(blocks, from.col + across, from.row + (dr > 0 ? k : -k)); });
  }
  // Whether an eye sees a target, both at whole metres above `stands`, over `blocks`.
  bool sees(const std::vector<int>& stands, const std::vector<int>& blocks, const Place& from, int eye, const Place& to,
            int target) const {
    const int start = at(stands, from.col, from.row) + eye, end = at(stands, to.col, to.row) + target;
    bool visible = true;
    crossings(blocks, from, to, [&](int k, int of, int scaled) {
      if (scaled > start * (of - k) + end * k) visible = false;
    });
    return visible;
  }
  // Metres of a target that an eye sees.
  double seen_height(const std::vector<int>& stands, const std::vector<int>& blocks, const Place& from, int eye,
                     const Place& to, int target) const {
    const double start = at(stands, from.col, from.row) + eye;
    double hidden = 0;
    crossings(blocks, from, to, [&](int k, int of, int scaled) {
      const double end = start + (static_cast<double>(scaled) / of - start) * of / k;
      hidden = std::max(hidden, end - at(stands, to.col, to.row));
    });
    return std::max(0.0, target - hidden);
  }

  static std::string typed(const Place& place, int height) {
    return fmt::format("{},{},{}", 10 * place.col, 10 * (kModelSide - 1 - place.row), height);
  }
  std::vector<float> map(const std::string& dem, const Names& options) const {
    const Result result = run(Names{"viewshed", dem, "--cc", "0", "-o", scratch_.path("map.tif")} + options);
    EXPECT_EQ(result.status, 0) << result.err;
    GDALAllRegister();
    const GDALDatasetUniquePtr raster(GDALDataset::Open(scratch_.path("map.tif").c_str(), GDAL_OF_RASTER));
    std::vector<float> pixels(kModelSide * kModelSide);
    if (!raster) return pixels;
    EXPECT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, kModelSide, kModelSide, pixels.data(), kModelSide,
                                                 kModelSide, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return pixels;
  }
  static void for_each(const std::vector<float>& pixels, const std::function<void(Place, double)>& check) {
    for (int i = 0; i < kModelSide * kModelSide; ++i)
      check({i % kModelSide, i / kModelSide}, pixels[static_cast<std::size_t>(i)]);
  }

  Scratch scratch_;
  std::vector<int> ground_, surface_;
  std::string dtm_, dsm_;
};

// The first observer stands at kUnderTrees.
const std::vector<Place> kEyes{{4, 5}, {12, 9}};

TEST_F(BareGround, SurfaceHidesWhatStandsOnTheGround) {
  Names both{"--ground", dtm_, "--target-height", "2"};
  for (const Place& eye : kEyes) both = both + Names{"--observer", typed(eye, 6)};
  const auto count_at = [&](const Place& to) {
    return sees(ground_, surface_, kEyes[0], 6, to, 2) + sees(ground_, surface_, kEyes[1], 6, to, 2);
  };
  int under_surface = 0;
  for_each(map(dsm_, both), [&](const Place& to, double value) {
    EXPECT_EQ(value, count_at(to) > 0) << to.col << ' ' << to.row;
    under_surface += sees(surface_, surface_, kEyes[1], 6, to, 2) != sees(ground_, surface_, kEyes[1], 6, to, 2);
  });
  EXPECT_GT(under_surface, 10) << "the ground makes no difference";
  for_each(map(dsm_, both + Names{"--mode", "count"}),
           [&](const Place& to, double value) { EXPECT_EQ(value, count_at(to)); });
  const Names one{"--ground", dtm_, "--observer", typed(kEyes[1], 6)};
  for_each(map(dsm_, one + Names{"--mode", "ground"}), [&](const Place& to, double value) {
    for (int height = 0; height < 30; height += 3)
      EXPECT_EQ(value <= height, sees(ground_, surface_, kEyes[1], 6, to, height)) << to.col << ' ' << to.row;
  });
  for_each(map(dsm_, one + Names{"--pitch=-90,0"}), [&](const Place& to, double value) {
    const bool own = to.col == kEyes[1].col && to.row == kEyes[1].row;
    const bool in_range = own || at(ground_, to.col, to.row) <= at(ground_, kEyes[1].col, kEyes[1].row) + 6;
    EXPECT_EQ(value, !in_range ? 255 : sees(ground_, surface_, kEyes[1], 6, to, 0)) << to.col << ' ' << to.row;
  });
}

TEST_F(BareGround, VisibleHeightsOfTargetsAreSummed) {
  const Names options{
      "--observer", typed(kEyes[0], 30), "--observer", typed(kEyes[1], 6), "--target-height", "20", "--mode", "height"};
  const auto expect = [&](const std::vector<float>& pixels, const std::vector<int>& stands,
                          const std::vector<int>& blocks) {
    int partly = 0;
    for_each(pixels, [&](const Place& to, double value) {
      const double expected =
          seen_height(stands, blocks, kEyes[0], 30, to, 20) + seen_height(stands, blocks, kEyes[1], 6, to, 20);
      // Two floats and their sum, below 64.
      EXPECT_NEAR(value, expected, 3 * 64 * 0x1p-24) << to.col << ' ' << to.row;
      partly += expected > 20 && expected < 40;
    });
    EXPECT_GT(partly, 10);
  };
  expect(map(dsm_, options), surface_, surface_);
  expect(map(dsm_, options + Names{"--ground", dtm_}), ground_, surface_);
}

TEST_F(BareGround, LinesAndProfilesStandOnTheGround) {
  std::string lines = "x,y,z,tx,ty,tz\n";
  std::vector<Place> targets;
  for (int i = 0; i < 60; ++i) targets.push_back({(5 * i + 2) % kModelSide, (7 * i + 3) % kModelSide});
  for (const Place& to : targets) lines += typed(kEyes[1], 6) + ',' + typed(to, 2) + '\n';
  const Result result = run({"los", dsm_, "--ground", dtm_, "--cc", "0", "--lines", scratch_.write("l.csv", lines)});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), targets.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(number(rows[i], "visible"), sees(ground_, surface_, kEyes[1], 6, targets[i], 2)) << i;
    EXPECT_EQ(number(rows[i], "target"), at(ground_, targets[i].col, targets[i].row) + 2);
  }
  const Result profile = run({"profile", dsm_, "--ground", dtm_, "--cc", "0", "--from", "0,80,6", "--to", "160,80,2"});
  ASSERT_EQ(profile.status, 0) << profile.err;
  const auto points = rows_of(profile.out);
  ASSERT_EQ(points.size(), static_cast<std::size_t>(kModelSide));
  for (int col = 0; col < kModelSide; ++col) {
    EXPECT_EQ(number(points[static_cast<std::size_t>(col)], "ground"), at(surface_, col, 8));
    EXPECT_EQ(number(points[static_cast<std::size_t>(col)], "bare"), at(ground_, col, 8));
  }
  EXPECT_EQ(number(points.front(), "sight"), at(ground_, 0, 8) + 6);
}

TEST_F(BareGround, GroundNeedsTheSamplesOfTheSurface) {
  const auto refused = [&](const Names& words, const std::string& what) {
    const Result result = run(words);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  };
  const Names view{"viewshed", dsm_, "--observer", "40,50", "-o", scratch_.path("a.tif")};
  refused(view + Names{"--ground", write("moved.asc", ground_, 5)}, "are not at the places of the 17 x 17 of");
  refused(view + Names{"--ground", scratch_.path("no.tif")}, "no.tif");
  refused(view + Names{"--mode", "height"}, "height needs targets with a height");
  refused(view + Names{"--mode", "fresnel"}, "fresnel needs --frequency MHZ");
  refused({"profile", dsm_, "--ground", dtm_, "--path", dsm_}, "cannot be combined with");
}

}  // namespace
}  // namespace scarp::test
