// SPDX-License-Identifier: MIT
// Vertical units, by any of the names in use.
#pragma once

#include <optional>
#include <string_view>

namespace scarp {

/// Returns metres per unit: "m", "Metres", "ft", "US survey foot", "us-ft", "km", ...; nullopt for an unknown name.
std::optional<double> metres_per_vertical_unit(std::string_view name);

/// Returns "ft" or "us-ft" if a unit of this length is a foot (international, US or another country's), otherwise an
/// empty text.
std::string_view foot_of(double metres);

}  // namespace scarp
