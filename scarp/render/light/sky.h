// SPDX-License-Identifier: MIT
// Settings of the sky.
//
//   plain       a pale gradient without a sun, against which terrain stands out; sun and sky together give white light
//   scattering  sunlight scattered in clear air (atmosphere.h), with the sun's disc; the sun may be below the horizon.
//               The model sets the colours and relative brightness of sky, sun and ground: a low sun is orange
#pragma once

#include <string_view>

namespace scarp {

enum class SkyKind { plain, scattering };

/// "plain", "scattering".
std::string_view name_of(SkyKind kind);
/// Returns the kind with this name. Throws Error listing the names if `name` is unknown.
SkyKind find_sky(std::string_view name);

struct SkySettings {
  SkyKind kind = SkyKind::plain;
  double turbidity = 3;  ///< `scattering`: extinction relative to pure air, 2 (very clear) to 10 (hazy)
};

/// Throws Error naming the first setting out of range.
void validate(const SkySettings& settings);

}  // namespace scarp
