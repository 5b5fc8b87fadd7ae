// SPDX-License-Identifier: MIT
#include "app/cli/options/map_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/source/raster/ground_scale.h"

namespace scarp::cli {
namespace {

// Nodes [first, last] x [first, last], as far as they are in the raster.
RasterWindow clipped(const MapInput& input, double first_col, double first_row, double last_col, double last_row) {
  const auto clamp = [](double at, int side) { return static_cast<int>(std::clamp(at, 0.0, side - 1.0)); };
  const int col = clamp(first_col, input.cols()), row = clamp(first_row, input.rows());
  return {col, row, clamp(last_col, input.cols()) - col + 1, clamp(last_row, input.rows()) - row + 1};
}

// A lower bound of the length of a row step, on all planes of the raster.
double shortest_row_step(const MapInput& input) {
  const Georeference& geo = input.georeference();
  const auto& m = geo.map_from_node;
  if (geo.crs_wkt.empty()) return geo.cell_y_m;
  const auto step = [&](double col, double row) {
    return -m[5] * ground_scale_at(geo.crs_wkt, m[0] + col * m[1], m[3] + row * m[5]).metres_per_y;
  };
  // In degrees, steps along a meridian are shortest where it comes closest to the equator.
  if (is_geographic(geo)) return step(input.centre().x, std::clamp(-m[3] / m[5], 0.0, input.rows() - 1.0));
  constexpr int kAlong = 9;
  std::array<double, kAlong * kAlong> steps{};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto place = [](std::size_t at, int nodes) { return static_cast<double>(at) * (nodes - 1) / (kAlong - 1); };
    try {
      steps[i] = step(place(i % kAlong, input.cols()), place(i / kAlong, input.rows()));
    } catch (const Error&) {  // outside the domain of the CRS
      steps[i] = geo.cell_y_m;
    }
  }
  // Between places, steps differ from those there by less than neighbours do from one another.
  double difference = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i % kAlong > 0) difference = std::max(difference, std::abs(steps[i] - steps[i - 1]));
    if (i >= kAlong) difference = std::max(difference, std::abs(steps[i] - steps[i - kAlong]));
  }
  return *std::min_element(steps.begin(), steps.end()) - difference;
}

double area(const RasterWindow& part) { return static_cast<double>(part.cols) * part.rows; }

// Reading a part costs at least about as much as this many samples: a call, and blocks at its border.
constexpr double kCall = 1 << 16;

}  // namespace

RasterWindow part_around(MapInput& input, const Node& node, double distance) {
  if (!std::isfinite(distance)) return input.whole();
  const dvec2 cells = input.cells_at(node.col, node.row, distance);
  // One more than needed: quotients are rounded.
  const double cols = std::floor(distance / cells.x) + 1, rows = std::floor(distance / cells.y) + 1;
  return clipped(input, node.col - cols, node.row - rows, node.col + cols, node.row + rows);
}

RasterWindow part_of_line(const MapInput& input, const SightEnd& from, const SightEnd& to) {
  constexpr double kBeside = 1;  // cells
  return clipped(input, std::floor(std::min(from.col, to.col)) - kBeside,
                 std::floor(std::min(from.row, to.row)) - kBeside, std::ceil(std::max(from.col, to.col)) + kBeside,
                 std::ceil(std::max(from.row, to.row)) + kBeside);
}

RasterWindow union_of(std::span<const RasterWindow> parts) {
  RasterWindow all = parts.front();
  for (const RasterWindow& part : parts) {
    const int col = std::min(all.col, part.col), row = std::min(all.row, part.row);
    all = {col, row, std::max(all.col + all.cols, part.col + part.cols) - col,
           std::max(all.row + all.rows, part.row + part.rows) - row};
  }
  return all;
}

bool are_scattered(std::span<const RasterWindow> parts) {
  double sum = 0;
  for (const RasterWindow& part : parts) sum += area(part) + kCall;
  return area(union_of(parts)) > sum;
}

bool are_wasteful(std::span<const RasterWindow> parts, double samples, double reads) {
  constexpr double kMuch = 16e6;  // samples
  double largest = 0, all = 0;
  for (const RasterWindow& part : parts) largest = std::max(largest, area(part)), all += area(part) + kCall;
  if (!are_scattered(parts)) largest = all = area(union_of(parts));
  return largest > kMuch && samples + reads * kCall < all;
}

bool read_together(MapInput& input, std::span<const RasterWindow> parts) {
  if (are_scattered(parts)) return false;
  input.read(union_of(parts), terminal_progress("read"));
  input.close();
  return true;
}

RasterWindow rows_around(MapInput& input, const RasterWindow& rows, double distance) {
  if (!std::isfinite(distance)) return input.whole();
  const double beside = std::floor(distance / shortest_row_step(input)) + 2;
  return clipped(input, 0, rows.row - beside, input.cols() - 1, rows.row + rows.rows - 1 + beside);
}

void require_ground(const MapInput& input, const SightEnd& end, std::string_view who) {
  if (end.datum == HeightDatum::sea) return;
  const SightEnd here = in_part(input, end);
  if (SightGround(input.field()).height_at(rounded_end(here.col), rounded_end(here.row))) return;
  const dvec2 at = input.place_of(end.col, end.row);
  throw Error(
      fmt::format("{}: {:.10g},{:.10g} is on nodata (give its height above sea: --heights sea)", who, at.x, at.y));
}

SightEnd in_part(const MapInput& input, SightEnd end) {
  end.col -= input.part().col;
  end.row -= input.part().row;
  return end;
}

Node in_part(const MapInput& input, const Node& node) {
  return {node.col - input.part().col, node.row - input.part().row};
}

}  // namespace scarp::cli
