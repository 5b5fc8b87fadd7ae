// SPDX-License-Identifier: MIT
#include "app/cli/options/horizon_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/source/raster/ground_scale.h"
#include "scarp/source/raster/metric_plane.h"

namespace scarp::cli {
namespace {

// North and zenith of a block's corners differ from those of its middle by at most this, a tenth of the width of the
// sun, or by what blocks of kLeastSide have.
constexpr double kMostTurn = 0.05 / kDegreesPerRadian;
constexpr int kLeastSide = 128, kLeastStrip = 16;
// Share of --plane-error that the other rows of a strip may have.
constexpr double kStripShare = 0.25;
// Places per side at which scale and north of a raster are sampled.
constexpr int kPlaces = 5;

// The scale at a position of the raster; nullopt without a CRS and outside its domain.
std::optional<GroundScale> scale_at(const Georeference& geo, double col, double row) {
  const auto& m = geo.map_from_node;
  if (geo.crs_wkt.empty()) return std::nullopt;
  try {
    return ground_scale_at(geo.crs_wkt, m[0] + col * m[1], m[3] + row * m[5]);
  } catch (const Error&) {
    return std::nullopt;
  }
}

dvec2 lengths_at(const Georeference& geo, double col, double row) {
  const auto scale = scale_at(geo, col, row);
  if (!scale) return {geo.cell_x_m, geo.cell_y_m};
  return {scale->metres_per_x * geo.map_from_node[1], scale->metres_per_y * -geo.map_from_node[5]};
}

// The largest power of two up to `most`, at least `least`.
int side_up_to(double most, int least) {
  constexpr double kLargest = 1 << 30;
  return std::max(least, static_cast<int>(std::bit_floor(static_cast<unsigned>(std::clamp(most, 1.0, kLargest)))));
}

// Largest change of a quantity per step, over `cells` cells in which it is known at kPlaces places.
double steepest(const std::array<double, kPlaces>& values, int cells) {
  double largest = 0;
  for (std::size_t i = 1; i < kPlaces; ++i) largest = std::max(largest, std::abs(values[i] - values[i - 1]));
  return cells > 1 ? largest * (kPlaces - 1) / (cells - 1) : 0;
}

}  // namespace

HorizonFrames::HorizonFrames(MapInput& input, const HorizonInput& horizon, double plane_error, FrameUse use)
    : cols_(input.cols()), rows_(input.rows()), geographic_(is_geographic(input.georeference())) {
  if (geographic_) {
    divide_degrees(input, horizon, plane_error);
  } else if (use != FrameUse::lengths) {
    divide_by_north(input, horizon.swept());
  }
  if (use == FrameUse::suns && !horizon.swept()) {
    const Georeference& geo = input.georeference();
    const double most = kMostTurn * input.curvature().diameter / 2 / std::hypot(geo.cell_x_m, geo.cell_y_m) * 2;
    cols_ = std::min(cols_, side_up_to(most, kLeastSide)), rows_ = std::min(rows_, side_up_to(most, kLeastSide));
  }
  single_ = cols_ == input.cols() && rows_ == input.rows();
}

void HorizonFrames::divide_degrees(MapInput& input, const HorizonInput& horizon, double plane_error) {
  const Georeference& geo = input.georeference();
  const dvec2 centre = input.centre();
  const MetricPlane whole = MetricPlanes(geo, input.cols(), input.rows()).around(centre, HUGE_VAL);
  const bool is_plane = whole.error_cells <= plane_error;
  const double reach = std::min(horizon.reach(), std::hypot(input.cols() * geo.cell_x_m, input.rows() * geo.cell_y_m));
  // One plane, and its note; throws if it does not do.
  if (horizon.swept() || (!is_plane && !horizon.max_distance)) input.field_at(centre.x, centre.y, HUGE_VAL);
  if (horizon.swept()) return;
  // A raster twice as wide: all nodes of a row have the same plane.
  const MetricPlanes wide(geo, 2 * input.cols() - 1, input.rows());
  std::array<double, kPlaces> lengths{};
  double error = is_plane ? whole.error_cells : 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double row = static_cast<double>(i) * (input.rows() - 1) / (kPlaces - 1);
    lengths[i] = std::log(lengths_at(geo, centre.x, row).x);
    if (!is_plane) error = std::max(error, wide.around({input.cols() - 1.0, row}, reach).error_cells);
  }
  // A row further, cells at a distance are this much off.
  const double per_row = steepest(lengths, input.rows()) * reach / geo.cell_x_m;
  const double most = per_row > 0 ? 2 * kStripShare * plane_error / per_row : HUGE_VAL;
  rows_ = std::min(rows_, side_up_to(most, kLeastStrip));
  if (!is_plane) error += per_row * rows_ / 2;
  if (!(error <= plane_error))
    throw Error(
        fmt::format("{}: degrees: samples up to {:.10g} m away are up to {:.2g} cells off the metric plane of a row, "
                    "limit {} (set a smaller --max-distance; or raise --plane-error; or first: gdalwarp to a "
                    "projected CRS)",
                    input.path(), reach, error, plane_error));
  if (rows_ == input.rows()) {
    input.field_at(centre.x, centre.y, HUGE_VAL);
  } else {
    input.notes.push_back(fmt::format(
        "degrees: computed on metric planes, one for {} rows, samples up to {:.2g} cells off", rows_, error));
  }
}

