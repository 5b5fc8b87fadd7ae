// SPDX-License-Identifier: MIT
// The guarantees of marching techniques.
#pragma once

#include <string_view>

namespace scarp {

/// The guarantee that a march gives about the surface that the field defines.
enum class Guarantee {
  exact,         ///< the first hit, never lost, within the rounding that doc/dev/numerics.md derives
  conservative,  ///< never passes through the surface; may stop before it or give up (exhausted)
  approximate,   ///< may pass through the surface or stop before it
};

constexpr std::string_view name_of(Guarantee guarantee) {
  switch (guarantee) {
    case Guarantee::exact:
      return "exact";
    case Guarantee::conservative:
      return "conservative";
    case Guarantee::approximate:
      break;
  }
  return "approximate";
}

}  // namespace scarp
