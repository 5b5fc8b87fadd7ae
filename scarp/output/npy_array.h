// SPDX-License-Identifier: MIT
// Private to the station: headers of .npy files (format version 1.0, NEP 1) with a one-dimensional structured array.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace scarp {

struct NpyColumn {
  std::string_view name;
  std::string_view type = "<f8";  ///< NumPy's type description
};

/// Returns the header of `rows` structures. Its length does not depend on `rows`, so it can be rewritten at the end.
std::string npy_array_header(std::span<const NpyColumn> columns, std::int64_t rows);

}  // namespace scarp
