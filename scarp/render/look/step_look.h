// SPDX-License-Identifier: MIT
// The looks `steps` and `cost`: numbers per ray as a colour ramp from the minimum to the maximum in the picture, or
// over a given scale (PictureSettings::step_scale).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scarp/render/film/film.h"
#include "scarp/render/look/look.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the range of one or more counts of `of`. Without a scale, the colours span the minimum to the maximum.
StepRange range_of_steps(std::span<const std::uint32_t> steps, const std::optional<StepScale>& scale, std::string of);

/// `steps`: width * height of them, rows from the top.
Image image_of_steps(ImageSize size, std::span<const std::uint32_t> steps, const Ramp& ramp);

/// Returns what the steps of the scene's marches are: "samples", "blocks and cells", "voxels, samples".
std::string steps_of(const Scene& scene);
/// Returns what its marches read, for the look `cost`: "heights and blocks", "evaluations".
std::string reads_of(const Scene& scene);

}  // namespace scarp
