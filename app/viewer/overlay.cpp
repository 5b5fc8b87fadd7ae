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

namespace {

constexpr ImU32 kDark = IM_COL32(0, 0, 0, 160), kYellow = IM_COL32(255, 230, 60, 255);
// Lines are this share of their length above the ground, which would hide them everywhere else: less than a pixel in a
// picture of 1,000 pixels that shows the whole line.
constexpr double kLift = 1e-3;

ImVec2 on_screen(const dvec2& pixel, const Camera& camera, const WindowLayout& layout) {
  const double scale = layout.width / camera.size().x;
  return {static_cast<float>(layout.left + pixel.x * scale), static_cast<float>(pixel.y * scale)};
}

ImU32 dim(ImU32 colour) {
  constexpr ImU32 kAlpha = 90;
  return (colour & ~IM_COL32_A_MASK) | (kAlpha << IM_COL32_A_SHIFT);
}

}  // namespace

void draw_on_ground(const std::vector<GroundPoint>& line, double lift, const Scene& scene, const Camera& camera,
                    const WindowLayout& layout) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  std::optional<dvec2> before;
  bool seen_before = false;
  for (const GroundPoint& point : line) {
    const dvec3 at = point.at + dvec3(0, 0, lift);
    const std::optional<dvec2> pixel = std::isfinite(at.z) ? camera.pixel(at) : std::nullopt;
    if (!pixel) {
      before.reset();
      continue;
    }
    Ray sight = camera.ray(pixel->x, pixel->y);
    sight.t_max = dot(at - sight.origin, sight.direction) / dot(sight.direction, sight.direction);
    const bool seen = sight.t_max > 0 && !scene.occluded(sight);
    if (before) {
      const ImVec2 from = on_screen(*before, camera, layout), to = on_screen(*pixel, camera, layout);
      if (seen && seen_before) list.AddLine(from, to, kDark, scaled(4));
      list.AddLine(from, to, seen && seen_before ? point.colour : dim(point.colour), scaled(2));
    }
    before = pixel, seen_before = seen;
  }
}

void draw_mark(const dvec3& at, ImU32 colour, const Camera& camera, const WindowLayout& layout) {
  const std::optional<dvec2> pixel = std::isfinite(at.z) ? camera.pixel(at) : std::nullopt;
  if (!pixel) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddCircleFilled(on_screen(*pixel, camera, layout), scaled(5), kDark);
  list.AddCircleFilled(on_screen(*pixel, camera, layout), scaled(3.5f), colour);
}

void draw_measured(const MeasuredLine& line, const Scene& scene, const Camera& camera, double exaggeration,
                   const WindowLayout& layout) {
  std::vector<GroundPoint> points;
  const auto count = line.heights.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back({{line.from.x + share * (line.to.x - line.from.x), line.from.y + share * (line.to.y - line.from.y),
                       static_cast<double>(line.heights[i]) * exaggeration},
                      kYellow});
  }
  draw_on_ground(points, kLift * line.flat, scene, camera, layout);
  for (const dvec3& end : {line.from, line.to}) draw_mark(end, kYellow, camera, layout);
}

void draw_sight(const SightAnswer& sight, const Scene& scene, const Camera& camera, const WindowLayout& layout) {
  constexpr ImU32 kVisible = IM_COL32(80, 255, 120, 255), kBlocked = IM_COL32(255, 70, 60, 255);
  constexpr std::size_t kPieces = 400;  // more crossings than this share pieces, which are blocked if one of them is
  const std::size_t count = sight.ground.size(), step = 1 + count / kPieces;
  std::vector<GroundPoint> points;
  for (std::size_t i = 0; i < count; i += step) {
    const auto begin = sight.ground.begin() + static_cast<std::ptrdiff_t>(i > step ? i - step + 1 : 0),
               end = sight.ground.begin() + static_cast<std::ptrdiff_t>(i + 1);
    const bool visible = std::all_of(begin, end, [](const SightAnswer::Point& one) { return one.visible; });
    points.push_back({sight.ground[i].at, visible ? kVisible : kBlocked});
  }
  if (count > 0) points.push_back({sight.ground.back().at, sight.ground.back().visible ? kVisible : kBlocked});
  draw_on_ground(points, kLift * sight.line.distance, scene, camera, layout);
  if (count > 0) draw_mark(sight.ground.back().at, sight.line.visible ? kVisible : kBlocked, camera, layout);
}

}  // namespace scarp::viewer
