// SPDX-License-Identifier: MIT
#include "app/cli/options/place_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace scarp::cli {

void add_place_file(Command& command, PlaceFile& options, Option file) {
  const std::string name = std::string(file.names);
  const Rule needs_file = needs(name + " FILE", [&options] { return !options.path.empty(); });
  command.add(&options.path, std::move(file));
  command.add(&options.layer, {.names = "--layer",
                               .value = "NAME",
                               .help = "layer of a vector file",
                               .fallback = "the first with geometries of the kind",
                               .rules = {needs_file}});
  command.add(&options.skip_bad, {.names = "--skip-bad",
                                  .help = "skip rows that cannot be used, and add a column 'status' to tables",
                                  .common = true,
                                  .rules = {needs_file}});
}

void add_points_option(Command& command, PlaceFile& options) {
  add_place_file(command, options,
                 {.names = "--points",
                  .value = "FILE",
                  .help = "points: CSV (x,y[,z]) or a vector file of points",
                  .files = "csv geojson gpkg shp",
                  .note = "-: CSV from standard input",
                  .common = true,
                  .excludes = {"--at"}});
}

void ignore_vector_z(PlaceTable& table) {
  if (!table.vector) return;
  bool any = false;
  for (PlaceRow& row : table.rows) any |= std::exchange(row.from.z, std::nullopt).has_value();
  if (any) table.notes.push_back(fmt::format("{}: Z, a height above the sea, is not used", table.path));
}

RowStatus::RowStatus(const PlaceTable& table, bool skip)
    : skip_(skip), status_(table.rows.size(), kOk), why_(table.rows.size()) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].bad.empty()) continue;
    status_[i] = kInvalid;
    why_[i] = table.rows[i].bad;
  }
}

const std::string& RowStatus::first_reason() const {
  return *std::find_if(why_.begin(), why_.end(), [](const std::string& why) { return !why.empty(); });
}

void RowStatus::require_good() const {
  if (std::find(status_.begin(), status_.end(), kOk) == status_.end())
    throw Error(fmt::format("no row can be used; the first: {}", first_reason()));
}

std::string RowStatus::note() const {
  require_good();
  const auto good = std::count(status_.begin(), status_.end(), kOk);
  const auto bad = static_cast<std::ptrdiff_t>(status_.size()) - good;
  return bad == 0 ? "" : fmt::format("{} of {} rows skipped; the first: {}", bad, status_.size(), first_reason());
}

}  // namespace scarp::cli
