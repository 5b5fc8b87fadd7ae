// SPDX-License-Identifier: MIT
// The look `steps`: steps per ray as a colour ramp from the minimum to the maximum in the picture, or over a given
// scale (PictureSettings::step_scale).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scarp/render/film/film.h"
#include "scarp/render/look/look.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {

/// Returns the range of one or more step counts. Without a scale, the colours span the minimum to the maximum.
StepRange range_of_steps(std::span<const std::uint32_t> steps, const std::optional<StepScale>& scale);

/// `steps`: width * height of them, rows from the top.
Image image_of_steps(ImageSize size, std::span<const std::uint32_t> steps, const Ramp& ramp);

}  // namespace scarp
