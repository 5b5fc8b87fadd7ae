// SPDX-License-Identifier: MIT
// Which sky a picture has.
//
//   plain       a pale gradient without a sun, which a terrain model stands out against; the light on the ground is
//               white
//   scattering  clear air in which sunlight is scattered (A. J. Preetham, P. Shirley, B. Smits, "A practical analytic
//               model for daylight", SIGGRAPH 1999), with the sun's disc. Sky, sun and ground have the colours and
//               proportions of that model: a low sun is orange
#pragma once

#include <string_view>

namespace scarp {

enum class SkyKind { plain, scattering };

/// "plain", "scattering".
std::string_view name_of(SkyKind kind);
/// Throws Error listing the names when there is no such sky.
SkyKind find_sky(std::string_view name);

struct SkySettings {
  SkyKind kind = SkyKind::plain;
  double turbidity = 3;  ///< of `scattering`: extinction relative to that of pure air, 2 (very clear) to 10 (haze)
};

/// Throws Error naming the first setting out of its range.
void validate(const SkySettings& settings);

}  // namespace scarp
