// SPDX-License-Identifier: MIT
#include "scarp/analysis/map_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "scarp/analysis/observer_count.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

RowBand all_rows(const HeightField& field) { return {0, field.rows()}; }

// The rows as a separate field, over the same samples.
HeightField rows_of(const HeightField& field, const RowBand& band) {
  if (band == all_rows(field)) return field;
  return field.visit([&](const auto& grid) {
    return HeightField::view(grid.data + band.first * grid.row_stride, grid.cols, band.rows(), field.settings(),
                             grid.row_stride);
  });
}

// Computes a map of the relevant rows by compute(field, number of its first row), and returns its band.
template <class Compute>
auto band_of(const HeightField& field, const RowBand& matter, const RowBand& band, const Compute& compute) {
  auto map = compute(rows_of(field, matter), matter.first);
  if (matter == band) return map;
  const auto row = [&](int i) { return map.begin() + static_cast<std::ptrdiff_t>(i - matter.first) * field.cols(); };
  return decltype(map)(row(band.first), row(band.last));
}

// A line of sight has no crossing outside the rows of its ends.
RowBand rows_between(const Node& observer, const RowBand& band) {
  return {std::min(observer.row, band.first), std::max(observer.row + 1, band.last)};
}

// Whether all rows are beyond the largest distance.
bool out_of_reach(const Viewpoint& view, const RowBand& band) {
  const int row = std::clamp(view.observer().row, band.first, band.last - 1);
  const double most = view.settings().max_distance;
  return view.ground().square_distance(view.observer().col, row) > most * most;
}

template <class Value>
std::vector<Value> fill_rows(const Viewpoint& view, const RowBand& band, Value ground, Value hole) {
  std::vector<Value> map;
  map.reserve(static_cast<std::size_t>(band.rows()) * static_cast<std::size_t>(view.ground().field().cols()));
  for (int row = band.first; row < band.last; ++row)
    for (int col = 0; col < view.ground().field().cols(); ++col)
      map.push_back(view.ground().height({col, row}) ? ground : hole);
  return map;
}

// Rows or columns, of `lines` in all; the ray crosses `step` of them along its vector.
RowBand lines_towards(const SunRay& ray, std::int64_t step, int lines, const RowBand& band, double relief) {
  // A ray is no longer blocked once it is above all ground. One line more for the ground next to the first crossing,
  // and one for rounding.
  constexpr int kMargin = 2;
  const double reach = kMargin + std::abs(static_cast<double>(step)) * relief / ray.rise;
  const int more = static_cast<int>(std::min<double>(std::ceil(reach), lines));
  return step < 0 ? RowBand{std::max(0, band.first - more), band.last}
                  : RowBand{band.first, std::min(lines, band.last + (step > 0 ? more : 0))};
}

}  // namespace

RowBand rows_towards(const NodeSteps& steps, int rows, const SunDirection& sun, const RowBand& band, double relief) {
  const SunRay ray = sun_ray(steps, sun);
  return lines_towards(ray, ray.row, rows, band, relief);
}

RowBand cols_towards(const NodeSteps& steps, int cols, const SunDirection& sun, const RowBand& band, double relief) {
  const SunRay ray = sun_ray(steps, sun);
  return lines_towards(ray, ray.col, cols, band, relief);
}

void require_band(const HeightField& field, const RowBand& band) {
  if (band.first < 0 || band.last > field.rows() || band.first >= band.last)
    throw Error(
        fmt::format("rows {} to {}: not within the {} rows of the map", band.first, band.last - 1, field.rows()));
}

RowBand row_band(int rows, int part, int parts) {
  if (part < 1 || part > parts) throw Error(fmt::format("part {} of {}: expected 1 to {}", part, parts, parts));
  if (parts > rows) throw Error(fmt::format("{} parts: the map has {} rows", parts, rows));
  const auto begin = [&](int i) { return static_cast<int>(std::int64_t{rows} * i / parts); };
  return {begin(part - 1), begin(part)};
}

std::vector<Seen> viewshed_rows(const HeightField& field, Node observer, const ViewshedSettings& settings,
                                const RowBand& band, const Progress& progress) {
  require_band(field, band);
  const Viewpoint view(field, observer, settings);
  if (out_of_reach(view, band)) return fill_rows(view, band, Seen::out_of_range, Seen::hole);
  return band_of(field, rows_between(observer, band), band, [&](const HeightField& rows, int first) {
    return viewshed(rows, {observer.col, observer.row - first}, settings, progress);
  });
}

std::vector<double> least_visible_rows(const HeightField& field, Node observer, const ViewshedSettings& settings,
                                       const RowBand& band, const Progress& progress) {
  require_band(field, band);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Viewpoint view(field, observer, settings);
  if (out_of_reach(view, band)) return fill_rows(view, band, kNan, kNan);
  return band_of(field, rows_between(observer, band), band, [&](const HeightField& rows, int first) {
    return least_visible(rows, {observer.col, observer.row - first}, settings, progress);
  });
}

std::vector<std::uint16_t> observer_count_rows(std::span<const Viewpoint> views, const RowBand& band,
                                               const Progress& progress) {
  if (views.empty() || band == all_rows(views.front().ground().field())) return observer_count(views, progress);
  // Each observer has its own relevant rows.
  std::vector<std::uint16_t> counts;
  for (const Viewpoint& view : views) {
    const auto codes = viewshed_rows(view.ground().field(), view.observer(), view.settings(), band, progress);
    counts.resize(codes.size(), kCountOutOfRange);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (codes[i] == Seen::hole) counts[i] = kCountHole;
      if (codes[i] == Seen::hole || codes[i] == Seen::out_of_range) continue;
      if (counts[i] == kCountOutOfRange) counts[i] = 0;
      counts[i] = static_cast<std::uint16_t>(counts[i] + (codes[i] == Seen::visible));
    }
  }
  return counts;
}

std::vector<Shade> shadow_rows(const HeightField& field, const SunDirection& sun, const RowBand& band,
                               const Progress& progress) {
  require_band(field, band);
  const double relief = field.max_height() - field.min_height();
  return band_of(field, rows_towards(node_steps(field), field.rows(), sun, band, relief), band,
                 [&](const HeightField& rows, int) { return shadow(rows, sun, progress); });
}

}  // namespace scarp
