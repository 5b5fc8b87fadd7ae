// SPDX-License-Identifier: MIT
#include "app/viewer/panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <cmath>

#include "app/viewer/view_output.h"

namespace scarp::viewer {
namespace {

constexpr std::array<const char*, 4> kModes = {"orbit", "fly", "walk", "top"};
constexpr std::array<const char*, 3> kStages = {"moving", "full resolution", "complete"};
constexpr std::array<Look, 5> kLooks = {Look::shaded, Look::hillshade, Look::height, Look::steps, Look::error};

bool slider(const char* label, double& value, float least, float most, const char* format) {
  auto number = static_cast<float>(value);
  if (!ImGui::SliderFloat(label, &number, least, most, format)) return false;
  value = number;
  return true;
}

void draw_help(bool& open) {
  if (!open) return;
  if (ImGui::Begin("Mouse and keys", &open, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::TextUnformatted(
        "left drag      turn, look around; top: shift\n"
        "right drag     shift\n"
        "wheel          nearer; fly and walk: speed\n"
        "double click   go there\n"
        "W A S D Q E    fly and walk; with Shift faster\n"
        "O F G T        orbit, fly, walk, top\n"
        "H              the first view\n"
        "Ctrl 1..9      keep the view; 1..9 return to it\n"
        "M              measure between two clicks\n"
        "K              add the view to scarp-path.csv, for scarp render --path\n"
        "C              copy the command that makes the picture again\n"
        "P              save the picture\n"
        "F5             open the input again\n"
        "Tab            hide the panel");
  }
  ImGui::End();
}

bool draw_look(PictureSettings& picture) {
  bool changed = false;
  if (ImGui::BeginCombo("look", std::string(name_of(picture.look)).c_str())) {
    for (const Look look : kLooks) {
      if (ImGui::Selectable(std::string(name_of(look)).c_str(), look == picture.look)) {
        picture.look = look;
        changed = true;
      }
    }
    ImGui::EndCombo();
  }
  changed |= slider("sun azimuth", picture.sun.azimuth_deg, 0, 360, "%.0f");
  changed |= slider("sun altitude", picture.sun.altitude_deg, 1, 90, "%.0f");
  changed |= ImGui::Checkbox("shadows", &picture.shadows);
  changed |= ImGui::SliderInt("soft light rays", &picture.samples, 0, 64);
  changed |= ImGui::SliderInt("anti-aliasing", &picture.aa, 1, 4);
  if (has_haze(picture)) changed |= slider("haze", picture.haze, 0, 0.95f, "%.2f");
  if (picture.water) changed |= ImGui::InputDouble("water level", &picture.water->level, 1, 10, "%.1f");
  return changed;
}

// Returns whether one was let go: the input is opened again, which takes time.
bool draw_parameters(const std::vector<MarchParameter>& parameters) {
  bool changed = false;
  constexpr ImGuiSliderFlags kFlags = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;
  for (const MarchParameter& parameter : parameters) {
    const auto least = static_cast<float>(parameter.least), most = static_cast<float>(parameter.most);
    if (int* const* whole = std::get_if<int*>(&parameter.to)) {
      ImGui::SliderInt(parameter.name.c_str(), *whole, static_cast<int>(least), static_cast<int>(most), "%d", kFlags);
    } else {
      double& value = **std::get_if<double*>(&parameter.to);
      auto number = static_cast<float>(value);
      if (ImGui::SliderFloat(parameter.name.c_str(), &number, least, most, "%.3g", kFlags)) value = number;
    }
    changed |= ImGui::IsItemDeactivatedAfterEdit();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", parameter.help.c_str());
  }
  return changed;
}

void draw_cost(const PanelState& state) {
  if (!state.shown) return;
  const Image& image = state.shown->picture.image;
  const std::string time = state.times ? fmt::format(", {:.0f} ms", 1e3 * state.shown->seconds) : std::string();
  ImGui::Text("%s, %d x %d%s%s", kStages[static_cast<std::size_t>(state.shown->stage)], image.width, image.height,
              time.c_str(), state.busy ? " ..." : "");
  if (state.times && image.width > 0 && state.shown->seconds > 0) {
    constexpr double kMillion = 1e6;
    ImGui::Text("%.1f million pixels per second on %s",
                static_cast<double>(image.width) * image.height / kMillion / state.shown->seconds,
                state.device.c_str());
  }
}

}  // namespace

PanelActions draw_panel(PanelState& state) {
  PanelActions actions;
  ImGui::SetNextWindowPos({10, 10}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.8f);
  if (ImGui::Begin("Scarp", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    for (std::size_t i = 0; i < kModes.size(); ++i) {
      if (i > 0) ImGui::SameLine();
      const auto mode = static_cast<MoveMode>(i);
      if (ImGui::RadioButton(kModes[i], state.mode == mode)) actions.mode = mode;
    }
    ImGui::PushItemWidth(160);
    actions.picture_changed = draw_look(*state.picture);
    if (state.marches.size() > 1 && ImGui::BeginCombo("march", state.march.c_str())) {
      for (const std::string& march : state.marches) {
        if (ImGui::Selectable(march.c_str(), march == state.march) && march != state.march) actions.march = march;
      }
      ImGui::EndCombo();
    }
    actions.parameter_changed = draw_parameters(state.parameters);
    ImGui::PopItemWidth();
    if (state.mode == MoveMode::fly || state.mode == MoveMode::walk) ImGui::Text("%.1f m/s", state.speed);
    ImGui::Separator();
    draw_cost(state);
    ImGui::Separator();
    if (state.reading) {
      for (const std::string& line : state.reading->lines) ImGui::TextUnformatted(line.c_str());
    } else {
      ImGui::TextUnformatted("nothing under the cursor");
    }
    if (state.measures) ImGui::TextUnformatted("click both ends of a line");
    if (state.line) {
      ImGui::Text("%.1f m, rises %.1f m; the ends %s", state.line->flat, state.line->rise,
                  state.line->sees ? "see one another" : "are hidden from one another");
      ImGui::PlotLines("##profile", state.line->heights.data(), static_cast<int>(state.line->heights.size()), 0,
                       nullptr, FLT_MAX, FLT_MAX, {300, 70});
    }
    ImGui::Separator();
    actions.save = ImGui::Button("Save picture (P)");
    ImGui::SameLine();
    actions.copy = ImGui::Button("Copy command (C)");
    ImGui::SameLine();
    if (ImGui::Button("Help (F1)")) state.help = !state.help;
    if (!state.message.empty()) ImGui::TextUnformatted(state.message.c_str());
  }
  ImGui::End();
  draw_help(state.help);
  return actions;
}

}  // namespace scarp::viewer
