// SPDX-License-Identifier: MIT
#include "app/viewer/answer_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/cli/options/sun_dates.h"
#include "app/viewer/layout.h"
#include "app/viewer/scaled.h"

namespace scarp::viewer {
namespace {

constexpr float kWidth = 220;  // pixels at a scale of 1
constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing;

void place_panel(float below) {
  const float margin = scaled(kMargin);
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - margin, margin + below}, ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.8f);
}

// The altitude in the middle of the plot, in degrees: the least round one above all horizons.
double middle_of(const HorizonPlot& plot) {
  for (const double middle : {5.0, 15.0, 30.0, 60.0}) {
    if (plot.highest() < middle / cli::kDegreesPerRadian) return middle;
  }
  return 90;
}

// Ground from the rim, where the altitude is 0, inwards.
void draw_plot(const HorizonPlot& plot, const ImVec2& middle, float radius, double most_deg) {
  constexpr ImU32 kSky = IM_COL32(120, 170, 220, 255), kGround = IM_COL32(110, 90, 70, 255),
                  kGrid = IM_COL32(255, 255, 255, 90), kText = IM_COL32(255, 255, 255, 255);
  constexpr int kSegments = 96;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(middle, radius, kSky, kSegments);
  const std::size_t count = plot.views.size();
  const auto at = [&](std::size_t i, double altitude_deg) {
    const double azimuth = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double share = 1 - std::clamp(altitude_deg / most_deg, 0.0, 1.0);
    return ImVec2(middle.x + radius * static_cast<float>(share * std::sin(azimuth)),
                  middle.y - radius * static_cast<float>(share * std::cos(azimuth)));
  };
  const auto altitude = [&](std::size_t i) { return plot.views[i % count].angle * cli::kDegreesPerRadian; };
  // Without smooth edges, which would leave seams between the pieces.
  const ImDrawListFlags flags = std::exchange(list.Flags, list.Flags & ~ImDrawListFlags_AntiAliasedFill);
  for (std::size_t i = 0; i < count; ++i)
    list.AddQuadFilled(at(i, 0), at(i + 1, 0), at(i + 1, altitude(i + 1)), at(i, altitude(i)), kGround);
  list.Flags = flags;
  for (const float share : {1 / 3.0f, 2 / 3.0f, 1.0f}) list.AddCircle(middle, radius * share, kGrid, kSegments);
  const float text = ImGui::GetFontSize();
  const std::array<std::pair<const char*, ImVec2>, 4> names{
      {{"N", {0, -1}}, {"E", {1, 0}}, {"S", {0, 1}}, {"W", {-1, 0}}}};
  for (const auto& [name, to] : names) {
    const float reach = radius + 0.7f * text;
    list.AddText({middle.x + reach * to.x - text / 4, middle.y + reach * to.y - text / 2}, kText, name);
  }
}

}  // namespace

float draw_horizon(const HorizonPlot* plot) {
  float height = 0;
  place_panel(0);
  if (ImGui::Begin("Horizon", nullptr, kFixed)) {
    if (plot) {
      const double most = middle_of(*plot);
      const float side = scaled(kWidth), text = ImGui::GetFontSize();
      const ImVec2 from = ImGui::GetCursorScreenPos();
      draw_plot(*plot, {from.x + side / 2, from.y + side / 2}, side / 2 - 1.5f * text, most);
      ImGui::Dummy({side, side});
      ImGui::Text("altitude 0 at the rim, %.0f\u00b0 in the middle", most);
      ImGui::Text("highest %.2f\u00b0 at azimuth %.0f\u00b0", plot->highest() * cli::kDegreesPerRadian,
                  plot->highest_azimuth_deg());
    } else {
      ImGui::TextUnformatted("no ground under the cursor");
    }
  }
  height = ImGui::GetWindowHeight();
  ImGui::End();
  return height;
}

SunActions draw_sun(const SunTime& time, const std::string& date, const SunPosition& sun, float below) {
  SunActions actions;
  place_panel(below > 0 ? below + scaled(kMargin) : 0);
  if (ImGui::Begin("Sun", nullptr, kFixed)) {
    std::array<char, 16> text{};
    const std::string day = SunClock::day_text(time.day);
    std::copy_n(day.begin(), std::min(day.size(), text.size() - 1), text.begin());
    ImGui::SetNextItemWidth(scaled(kWidth));
    if (ImGui::InputText("##date", text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue))
      actions.date = text.data();
    auto minutes = static_cast<float>(time.minutes);
    ImGui::SetNextItemWidth(scaled(kWidth));
    if (ImGui::SliderFloat("##time", &minutes, 0, cli::kMinutesPerDay - 1, "", ImGuiSliderFlags_NoInput))
      actions.minutes = minutes;
    ImGui::TextUnformatted(date.c_str());
    if (sun.altitude > 0) {
      ImGui::Text("azimuth %.2f\u00b0, altitude %.2f\u00b0", sun.azimuth * cli::kDegreesPerRadian,
                  sun.altitude * cli::kDegreesPerRadian);
    } else {
      ImGui::TextUnformatted("the sun is below the horizon");
    }
    actions.play = ImGui::Button(time.plays ? "Stop (Space)" : "Play (Space)");
  }
  ImGui::End();
  return actions;
}

}  // namespace scarp::viewer
