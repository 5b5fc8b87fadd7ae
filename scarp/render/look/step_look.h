// SPDX-License-Identifier: MIT
// The look `steps`: steps per ray as a colour ramp from the minimum to the maximum in the picture, or over a given
// scale (PictureSettings::step_scale).
#pragma once

#include <cstdint>
#include <span>

#include "scarp/render/frame/picture.h"

namespace scarp {

/// `steps`: width * height of them, rows from the top.
Picture picture_of_steps(const PictureSettings& settings, std::span<const std::uint32_t> steps);

}  // namespace scarp
