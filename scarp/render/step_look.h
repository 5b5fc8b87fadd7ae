// SPDX-License-Identifier: MIT
// The look `steps`: what rays cost, as a ramp from the least to the most in the picture.
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/render/picture.h"

namespace scarp {

/// `steps_of(x, y)` is asked once for each pixel, on all threads.
Picture picture_of_steps(const PictureSettings& settings, const std::function<std::uint32_t(int, int)>& steps_of,
                         const Progress& progress);

}  // namespace scarp
