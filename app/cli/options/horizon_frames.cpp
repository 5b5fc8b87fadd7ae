// SPDX-License-Identifier: MIT
#include "app/cli/options/horizon_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
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
// Share of --plane-error that the other nodes of a strip or block may have.
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

// Metres up to which samples of the raster matter.
double reach_over(const MapInput& input, const HorizonInput& horizon) {
  const Georeference& geo = input.georeference();
  return std::min(horizon.reach(), std::hypot(input.cols() * geo.cell_x_m, input.rows() * geo.cell_y_m));
}

// The place `i` of kPlaces along an axis of `nodes`.
double place_along(int nodes, std::size_t i) { return static_cast<double>(i) * (nodes - 1) / (kPlaces - 1); }

// How far lengths and north of a raster differ over it: a quantity at kPlaces^2 places.
class Variation {
 public:
  // `value`: of a position.
  Variation(const MapInput& input, const std::function<double(double col, double row)>& value)
      : cols_(input.cols()), rows_(input.rows()) {
    for (std::size_t r = 0; r < kPlaces; ++r)
      for (std::size_t c = 0; c < kPlaces; ++c)
        by_row_[r][c] = by_col_[c][r] = value(place_along(cols_, c), place_along(rows_, r));
  }
  double largest() const {
    double most = 0;
    for (const auto& row : by_row_)
      for (const double value : row) most = std::max(most, std::abs(value));
    return most;
  }
  double per_col() const { return most_of(by_row_, cols_); }
  double per_row() const { return most_of(by_col_, rows_); }

 private:
  using Values = std::array<std::array<double, kPlaces>, kPlaces>;
  static double most_of(const Values& lines, int cells) {
    double most = 0;
    for (const auto& line : lines) most = std::max(most, steepest(line, cells));
    return most;
  }
  int cols_, rows_;
  Values by_row_{}, by_col_{};
};

}  // namespace

HorizonFrames::HorizonFrames(MapInput& input, const HorizonInput& horizon, double plane_error, FrameUse use)
    : cols_(input.cols()), rows_(input.rows()), geographic_(is_geographic(input.georeference())) {
  if (geographic_) {
    divide_degrees(input, horizon, plane_error);
  } else {
    divide_by_lengths(input, horizon, plane_error);
    if (use != FrameUse::lengths) divide_by_north(input, horizon.swept());
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
  const double reach = reach_over(input, horizon);
  // One plane, and its note; throws if it does not do.
  if (horizon.swept() || (!is_plane && !horizon.max_distance)) input.field_at(centre.x, centre.y, HUGE_VAL);
  if (horizon.swept()) return;
  // A raster twice as wide: all nodes of a row have the same plane.
  const MetricPlanes wide(geo, 2 * input.cols() - 1, input.rows());
  std::array<double, kPlaces> lengths{};
  double error = is_plane ? whole.error_cells : 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double row = place_along(input.rows(), i);
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

void HorizonFrames::divide_by_lengths(MapInput& input, const HorizonInput& horizon, double plane_error) {
  const Georeference& geo = input.georeference();
  const double reach = reach_over(input, horizon), cells = reach / std::min(geo.cell_x_m, geo.cell_y_m);
  // Cells by which samples at the reach are displaced, on the plane of the centre.
  const auto of_axis = [&](int axis) {
    return Variation(input, [&geo, cells, axis](double col, double row) {
      const dvec2 lengths = lengths_at(geo, col, row);
      return cells * (axis == 0 ? std::log(lengths.x / geo.cell_x_m) : std::log(lengths.y / geo.cell_y_m));
    });
  };
  const Variation x = of_axis(0), y = of_axis(1);
  const double off_centre = std::max(x.largest(), y.largest());
  if (off_centre <= kStripShare * plane_error) return;
  const MetricPlanes planes(geo, input.cols(), input.rows());
  const auto error_around = [&](double col, double row) {
    return scale_at(geo, col, row) ? planes.around({col, row}, reach).error_cells : 0;
  };
  double error = Variation(input, error_around).largest();
  if (horizon.swept()) {
    error += off_centre;
  } else {
    const double per_col = std::max(x.per_col(), y.per_col()), per_row = std::max(x.per_row(), y.per_row());
    // Half of the share for each axis.
    const auto side = [&](double per_cell) {
      return per_cell > 0 ? side_up_to(kStripShare * plane_error / per_cell, kLeastStrip) : INT_MAX;
    };
    cols_ = std::min(cols_, side(per_col)), rows_ = std::min(rows_, side(per_row));
    error += (per_col * cols_ + per_row * rows_) / 2;
  }
  if (error <= plane_error) {
    if (!horizon.swept() && (cols_ < input.cols() || rows_ < input.rows()))
      input.notes.push_back(fmt::format(
          "computed on metric planes, one for {} x {} pixels, samples up to {:.2g} cells off", cols_, rows_, error));
    return;
  }
  throw Error(
      fmt::format("{}: samples up to {:.10g} m away are up to {:.2g} cells off the metric plane of {}, limit "
                  "{} ({}; or raise --plane-error)",
                  input.path(), reach, error, horizon.swept() ? "the centre" : "a block", plane_error,
                  horizon.swept() ? "use --engine exact with --max-distance" : "set a smaller --max-distance"));
}

void HorizonFrames::divide_by_north(MapInput& input, bool swept) {
  const Georeference& geo = input.georeference();
  const Variation turn(input, [&](double col, double row) {
    const auto scale = scale_at(geo, col, row);
    const double north = scale ? scale->grid_north_azimuth : geo.grid_north_azimuth;
    return std::remainder(north - geo.grid_north_azimuth, 2 * std::numbers::pi);
  });
  const double off = turn.largest();
  north_off_ = off;
  if (off <= kMostTurn) return;
  if (swept) {
    input.notes.push_back(
        fmt::format("azimuths are from true north at the centre, up to {:.2g} degrees off elsewhere "
                    "(--engine exact)",
                    off * kDegreesPerRadian));
    return;
  }
  const double per_col = turn.per_col(), per_row = turn.per_row();
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
      if (const auto scale = single_ ? std::nullopt : scale_at(geo, frame.middle.x, frame.middle.y)) {
        frame.grid_north = scale->grid_north_azimuth;
        frame.cells = lengths_at(geo, frame.middle.x, frame.middle.y);
      }
      frames.push_back(frame);
    }
  }
  return frames;
}

Metadata HorizonFrames::metadata() const {
  if (single_) return {};
  const std::string north = north_off_ ? fmt::format(" and the north at its middle; north within {:.2g} degrees",
                                                     *north_off_ * kDegreesPerRadian)
                                       : " at its middle";
  return {{"BLOCKS", fmt::format("{} x {} pixels, each with the cell lengths{}", cols_, rows_, north)}};
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
