// SPDX-License-Identifier: MIT
// Columns of tables of observers and lines that hold heights, limits and names, by the names that other programs use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "scarp/source/table/place_table.h"

namespace scarp::cli {

enum class ObserverColumn : std::uint8_t {
  height,         ///< of the observer above ground, metres
  spot,           ///< of the ground at the observer above sea, metres
  target_height,  ///< above ground, metres
  min_distance,   ///< metres
  max_distance,   ///< metres
  first_azimuth,  ///< degrees clockwise from true north
  last_azimuth,
  low_pitch,  ///< degrees above horizontal
  high_pitch,
  name,
  count
};

/// The columns of one table.
class ObserverColumns {
 public:
  /// Names are in any case; the first of a column's names counts. `suffix` follows each name. The table must outlive
  /// it.
  explicit ObserverColumns(const PlaceTable& table, std::string_view suffix = {});

  bool has(ObserverColumn column) const { return at(column).has_value(); }
  /// Returns nullopt without the column, and for an empty cell. Throws Error naming the row if the cell is not a finite
  /// number, or negative for a height above ground. Negative radii of ArcGIS are horizontal distances, as all distances
  /// here.
  std::optional<double> number(std::size_t row, ObserverColumn column) const;
  /// Returns the name in a row; empty without one.
  std::string name(std::size_t row) const;
  /// Lists the columns that are used, with their meanings, and those that are not; empty for a table without columns.
  std::string note() const;

 private:
  std::optional<std::size_t> at(ObserverColumn column) const { return at_[static_cast<std::size_t>(column)]; }

  const PlaceTable& table_;
  std::array<std::optional<std::size_t>, static_cast<std::size_t>(ObserverColumn::count)> at_{};
};

}  // namespace scarp::cli
