// SPDX-License-Identifier: MIT
// The look `steps`: what rays cost, as a ramp from the least to the most in the picture, or over a scale that several
// pictures share (PictureSettings::step_scale).
#pragma once

#include <cstdint>
#include <span>

#include "scarp/render/frame/picture.h"

namespace scarp {

/// `steps`: width * height of them, rows from the top.
Picture picture_of_steps(const PictureSettings& settings, std::span<const std::uint32_t> steps);

}  // namespace scarp
