// SPDX-License-Identifier: MIT
#include "app/viewer/observer_panel.h"

#include <imgui.h>

#include <string>

#include "app/viewer/layout.h"
#include "app/viewer/scaled.h"

namespace scarp::viewer {

ObserverActions draw_observer(const MapAnswers& answers) {
  constexpr float kWidth = 160, kHighest = 200, kFarthest = 100e3f;  // pixels at a scale of 1; metres
  ObserverActions actions;
  Observer observer = answers.observer();
  const float margin = scaled(kMargin);
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x - margin, window.y - margin}, ImGuiCond_Always, {1, 1});
  ImGui::SetNextWindowBgAlpha(0.8f);
  if (ImGui::Begin("Observer", nullptr,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove)) {
    for (const std::string& line : answers.lines()) ImGui::TextUnformatted(line.c_str());
    bool changed = false;
    const auto slide = [&](const char* label, double& value, float most, const char* format) {
      auto number = static_cast<float>(value);
      ImGui::SetNextItemWidth(scaled(kWidth));
      if (!ImGui::SliderFloat(label, &number, 0, most, format,
                              ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic))
        return;
      value = number;
      changed = true;
    };
    slide("eye above ground", observer.height, kHighest, "%.1f m");
    slide("targets above ground", observer.target_height, kHighest, "%.1f m");
    slide("distance limit", observer.reach, kFarthest, observer.reach > 0 ? "%.0f m" : "none");
    if (changed) actions.change = observer;
    actions.copy = ImGui::Button("Copy command of map (C)");
    ImGui::SameLine();
    actions.remove = ImGui::Button("Remove (Esc)");
  }
  ImGui::End();
  return actions;
}

}  // namespace scarp::viewer
