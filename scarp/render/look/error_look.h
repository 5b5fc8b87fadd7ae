// SPDX-License-Identifier: MIT
// Where a march is wrong: every pixel's ray is judged by `exhaustive`.
//
//   grey       both hit the same place, within the tolerance (hill-shaded)
//   dark grey  both miss
//   red        lost: there is ground, the march found none
//   magenta    invented: there is none, the march found some
//   blue       early: the march stopped before the ground, or at something nearer
//   orange     late: the march hit behind the first ground
//   yellow     gave up: the march came to its step limit
//   brown      not judged: the ray comes in below the surface (through the border, a hole, or from an eye under ground)
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "scarp/base/progress.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/film.h"
#include "scarp/scene/terrain_scene.h"

namespace scarp {

enum class Verdict { right_hit, right_miss, lost, invented, early, late, gave_up, not_judged };
constexpr int kVerdicts = 8;

/// "right hit", "lost", ...
std::string_view name_of(Verdict verdict);
/// "grey", "red", ...: the colour of its pixels.
std::string_view colour_name_of(Verdict verdict);
vec3 srgb_of(Verdict verdict);

/// Judges a march's answer by the true one. Hits agree when their t differ by at most `tolerance`.
Verdict judge(const Hit& answer, const Hit& truth, double tolerance);

struct ErrorCounts {
  std::array<std::int64_t, kVerdicts> pixels{};  ///< by Verdict
  double tolerance_m = 0;                        ///< along the ray

  std::int64_t operator[](Verdict verdict) const { return pixels[static_cast<std::size_t>(verdict)]; }
};

struct ErrorPicture {
  Image image;
  ErrorCounts counts;
};

/// One ray through the middle of each pixel. `tolerance` along the ray, in shorter sides of a cell.
ErrorPicture render_error(const TerrainScene& scene, const Camera& camera, int width, int height, double tolerance,
                          const Progress& progress);

}  // namespace scarp
