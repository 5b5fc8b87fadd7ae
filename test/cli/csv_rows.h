// SPDX-License-Identifier: MIT
// Rows of the tables that `scarp` prints.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace scarp::test {

/// Values by column name.
using Row = std::map<std::string, std::string>;

/// Returns the number in a column; 0 for an empty field.
inline double number(const Row& row, const std::string& column) { return std::strtod(row.at(column).c_str(), nullptr); }

/// Returns the fields of a line without quotes.
inline std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> result(1);
  for (const char c : line) {
    if (c == ',') {
      result.emplace_back();
    } else {
      result.back() += c;
    }
  }
  return result;
}

/// Returns the rows of a CSV without quotes.
inline std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> values = fields_of(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
  }
  return rows;
}

}  // namespace scarp::test
