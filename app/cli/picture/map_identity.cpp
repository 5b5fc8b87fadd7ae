// SPDX-License-Identifier: MIT
#include "app/cli/picture/map_identity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/cli/picture/check_sum.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {
namespace {

// Words that change no pixel: the machine and how much of it is used, names and formats of outputs, other outputs; the
// part, which is compared on its own; and paths of rasters, which are compared as files.
constexpr std::string_view kWithoutEffect[] = {
    "IN",     "--ground",  "--threads",    "--memory", "--scratch", "--resume", "--quiet", "--preview",
    "--draw", "--summary", "--draw-label", "--output", "--of",      "--co",     "--part",  "--dry-run"};

void append_place(std::string& text, const TablePlace& place) {
  text += fmt::format("{},{},{};", place.x, place.y, place.z ? fmt::format("{}", *place.z) : "");
}

}  // namespace

std::string file_identity(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  if (failed) return fmt::format("{}\n", path);  // in an archive, or on the network
  const auto time = std::filesystem::last_write_time(path, failed).time_since_epoch().count();
  // Without its folder, which other machines and working directories spell otherwise.
  return fmt::format("{} {} {}\n", std::filesystem::path(path).filename().string(), size, time);
}

std::string table_identity(const PlaceTable& table) {
  std::string text;
  for (const PlaceRow& row : table.rows) {
    text += fmt::format("{}{}{}", row.line, row.bad, row.is_line ? "line" : "");
    append_place(text, row.from);
    append_place(text, row.to);
    for (const TablePlace& place : row.between) append_place(text, place);
    for (const auto& ring : row.rings)
      for (const TablePlace& place : ring) append_place(text, place);
  }
  for (const auto& words : {table.carried.names, table.carried.cells})
    for (const std::string& word : words) text += fmt::format("{}:{}", word.size(), word);
  return fmt::format("{} rows{}{} {:016x}\n", table.rows.size(), table.lonlat ? " lonlat" : "",
                     table.vector ? " vector" : "", check_sum_of(text));
}

std::string map_identity(const Command& command, const MapInput& input, const std::vector<std::string>& more) {
  const std::vector<std::string_view> left_out(std::begin(kWithoutEffect), std::end(kWithoutEffect));
  const Raster& raster = input.header();
  const Georeference& geo = raster.georeference;
  std::string text =
      fmt::format("scarp {} {}{}\n{} x {} {} scale {} offset {} nodata {} at {} {}\n", SCARP_VERSION, command.name(),
                  command.typed_words(left_out), raster.cols, raster.rows, raster.file_type, raster.scale,
                  raster.offset, raster.nodata ? fmt::format("{}", *raster.nodata) : "none",
                  geo.present ? fmt::format("{}", fmt::join(geo.map_from_node, " ")) : "nowhere", geo.crs_wkt);
  // The raster's properties above include those of .aux.xml, which other programs write to store statistics.
  for (const std::string& file : input.files())
    if (!lower_case(file).ends_with(".aux.xml")) text += file_identity(file);
  for (const std::string& one : more) text += one;
  return text;
}

}  // namespace scarp::cli
