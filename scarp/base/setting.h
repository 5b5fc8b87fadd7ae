// SPDX-License-Identifier: MIT
// Validates settings.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace scarp {

/// Throws Error "SUBJECT: WHAT is VALUE (must be RANGE)" if `good` is false.
void require_setting(std::string_view subject, bool good, std::string_view what, double value, std::string_view range);

/// Returns the index of `name` in `names`. Throws Error "SUBJECT 'NAME': unknown (available: NAMES)" if it is not among
/// them.
std::size_t find_setting(std::string_view subject, std::span<const std::string_view> names, std::string_view name);

}  // namespace scarp
