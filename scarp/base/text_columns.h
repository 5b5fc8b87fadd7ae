// SPDX-License-Identifier: MIT
// Text columns that pass from an input table to an output table unchanged.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace scarp {

/// Columns that a table reader does not interpret and a table writer may repeat: names, remarks, keys of other tables.
struct TextColumns {
  std::vector<std::string> names;  ///< one per column
  std::vector<std::string> cells;  ///< row-major, names.size() per row, unquoted

  const std::string& at(std::size_t row, std::size_t column) const { return cells[row * names.size() + column]; }
};

}  // namespace scarp
