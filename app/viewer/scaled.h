// SPDX-License-Identifier: MIT
// Lengths of the panel and of drawings over the picture, on screens of any scale.
#pragma once

#include <imgui.h>

#include "app/viewer/layout.h"

namespace scarp::viewer {

/// Pixels of the screen for pixels at a scale of 1.
inline float scaled(float pixels) { return pixels * ImGui::GetFontSize() / 13; }

}  // namespace scarp::viewer
