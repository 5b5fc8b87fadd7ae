// SPDX-License-Identifier: MIT
#include "scarp/source/raster/reading_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "scarp/base/error.h"
#include "scarp/source/raster/band_samples.h"

namespace scarp {
namespace {

// 2^40 samples take a quarter of an hour at a billion samples per second, about the speed of one pass over memory.
constexpr double kMostSamples = 1099511627776.0;

// The coarsest overview that has at least the wanted number of samples for the whole band; nullptr if there is none.
GDALRasterBand* overview_for(GDALRasterBand& band, double wanted_cols, double wanted_rows) {
  GDALRasterBand* best = nullptr;
  for (int i = 0; i < band.GetOverviewCount(); ++i) {
    GDALRasterBand* const overview = band.GetOverview(i);
    if (!overview || overview->GetXSize() < wanted_cols || overview->GetYSize() < wanted_rows) continue;
    if (overview->GetXSize() >= band.GetXSize() || has_own_mask(*overview) != has_own_mask(band)) continue;
    if (!best || overview->GetXSize() < best->GetXSize()) best = overview;
  }
  return best;
}

// The overview samples whose centres are in part of a side, and the spacing of the `out` samples computed from them.
struct Side {
  int first, count;
};
Side side_of_overview(int side, int overview_side, int first, int count) {
  const double per_sample = static_cast<double>(overview_side) / side;
  const int begin = static_cast<int>(std::lround(first * per_sample)),
            end = static_cast<int>(std::lround((static_cast<double>(first) + count) * per_sample));
  return {begin, std::max(end - begin, 1)};
}

// `begin` and `count` describe the averaged part, in samples of the requested window.
SampleSpacing spacing(double begin, double count, int out) {
  const double step = count / out;
  return {begin + (step - 1) / 2, step};
}

}  // namespace

SampleEnds stated_ends(GDALRasterBand& band) {
  const char *low = band.GetMetadataItem("STATISTICS_MINIMUM"), *high = band.GetMetadataItem("STATISTICS_MAXIMUM");
  if (!low || !high) return {};
  const SampleEnds ends{std::strtod(low, nullptr), std::strtod(high, nullptr)};
  return std::isfinite(ends.low) && std::isfinite(ends.high) && ends.low <= ends.high ? ends : SampleEnds{};
}

ReadingPlan plan_reading(GDALRasterBand& band, const RasterWindow& window, const std::optional<Decimation>& decimation,
                         bool own_nodata) {
  ReadingPlan plan{&band, window, false, window.cols, window.rows, {}, {}, {}, {}};
  const double asked = static_cast<double>(window.cols) * window.rows;
  if (!decimation || asked <= static_cast<double>(decimation->above)) return plan;
  plan.decimates = true;
  const DecimatedSize wanted = decimated_size(window.cols, window.rows, decimation->samples);
  plan.cols = wanted.cols;
  plan.rows = wanted.rows;
  std::string how = fmt::format("average of {0} x {0}", wanted.block);
  GDALRasterBand* const overview = overview_for(band, static_cast<double>(wanted.cols) * band.GetXSize() / window.cols,
                                                static_cast<double>(wanted.rows) * band.GetYSize() / window.rows);
  if (overview) {
    const Side across = side_of_overview(band.GetXSize(), overview->GetXSize(), window.col, window.cols),
               down = side_of_overview(band.GetYSize(), overview->GetYSize(), window.row, window.rows);
    // Averages whole blocks of the overview, which in most files has less than twice the wanted number of samples per
    // side.
    int block = std::max(1, std::min(across.count / wanted.cols, down.count / wanted.rows));
    const auto reduced = [&](int count) { return std::max((count + block - 1) / block, std::min(count, 2)); };
    while (static_cast<double>(reduced(across.count)) * reduced(down.count) > static_cast<double>(decimation->above))
      ++block;
    plan.band = overview;
    plan.window = {across.first, down.first, across.count, down.count};
    plan.cols = reduced(across.count);
    plan.rows = reduced(down.count);
    const double per_col = static_cast<double>(band.GetXSize()) / overview->GetXSize(),
                 per_row = static_cast<double>(band.GetYSize()) / overview->GetYSize();
    plan.across = spacing(across.first * per_col - window.col, across.count * per_col, plan.cols);
    plan.down = spacing(down.first * per_row - window.row, down.count * per_row, plan.rows);
    if (own_nodata && window.cols == band.GetXSize() && window.rows == band.GetYSize()) plan.known = stated_ends(band);
    how = fmt::format("overview of {} x {}{}, minimum and maximum of {}", overview->GetXSize(), overview->GetYSize(),
                      block > 1 ? fmt::format(", average of {0} x {0}", block) : "",
                      plan.known.low <= plan.known.high ? "the file's statistics" : "the overview");
  } else {
    plan.across = spacing(0, window.cols, plan.cols);
    plan.down = spacing(0, window.rows, plan.rows);
  }
  if (static_cast<double>(plan.window.cols) * plan.window.rows > kMostSamples)
    throw Error(
        fmt::format("{} x {} samples are too many to read (read a part with --window COL,ROW,COLS,ROWS, or add "
                    "overviews: gdaladdo FILE)",
                    window.cols, window.rows));
  plan.note = fmt::format("{} x {} samples, rendered from {} x {} ({}; --full reads all)", window.cols, window.rows,
                          plan.cols, plan.rows, how);
  return plan;
}

}  // namespace scarp
