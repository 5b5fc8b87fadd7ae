// SPDX-License-Identifier: MIT
// Panels at the upper right: the horizon under the cursor, and the sun of a date and time.
#pragma once

#include <optional>
#include <string>

#include "app/viewer/ground_answers.h"
#include "app/viewer/sun_clock.h"

namespace scarp::viewer {

/// Draws the horizon of a place as a polar plot, north up, between ImGui::NewFrame() and ImGui::Render(). `plot` may be
/// null: not yet computed. Returns the height of the panel in pixels.
float draw_horizon(const HorizonPlot* plot);

struct SunActions {
  std::optional<std::string> date{};  ///< as typed
  std::optional<double> minutes{};    ///< after midnight
  bool play = false;                  ///< starts to play, or stops
};
/// Draws the date and time of the sun, `below` pixels from the upper edge.
SunActions draw_sun(const SunTime& time, const std::string& date, const SunPosition& sun, float below);

}  // namespace scarp::viewer
