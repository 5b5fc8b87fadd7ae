// SPDX-License-Identifier: MIT
#include "scarp/source/table/column_names.h"

#include <algorithm>
#include <utility>

#include "scarp/base/file_name.h"
#include "scarp/source/table/csv_rows.h"

namespace scarp {
namespace {

constexpr std::pair<std::string_view, std::string_view> kLongNames[] = {
    {"longitude", "lon"}, {"latitude", "lat"}, {"tlongitude", "tlon"}, {"tlatitude", "tlat"}};

}  // namespace

std::vector<std::string> column_names(std::span<const std::string_view> fields) {
  std::vector<std::string> names;
  for (const std::string_view field : fields) names.push_back(lower_case(std::string(trimmed(field))));
  const auto has = [&](std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  if (has("x") && has("y")) return names;
  for (std::string& name : names)
    for (const auto& [from, to] : kLongNames)
      if (name == from) name = to;
  return names;
}

}  // namespace scarp
