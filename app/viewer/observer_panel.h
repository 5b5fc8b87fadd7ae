// SPDX-License-Identifier: MIT
// A panel at the lower right with the answers from the pinned observer, and its settings.
#pragma once

#include <optional>

#include "app/viewer/map_answers.h"

namespace scarp::viewer {

struct ObserverActions {
  std::optional<Observer> change{};
  bool copy = false, remove = false;
};

/// Draws the panel of a pinned observer between ImGui::NewFrame() and ImGui::Render().
ObserverActions draw_observer(const MapAnswers& answers);

}  // namespace scarp::viewer
