// SPDX-License-Identifier: MIT
#include "app/cli/options/path_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {
namespace {

Vertex between(const Vertex& from, const Vertex& to, double along) {
  const auto z = from.z && to.z ? std::optional(*from.z + along * (*to.z - *from.z)) : std::nullopt;
  return {from.at + along * (to.at - from.at), z};
}

}  // namespace

PlaceTable read_paths(const PlaceFile& file, PlaceKind kind) {
  const std::string extension = extension_of(file.path);
  const bool text = file.path == "-" || extension == ".csv" || extension == ".txt" || extension == ".tsv";
  PlaceTable table = read_places(file.path, text ? PlaceKind::points : kind, {file.layer, true, file.skip_bad});
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

std::vector<double> measure(MapInput& input, Polyline& line) {
  constexpr double kPiece_m = 1000, kMostPieces = 1e5;
  std::vector<double> lengths;
  Polyline pieces{line.front()};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vertex &from = line[i - 1], &to = line[i];
    const bool flat = input.georeference().crs_wkt.empty();
    const double whole = input.distance(from.at, to.at);
    const int count =
        flat || !(whole > kPiece_m) ? 1 : static_cast<int>(std::min(std::ceil(whole / kPiece_m), kMostPieces));
    for (int k = 1; k <= count; ++k) {
      pieces.push_back(k == count ? to : between(from, to, static_cast<double>(k) / count));
      lengths.push_back(input.distance(pieces[pieces.size() - 2].at, pieces.back().at));
    }
  }
  line = std::move(pieces);
  return lengths;
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
      stations.push_back({distance, between(from, to, along)});
    }
    before += lengths[i];
  }
  stations.push_back({before, line.back()});
  return stations;
}

}  // namespace scarp::cli
