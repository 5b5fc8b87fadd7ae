// SPDX-License-Identifier: MIT
// Private to the station: the names of columns, in any case.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

/// Returns the names of a header in lower case and without blanks. `longitude`, `latitude`, `tlongitude` and
/// `tlatitude` become `lon`, `lat`, `tlon` and `tlat`, unless the header also has x and y: then they are other columns.
std::vector<std::string> column_names(std::span<const std::string_view> fields);

}  // namespace scarp
