// SPDX-License-Identifier: MIT
#include "app/cli/commands/viewshed_stations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "app/cli/options/path_file.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

constexpr double kMostStations = 1e6;

dvec2 sample_at(const dvec2& at) { return {std::floor(at.x + 0.5), std::floor(at.y + 0.5)}; }

std::vector<Vertex> along_line(MapInput& input, const PlaceTable& shapes, std::size_t row, double spacing) {
  Polyline line = polyline_of(input, shapes, row);
  const std::vector<double> lengths = measure(input, line);
  std::vector<Vertex> found;
  dvec2 last(-1.0);
  for (const Station& station : stations_of(line, lengths, spacing, "--observer-spacing", kMostStations)) {
    const dvec2 sample = sample_at(station.vertex.at);
    if (sample != std::exchange(last, sample)) found.push_back(station.vertex);
  }
  return found;
}

using Rings = std::vector<std::vector<dvec2>>;

// The columns at which the borders cross a row, in order: between the first and the second, the third and the fourth,
// ... are the parts inside.
std::vector<double> spans_of(const Rings& rings, double row) {
  std::vector<double> cols;
  for (const auto& ring : rings) {
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const dvec2 &a = ring[i - 1], &b = ring[i];
      // Half open, so that a vertex on the row counts once.
      if ((a.y <= row) != (b.y <= row)) cols.push_back(a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  }
  std::sort(cols.begin(), cols.end());
  return cols;
}

// Evenly spaced positions from `low` to `high`, with equal margins.
std::vector<double> positions(double low, double high, double step) {
  const double count = std::max(1.0, std::floor((high - low) / step));
  std::vector<double> found;
  for (double k = 0; k < count; ++k) found.push_back((low + high) / 2 + (k - (count - 1) / 2) * step);
  return found;
}

std::vector<Vertex> over_polygon(MapInput& input, const PlaceTable& shapes, std::size_t row, double spacing) {
  const std::string what = shapes.where(row);
  Rings rings;
  dvec2 low(HUGE_VAL), high(-HUGE_VAL);
  for (const auto& ring : shapes.rows[row].rings) {
    auto& to = rings.emplace_back();
    for (const TablePlace& place : ring) {
      to.push_back(input.grid_of(place, shapes.lonlat, what));
      low = {std::min(low.x, to.back().x), std::min(low.y, to.back().y)};
      high = {std::max(high.x, to.back().x), std::max(high.y, to.back().y)};
    }
  }
  const dvec2 step = dvec2(spacing) / input.cells_at(low.x, low.y, 0), size = (high - low) / step;
  if ((size.x + 1) * (size.y + 1) > kMostStations)
    throw Error(
        fmt::format("{}: --observer-spacing {:.10g}: more than {:.0f} observers", what, spacing, kMostStations));
  std::vector<Vertex> found;
  std::set<std::pair<double, double>> samples;
  const auto add = [&](const dvec2& at) {
    const dvec2 sample = sample_at(at);
    if (samples.emplace(sample.x, sample.y).second) found.push_back({at, std::nullopt});
  };
  double widest = -1;
  dvec2 middle(0.0);
  for (const double y : positions(low.y, high.y, step.y)) {
    const std::vector<double> spans = spans_of(rings, y);
    for (std::size_t k = 0; k + 1 < spans.size(); k += 2) {
      if (spans[k + 1] - spans[k] > widest)
        widest = spans[k + 1] - spans[k], middle = {(spans[k] + spans[k + 1]) / 2, y};
      for (const double x : positions(low.x, high.x, step.x))
        if (x >= spans[k] && x <= spans[k + 1]) add({x, y});
    }
  }
  if (found.empty() && widest >= 0) add(middle);
  if (found.empty()) throw Error(fmt::format("{}: the polygon has no area", what));
  return found;
}

}  // namespace

PlaceTable stations_on(MapInput& input, const PlaceTable& shapes, double spacing, bool skip) {
  PlaceTable table;
  table.path = shapes.path;
  table.vector = shapes.vector;
  table.notes = shapes.notes;
  table.carried.names = shapes.carried.names;
  const auto add = [&](PlaceRow row, std::size_t shape) {
    table.rows.push_back(std::move(row));
    for (std::size_t k = 0; k < shapes.carried.names.size(); ++k)
      table.carried.cells.push_back(shapes.carried.at(shape, k));
  };
  for (std::size_t i = 0; i < shapes.rows.size(); ++i) {
    const PlaceRow& shape = shapes.rows[i];
    try {
      if (!shape.bad.empty()) throw Error(shape.bad);
      for (const Vertex& vertex :
           shape.rings.empty() ? along_line(input, shapes, i, spacing) : over_polygon(input, shapes, i, spacing)) {
        const dvec2 place = input.place_of(vertex.at.x, vertex.at.y);
        add({{place.x, place.y, vertex.z}, {}, shape.line}, i);
      }
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      if (!skip) throw;
      add({{}, {}, shape.line, 0, error.what()}, i);
    }
  }
  return table;
}

}  // namespace scarp::cli
