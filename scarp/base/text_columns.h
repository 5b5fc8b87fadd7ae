// SPDX-License-Identifier: MIT
// Columns of a table that pass through unread: names, remarks, keys of other tables.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace scarp {

/// Plain data: what a reader of tables does not know, a writer of tables may want to repeat.
struct TextColumns {
  std::vector<std::string> names;  ///< one per column
  std::vector<std::string> cells;  ///< row by row, names.size() each, without the quotes that a file may need

  const std::string& at(std::size_t row, std::size_t column) const { return cells[row * names.size() + column]; }
};

}  // namespace scarp