void HorizonFrames::divide_by_north(MapInput& input, bool swept) {
  const Georeference& geo = input.georeference();
  std::array<std::array<double, kPlaces>, kPlaces> by_row{}, by_col{};
  double off = 0, per_col = 0, per_row = 0;
  for (std::size_t r = 0; r < kPlaces; ++r) {
    for (std::size_t c = 0; c < kPlaces; ++c) {
      const double col = static_cast<double>(c) * (input.cols() - 1) / (kPlaces - 1);
      const auto scale = scale_at(geo, col, static_cast<double>(r) * (input.rows() - 1) / (kPlaces - 1));
      const double north = scale ? scale->grid_north_azimuth : geo.grid_north_azimuth;
      const double turn = std::remainder(north - geo.grid_north_azimuth, 2 * std::numbers::pi);
      by_row[r][c] = by_col[c][r] = turn;
      off = std::max(off, std::abs(turn));
    }
  }
  north_off_ = off;
  if (off <= kMostTurn) return;
  if (swept) {
    input.notes.push_back(
        fmt::format("azimuths are from true north at the centre, up to {:.2g} degrees off elsewhere "
                    "(--engine exact)",
                    off * kDegreesPerRadian));
    return;
  }
  for (std::size_t i = 0; i < kPlaces; ++i)
    per_col = std::max(per_col, steepest(by_row[i], input.cols())),
    per_row = std::max(per_row, steepest(by_col[i], input.rows()));
  const int side = side_up_to(2 * kMostTurn / (per_col + per_row), kLeastSide);
  cols_ = std::min(cols_, side), rows_ = std::min(rows_, side);
  north_off_ = (per_col * cols_ + per_row * rows_) / 2;
}

std::vector<HorizonFrame> HorizonFrames::of(MapInput& input, const RowBand& rows) const {
  const Georeference& geo = input.georeference();
  const RasterWindow& part = input.part();
  std::vector<HorizonFrame> frames;
  for (int row = (part.row + rows.first) / rows_ * rows_; row < part.row + rows.last; row += rows_) {
    for (int col = part.col / cols_ * cols_; col < part.col + part.cols; col += cols_) {
      const int col_end = std::min(col + cols_, input.cols()), row_end = std::min(row + rows_, input.rows());
      HorizonFrame frame{{std::max(col - part.col, 0), std::max(row - part.row, rows.first),
                          std::min(col_end - part.col, part.cols), std::min(row_end - part.row, rows.last)},
                         {geo.cell_x_m, geo.cell_y_m},
                         geo.grid_north_azimuth,
                         {0.5 * (col + col_end - 1), 0.5 * (row + row_end - 1)}};
      if (geographic_) frame.cells = lengths_at(geo, frame.middle.x, frame.middle.y);
      if (const auto scale = single_ ? std::nullopt : scale_at(geo, frame.middle.x, frame.middle.y))
        frame.grid_north = scale->grid_north_azimuth;
      frames.push_back(frame);
    }
  }
  return frames;
}

Metadata HorizonFrames::metadata() const {
  if (single_) return {};
  return {{"BLOCKS", fmt::format("{} x {} pixels, each with the cell lengths and the north at its middle; north within "
                                 "{:.2g} degrees",
                                 cols_, rows_, north_off_ * kDegreesPerRadian)}};
}

void for_each_frame(const std::vector<HorizonFrame>& frames,
                    const std::function<void(const HorizonFrame&, const Progress&)>& body, const Progress& progress) {
  if (frames.size() == 1) return body(frames.front(), progress);
  parallel_for(
      static_cast<std::int64_t>(frames.size()), 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) body(frames[static_cast<std::size_t>(i)], {});
      },
      progress);
}

}  // namespace scarp::cli
