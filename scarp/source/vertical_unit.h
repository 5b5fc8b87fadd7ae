// SPDX-License-Identifier: MIT
// Units of height by the many names that files give them.
#pragma once

#include <optional>
#include <string_view>

namespace scarp {

/// Metres per unit: "m", "Metres", "ft", "US survey foot", "us-ft", "km", ...; nothing for a name that is no length
/// known here.
std::optional<double> metres_per_vertical_unit(std::string_view name);

/// "ft" or "us-ft" when a unit of so many metres is a foot, the international one, that of the US or another country's;
/// else empty.
std::string_view foot_of(double metres);

}  // namespace scarp
