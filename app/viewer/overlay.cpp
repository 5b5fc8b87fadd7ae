// SPDX-License-Identifier: MIT
#include "app/viewer/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/viewer/scaled.h"

namespace scarp::viewer {
void draw_toast(const Toast& toast, const WindowLayout& layout) {
  constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255), kBlack = IM_COL32(0, 0, 0, 200),
                  kRed = IM_COL32(160, 20, 20, 230);
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const auto left = static_cast<float>(layout.left), width = static_cast<float>(layout.width);
  const float margin = scaled(kMargin), wrap = std::max(width - 4 * margin, 1.0f);
  const char *begin = toast.text.c_str(), *end = begin + toast.text.size();
  const ImVec2 text = ImGui::CalcTextSize(begin, end, false, wrap);
  const ImVec2 at{left + (width - text.x) / 2, static_cast<float>(layout.height) - text.y - 3 * margin};
  list.AddRectFilled({at.x - margin, at.y - margin / 2}, {at.x + text.x + margin, at.y + text.y + margin / 2},
                     toast.is_error ? kRed : kBlack, margin / 2);
  list.AddText(nullptr, 0, at, kWhite, begin, end, wrap);
}

void draw_split(double x, const std::vector<std::string>& names) {
  constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 220), kBlack = IM_COL32(0, 0, 0, 160);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float height = ImGui::GetIO().DisplaySize.y, at = static_cast<float>(x), margin = scaled(kMargin);
  list.AddLine({at, 0}, {at, height}, kBlack, 3);
  list.AddLine({at, 0}, {at, height}, kWhite, 1);
  // The left name ends at the divider, and the right name starts there.
  for (std::size_t i = 0; i < names.size() && i < 2; ++i) {
    const ImVec2 size = ImGui::CalcTextSize(names[i].c_str());
    const ImVec2 place{i == 0 ? at - margin - size.x : at + margin, height - margin - size.y};
    list.AddRectFilled({place.x - 3, place.y - 2}, {place.x + size.x + 3, place.y + size.y + 2}, kBlack);
    list.AddText(place, kWhite, names[i].c_str());
  }
}

void draw_measured(const MeasuredLine& line, const Scene& scene, const Camera& camera, double exaggeration,
                   const WindowLayout& layout) {
  constexpr ImU32 kSeen = IM_COL32(255, 230, 60, 255), kHidden = IM_COL32(255, 230, 60, 90),
                  kDark = IM_COL32(0, 0, 0, 160);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const double scale = layout.width / camera.size().x;
  const auto on_screen = [&](const dvec2& pixel) {
    return ImVec2(static_cast<float>(layout.left + pixel.x * scale), static_cast<float>(pixel.y * scale));
  };
  // Slightly above the ground, which would hide it everywhere else.
  const double lift = 1e-3 * line.flat;
  std::optional<dvec2> before;
  bool seen_before = false;
  const auto count = line.heights.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double height = static_cast<double>(line.heights[i]) * exaggeration + lift;
    const dvec3 at(line.from.x + share * (line.to.x - line.from.x), line.from.y + share * (line.to.y - line.from.y),
                   height);
    const std::optional<dvec2> pixel = std::isfinite(height) ? camera.pixel(at) : std::nullopt;
    if (!pixel) {
      before.reset();
      continue;
    }
    Ray sight = camera.ray(pixel->x, pixel->y);
    sight.t_max = dot(at - sight.origin, sight.direction) / dot(sight.direction, sight.direction);
    const bool seen = sight.t_max > 0 && !scene.occluded(sight);
    if (before) {
      const ImVec2 from = on_screen(*before), to = on_screen(*pixel);
      if (seen && seen_before) list.AddLine(from, to, kDark, scaled(4));
      list.AddLine(from, to, seen && seen_before ? kSeen : kHidden, scaled(2));
    }
    before = pixel, seen_before = seen;
  }
  for (const dvec3& end : {line.from, line.to}) {
    const std::optional<dvec2> pixel = camera.pixel(end);
    if (!pixel) continue;
    list.AddCircleFilled(on_screen(*pixel), scaled(5), kDark);
    list.AddCircleFilled(on_screen(*pixel), scaled(3.5f), kSeen);
  }
}

}  // namespace scarp::viewer
