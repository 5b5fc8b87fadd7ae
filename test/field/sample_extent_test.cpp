// SPDX-License-Identifier: MIT
// Extents after edits equal those computed from all samples one by one.
#include "scarp/field/sample_extent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <type_traits>
#include <vector>

namespace scarp {
namespace {

// Several tiles; those at the east and south borders are clipped, and not to a multiple of four rows.
constexpr int kCols = 203, kRows = 151;

template <class T>
class Ground {
 public:
  explicit Ground(std::optional<T> nodata) : samples_(static_cast<std::size_t>(kCols) * kRows, T{500}) {
    constexpr bool kFloat = std::is_floating_point_v<T>;
    grid_ = {samples_.data(), kCols, kCols, kRows, kCols - 1, kRows - 1, kFloat || nodata, T{}};
    if constexpr (kFloat) grid_.nodata = std::numeric_limits<T>::quiet_NaN();
    if (nodata) grid_.nodata = *nodata;
    extents_.emplace(grid_);
  }

  template <class Next>
  void edit(const SampleRect& rect, const Next& next) {
    for (int row = rect.row; row < rect.row + rect.rows; ++row) {
      for (int col = rect.col; col < rect.col + rect.cols; ++col)
        samples_[static_cast<std::size_t>(row * kCols + col)] = next();
    }
    extents_->update(grid_, rect);
    const SampleExtent &found = extents_->whole(), expected = brute_force();
    EXPECT_EQ(found.min, expected.min);
    EXPECT_EQ(found.max, expected.max);
    EXPECT_EQ(found.nodata, expected.nodata);
  }
  void fill(const SampleRect& rect, T sample) {
    SCOPED_TRACE(testing::Message() << sample << " to " << rect.cols << " x " << rect.rows << " at " << rect.col << ", "
                                    << rect.row);
    edit(rect, [&] { return sample; });
  }
  const SampleExtent& extent() const { return extents_->whole(); }

 private:
  SampleExtent brute_force() const {
    SampleExtent all;
    for (const T sample : samples_) {
      if (grid_.is_nodata(sample)) {
        ++all.nodata;
      } else {
        all.merge({static_cast<float>(sample), static_cast<float>(sample), 0});
      }
    }
    return all;
  }

  std::vector<T> samples_;
  SampleGrid<T> grid_;
  std::optional<TileExtents> extents_;
};

template <class T>
class SampleExtentTest : public testing::Test {};
using SampleTypes = testing::Types<std::int16_t, std::uint16_t, float>;
TYPED_TEST_SUITE(SampleExtentTest, SampleTypes);

TYPED_TEST(SampleExtentTest, ForgetsOverwrittenExtremes) {
  Ground<TypeParam> ground({});
  // In the interior of a tile, where four meet, and in all corners of the field.
  for (const SampleRect& at : std::vector<SampleRect>{{70, 80, 1, 1},
                                                      {63, 63, 2, 2},
                                                      {0, 0, 1, 1},
                                                      {kCols - 1, 0, 1, 1},
                                                      {0, kRows - 1, 1, 1},
                                                      {kCols - 1, kRows - 1, 1, 1}}) {
    ground.fill(at, 900);
    EXPECT_EQ(ground.extent().max, 900);
    ground.fill(at, 100);
    EXPECT_EQ(ground.extent().min, 100);
    ground.fill(at, 500);
    EXPECT_EQ(ground.extent().min, 500);
    EXPECT_EQ(ground.extent().max, 500);
  }
}

TYPED_TEST(SampleExtentTest, RescansFullyOverwrittenTiles) {
  Ground<TypeParam> ground({});
  ground.fill({64, 64, 64, 64}, 900);
  ground.fill({128, 128, kCols - 128, kRows - 128}, 100);  // clipped by both borders
  ground.fill({60, 60, kCols - 60, kRows - 60}, 700);
  ground.fill({0, 0, kCols, kRows}, 300);
  EXPECT_EQ(ground.extent().min, 300);
  EXPECT_EQ(ground.extent().max, 300);
}

TYPED_TEST(SampleExtentTest, CoversTheFullRangeOfTheType) {
  Ground<TypeParam> ground({});
  const auto lowest = std::numeric_limits<TypeParam>::lowest(), highest = std::numeric_limits<TypeParam>::max();
  ground.fill({0, 0, kCols, kRows}, lowest);
  ground.fill({0, 0, kCols, kRows}, highest);
  ground.fill({5, 5, 1, 1}, lowest);
}

TYPED_TEST(SampleExtentTest, CountsNodataAddedAndRemoved) {
  // Above all samples and below all: either would show if taken for ground.
  for (const int nodata : {0, 9999}) {
    Ground<TypeParam> ground(static_cast<TypeParam>(nodata));
    ground.fill({kCols - 3, kRows - 3, 3, 3}, static_cast<TypeParam>(nodata));
    ground.fill({10, 20, 150, 100}, static_cast<TypeParam>(nodata));
    EXPECT_EQ(ground.extent().nodata, 15009);
    ground.fill({11, 20, 1, 1}, 700);
    ground.fill({10, 20, 150, 100}, 500);
    EXPECT_EQ(ground.extent().nodata, 9);
    ground.fill({0, 0, kCols, kRows}, static_cast<TypeParam>(nodata));
    EXPECT_EQ(ground.extent().nodata, kCols * kRows);
    ground.fill({7, 7, 1, 1}, 500);
    EXPECT_EQ(ground.extent().nodata, kCols * kRows - 1);
  }
}

TEST(SampleExtent, CountsNaNWithAndWithoutDeclaredNodata) {
  for (const std::optional<float> nodata : {std::optional<float>(), std::optional<float>(0.0f)}) {
    Ground<float> ground(nodata);
    ground.fill({50, 50, 40, 40}, -std::numeric_limits<float>::quiet_NaN());
    ground.fill({60, 60, 5, 5}, -0.0f);
    EXPECT_EQ(ground.extent().nodata, nodata ? 1600 : 1575);
    ground.fill({50, 50, 40, 40}, 500);
    EXPECT_EQ(ground.extent().nodata, 0);
  }
}

TYPED_TEST(SampleExtentTest, MatchesAFullScanAfterEdits) {
  std::mt19937 random(5);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (const std::optional<TypeParam> nodata : {std::optional<TypeParam>(), std::optional<TypeParam>(TypeParam{7})}) {
    Ground<TypeParam> ground(nodata);
    for (int i = 0; i < 150; ++i) {
      SampleRect rect{below(kCols), below(kRows), 1, 1};
      rect.cols = 1 + below(kCols - rect.col);
      rect.rows = 1 + below(kRows - rect.row);
      const int high = 8 + below(1000);
      ground.edit(rect, [&] { return static_cast<TypeParam>(below(high)); });
      ASSERT_FALSE(this->HasFailure()) << "edit " << i;
    }
  }
}

}  // namespace
}  // namespace scarp
