// SPDX-License-Identifier: MIT
#include "scarp/source/table/pose_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/source/table/column_names.h"
#include "scarp/source/table/csv_rows.h"
#include "scarp/source/table/table_file.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 10> kPoseColumns = {"time",  "x",    "y",   "z",   "heading",
                                                           "pitch", "roll", "lon", "lat", "above"};
enum PoseColumn : std::size_t { kTime, kPoseX, kPoseY, kPoseZ, kHeading, kPitch, kRoll, kLon, kLat, kAbove };
constexpr std::size_t kNoColumn = std::string_view::npos;

// The position of each column in the header.
using PoseHeader = std::array<std::size_t, kPoseColumns.size()>;

PoseHeader pose_header(const std::vector<std::string_view>& fields, PoseTable& table) {
  PoseHeader at;
  at.fill(kNoColumn);
  const std::vector<std::string> names = column_names(fields);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto name = std::find(kPoseColumns.begin(), kPoseColumns.end(), names[i]);
    if (name == kPoseColumns.end()) continue;
    std::size_t& column = at[static_cast<std::size_t>(name - kPoseColumns.begin())];
    if (column != kNoColumn) throw Error(fmt::format("two columns '{}'", *name));
    column = i;
  }
  const auto has = [&](PoseColumn column) { return at[column] != kNoColumn; };
  table.lonlat = has(kLon) && has(kLat), table.above_ground = has(kAbove);
  const bool plain = has(kPoseX) && has(kPoseY);
  if (plain && table.lonlat) throw Error("columns x,y and lon,lat both (give one of the two)");
  if (has(kPoseZ) && has(kAbove)) throw Error("columns z and above both (give one of the two)");
  if (!has(kTime) || !has(kHeading) || !(plain || table.lonlat) || !(has(kPoseZ) || has(kAbove)))
    throw Error("columns are missing (required: time, x,y or lon,lat, z or above, heading; optional: pitch, roll)");
  return at;
}

}  // namespace

PoseTable parse_pose_csv(std::string_view bytes) {
  PoseTable table;
  CsvRows rows(bytes);
  if (!rows.next()) throw Error("is empty; expected a header and one row per pose");
  const std::size_t width = rows.fields().size();
  const PoseHeader at = pose_header(rows.fields(), table);
  while (rows.next()) {
    const std::int64_t line = rows.line();
    if (rows.fields().size() != width)
      throw Error(fmt::format("line {}: {} fields; the header has {}", line, rows.fields().size(), width));
    const auto number = [&](PoseColumn column) {
      return at[column] == kNoColumn ? 0.0 : finite_field(rows.fields()[at[column]], kPoseColumns[column], line);
    };
    PoseRow row;
    row.time = number(kTime);
    row.at = {number(table.lonlat ? kLon : kPoseX), number(table.lonlat ? kLat : kPoseY),
              number(table.above_ground ? kAbove : kPoseZ)};
    row.heading = number(kHeading), row.pitch = number(kPitch), row.roll = number(kRoll);
    row.line = line;
    if (!table.rows.empty() && !(row.time > table.rows.back().time)) {
      throw Error(fmt::format("line {}: time {} is not later than {} in the row before it (sort the rows by time)",
                              line, row.time, table.rows.back().time));
    }
    table.rows.push_back(row);
  }
  if (table.rows.empty()) throw Error("has no rows; expected one per pose");
  return table;
}

PoseTable read_poses(const std::string& path) {
  try {
    PoseTable table = parse_pose_csv(table_bytes(path));
    table.path = path;
    return table;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
