// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky.h"

#include <array>

#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 2> kSkyNames = {"plain", "scattering"};

}  // namespace

std::string_view name_of(SkyKind kind) { return kSkyNames[static_cast<std::size_t>(kind)]; }

SkyKind find_sky(std::string_view name) { return static_cast<SkyKind>(find_setting("sky", kSkyNames, name)); }

void validate(const SkySettings& settings) {
  require_setting("sky", settings.turbidity >= 2 && settings.turbidity <= 10, "the turbidity", settings.turbidity,
                  "2 to 10");
}

}  // namespace scarp
