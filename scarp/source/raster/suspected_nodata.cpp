// SPDX-License-Identifier: MIT
#include "scarp/source/raster/suspected_nodata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

namespace scarp {
namespace {

constexpr double kLowMarks[] = {-32768, -32767, -9999, -99999, -999999};
// From the Challenger Deep, -10,935 m, to the top of Everest, 8,849 m, rounded up: heights on Earth differ by no more,
// so no step between successive values is larger.
constexpr double kReliefOfTheEarth_m = 20000;

// Real coasts have lower samples than this somewhere: a sea that no sample approaches is a collar of zeros, as gdalwarp
// writes around rasters without a nodata value.
constexpr double kLowestCoast_m = 100;

template <class T>
bool any_corner_is_zero(const std::vector<T>& samples, int cols, int rows) {
  const auto at = [&](int col, int row) {
    return samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
  };
  return at(0, 0) == 0 || at(cols - 1, 0) == 0 || at(0, rows - 1) == 0 || at(cols - 1, rows - 1) == 0;
}

// The lowest and highest value, and those next to them.
struct Ends {
  double lowest, above_lowest, below_highest, highest;
  bool several = false;  // whether there are several values; otherwise no next value exists
};

template <class T>
Ends ends_of(const std::vector<T>& samples, std::optional<double> nodata) {
  constexpr bool floating = std::is_floating_point_v<T>;
  constexpr T most = floating ? std::numeric_limits<T>::infinity() : std::numeric_limits<T>::max(),
              least = floating ? -most : std::numeric_limits<T>::lowest();
  T lowest = most, above_lowest = most, below_highest = least, highest = least;
  // NaN is a hole in float samples, and fails all comparisons.
  for (const T sample : samples) {
    if (nodata && sample == *nodata) continue;
    if (sample < above_lowest && sample != lowest) {
      above_lowest = sample < lowest ? lowest : sample;
      lowest = std::min(lowest, sample);
    }
    if (sample > below_highest && sample != highest) {
      below_highest = sample > highest ? highest : sample;
      highest = std::max(highest, sample);
    }
  }
  return {static_cast<double>(lowest), static_cast<double>(above_lowest), static_cast<double>(below_highest),
          static_cast<double>(highest), lowest < highest};
}

}  // namespace

std::vector<std::string> suspected_nodata(const Raster& raster, std::optional<double> greatest) {
  const Ends ends = std::visit([&](const auto& samples) { return ends_of(samples, raster.nodata); }, raster.samples);
  std::vector<std::string> notes;
  const auto look_at = [&](std::string_view end, double value, bool marked, bool marked_if_apart, double gap,
                           double range_of_others) {
    // If there are only two values, either one is isolated; the ground is the one nearer to height 0.
    const bool of_two = ends.lowest == ends.below_highest;
    const bool apart = ends.several && gap > range_of_others &&
                       (!of_two || std::abs(value) == std::max(std::abs(ends.lowest), std::abs(ends.highest)));
    const bool far = apart && gap * std::abs(raster.scale) > kReliefOfTheEarth_m;
    if (!marked && !(marked_if_apart && apart) && !far) return;
    notes.push_back(fmt::format("the {} sample is {}{}, which often marks holes (if so, add --nodata={})", end, value,
                                far ? fmt::format(", more than {} km from all others", kReliefOfTheEarth_m / 1000) : "",
                                value));
  };
  look_at("lowest", ends.lowest,
          ends.lowest < -kBeyondHeights ||
              std::find(std::begin(kLowMarks), std::end(kLowMarks), ends.lowest) != std::end(kLowMarks),
          false, ends.above_lowest - ends.lowest, ends.highest - ends.above_lowest);
  // If there are only two values, either may be the ground.
  const bool far_above_zero = ends.lowest == 0 && ends.lowest != ends.below_highest && ends.several &&
                              ends.above_lowest * std::abs(raster.scale) > kLowestCoast_m;
  if (far_above_zero &&
      std::visit([&](const auto& samples) { return any_corner_is_zero(samples, raster.cols, raster.rows); },
                 raster.samples))
    notes.push_back(
        fmt::format("the lowest sample is 0, also at a corner, and all others are at least {:.10g}: zeros may be a "
                    "collar without ground (if so, add --nodata=0)",
                    ends.above_lowest));
  // As float32, to which samples of wide types were converted.
  const bool is_greatest = greatest && static_cast<float>(ends.highest) == static_cast<float>(*greatest);
  look_at("highest", ends.highest, ends.highest > kBeyondHeights, is_greatest, ends.highest - ends.below_highest,
          ends.below_highest - ends.lowest);
  return notes;
}

}  // namespace scarp
