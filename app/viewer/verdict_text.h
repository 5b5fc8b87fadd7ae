// SPDX-License-Identifier: MIT
// The verdict on some rays of a picture, as text.
#pragma once

#include <optional>
#include <string>

#include "scarp/render/look/judged_rays.h"

namespace scarp::viewer {

/// "23.4 steps per ray; 3 of 1000 sampled rays wrong: 2 lost, 1 early"; empty if no rays were judged.
std::string verdict_text(const std::optional<JudgedRays>& judged);

}  // namespace scarp::viewer
