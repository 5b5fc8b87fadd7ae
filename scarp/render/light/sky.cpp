// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 2> kSkyNames = {"plain", "scattering"};

}  // namespace

std::string_view name_of(SkyKind kind) { return kSkyNames[static_cast<std::size_t>(kind)]; }

SkyKind find_sky(std::string_view name) {
  for (std::size_t i = 0; i < kSkyNames.size(); ++i) {
    if (kSkyNames[i] == name) return static_cast<SkyKind>(i);
  }
  throw Error(fmt::format("sky '{}': unknown (available: {})", name, fmt::join(kSkyNames, ", ")));
}

void validate(const SkySettings& settings) {
  require_setting("sky", settings.turbidity >= 2 && settings.turbidity <= 10, "the turbidity", settings.turbidity,
                  "2 to 10");
}

}  // namespace scarp
