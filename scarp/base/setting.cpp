// SPDX-License-Identifier: MIT
#include "scarp/base/setting.h"

#include <fmt/format.h>

#include "scarp/base/error.h"

namespace scarp {

void require_setting(std::string_view subject, bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("{}: {} is {} (must be {})", subject, what, value, range));
}

}  // namespace scarp
