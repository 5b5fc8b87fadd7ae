// SPDX-License-Identifier: MIT
#include "app/cli/options/path_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {

PlaceTable read_paths(const PlaceFile& file) {
  const std::string extension = extension_of(file.path);
  const bool text = file.path == "-" || extension == ".csv" || extension == ".txt" || extension == ".tsv";
  PlaceTable table =
      read_places(file.path, text ? PlaceKind::points : PlaceKind::lines, {file.layer, true, file.skip_bad});
  if (!text) return table;
  const std::size_t all = table.rows.size();
  std::string first;  // why
  std::erase_if(table.rows, [&](const PlaceRow& row) {
    if (first.empty()) first = row.bad;
    return !row.bad.empty();
  });
  if (!first.empty())
    table.notes.push_back(fmt::format("{} of {} vertices skipped; the first: {}", all - table.rows.size(), all, first));
  if (table.rows.size() < 2) throw Error(fmt::format("{}: a path needs at least two vertices", file.path));
  PlaceRow path{table.rows.front().from, table.rows.back().from, table.rows.front().line};
  for (std::size_t i = 1; i + 1 < table.rows.size(); ++i) path.between.push_back(table.rows[i].from);
  table.rows = {std::move(path)};
  return table;
}

Polyline polyline_of(MapInput& input, const PlaceTable& table, std::size_t row) {
  const PlaceRow& path = table.rows[row];
  const std::string what = table.where(row);
  Polyline line;
  const auto add = [&](const TablePlace& place) {
    line.push_back({input.grid_of(place, table.lonlat, what), place.z});
  };
  add(path.from);
  for (const TablePlace& vertex : path.between) add(vertex);
  add(path.to);
  return line;
}

double segment_length(const dvec2& from, const dvec2& to, const dvec2& cell) {
  return std::hypot((to.x - from.x) * cell.x, (to.y - from.y) * cell.y);
}

std::vector<Station> stations_of(const Polyline& line, std::span<const double> lengths, double spacing,
                                 std::string_view option, double most) {
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  if (total / spacing > most)
    throw Error(fmt::format("{} {:.10g}: more than {:.0f} stations over {:.6g} m", option, spacing, most, total));
  std::vector<Station> stations;
  double before = 0;  // metres up to the segment
  std::int64_t next = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Vertex &from = line[i], &to = line[i + 1];
    for (; static_cast<double>(next) * spacing < before + lengths[i]; ++next) {
      const double distance = static_cast<double>(next) * spacing, along = (distance - before) / lengths[i];
      const auto z = from.z && to.z ? std::optional(*from.z + along * (*to.z - *from.z)) : std::nullopt;
      stations.push_back({distance, {from.at + along * (to.at - from.at), z}});
    }
    before += lengths[i];
  }
  stations.push_back({before, line.back()});
  return stations;
}

}  // namespace scarp::cli
