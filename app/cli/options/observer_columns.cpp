// SPDX-License-Identifier: MIT
#include "app/cli/options/observer_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {
namespace {

// The content of a column and its names: those of the options and of GDAL first, then those of ArcGIS (Viewshed) and of
// QGIS (Visibility Analysis). doc/user/viewshed.md lists them.
struct Meaning {
  std::string_view text;
  std::array<std::string_view, 5> names;
};
constexpr std::array<Meaning, static_cast<std::size_t>(ObserverColumn::count)> kMeanings{{
    {"observer height", {"height", "observer_height", "oz", "offseta", "observ_hgt"}},
    {"height of the ground", {"spot"}},
    {"target height", {"target_height", "tz", "offsetb", "target_hgt"}},
    {"minimum distance", {"min_distance", "radius1", "radius_in"}},
    {"maximum distance", {"max_distance", "md", "radius2", "radius"}},
    {"first azimuth", {"start_angle", "azimuth1", "azim_1"}},
    {"last azimuth", {"end_angle", "azimuth2", "azim_2"}},
    {"lowest pitch", {"low_pitch", "vert2", "angle_down"}},
    {"highest pitch", {"high_pitch", "vert1", "angle_up"}},
    {"name", {"name", "label", "id"}},
}};

}  // namespace

ObserverColumns::ObserverColumns(const PlaceTable& table, std::string_view suffix) : table_(table) {
  std::vector<std::string> names;
  for (const std::string& name : table.carried.names) names.push_back(lower_case(name));
  for (std::size_t column = 0; column < at_.size(); ++column)
    for (const std::string_view name : kMeanings[column].names) {
      const auto found = std::find(names.begin(), names.end(), std::string(name) + std::string(suffix));
      if (name.empty() || found == names.end()) continue;
      at_[column] = static_cast<std::size_t>(found - names.begin());
      break;
    }
}

std::optional<double> ObserverColumns::number(std::size_t row, ObserverColumn column) const {
  if (!has(column)) return std::nullopt;
  std::string_view text = table_.carried.at(row, *at(column));
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.empty()) return std::nullopt;
  const auto refuse = [&](std::string_view what) {
    return Error(fmt::format("{}: {} '{}' is {}", table_.where(row), table_.carried.names[*at(column)], text, what));
  };
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(value))
    throw refuse("not a finite number");
  if (column == ObserverColumn::min_distance || column == ObserverColumn::max_distance) return std::abs(value);
  const bool above_ground = column == ObserverColumn::height || column == ObserverColumn::target_height;
  if (above_ground && value < 0) throw refuse("negative (expected metres above ground)");
  if (std::abs(value) > kMostOfGround) throw refuse("out of range");
  return value;
}

std::string ObserverColumns::name(std::size_t row) const {
  return has(ObserverColumn::name) ? table_.carried.at(row, *at(ObserverColumn::name)) : "";
}

std::string ObserverColumns::note() const {
  constexpr int kListed = 10;
  const auto add = [](std::string& list, int& count, const std::string& item) {
    if (++count <= kListed) list += (list.empty() ? "" : ", ") + item;
    if (count == kListed + 1) list += ", ...";
  };
  std::string used, unused;
  int used_count = 0, unused_count = 0;
  for (std::size_t i = 0; i < table_.carried.names.size(); ++i) {
    const std::string& name = table_.carried.names[i];
    const auto column = std::find(at_.begin(), at_.end(), i);
    if (column == at_.end()) {
      add(unused, unused_count, name);
    } else {
      add(used, used_count,
          fmt::format("{} ({})", name, kMeanings[static_cast<std::size_t>(column - at_.begin())].text));
    }
  }
  std::string text;
  if (!used.empty()) text += "columns used: " + used;
  if (!unused.empty()) text += fmt::format("{}columns not used: {}", text.empty() ? "" : "; ", unused);
  return text;
}

}  // namespace scarp::cli
