// SPDX-License-Identifier: MIT
// Checks of settings.
#pragma once

#include <string_view>

namespace scarp {

/// Throws Error "SUBJECT: WHAT is VALUE (must be RANGE)" if `good` is false.
void require_setting(std::string_view subject, bool good, std::string_view what, double value, std::string_view range);

}  // namespace scarp
