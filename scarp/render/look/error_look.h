// SPDX-License-Identifier: MIT
// The look `error` shows where a march is wrong. Every pixel's ray is compared with the judge of the field
// (SceneField::judge()): `exhaustive` for height fields, `voxel-planes` for voxels, `lipschitz-local` for functions,
// `sphere-trace` with the finest tolerance for shapes.
//
// `lipschitz-local` misses no crossing. Pictures of one function verify this: one pixel in 64 is also judged by
// interval bisection (function_exhaustive.h), and contradictions are counted.
//
//   grey       both hit the same point, within the tolerance (hill-shaded)
//   dark grey  both miss
//   red        lost: there is ground, but the march found none
//   magenta    false: there is no ground, but the march found some
//   blue       early: the march stopped before the ground, or at something nearer
//   orange     late: the march hit behind the first ground
//   yellow     gave up: the march reached its step limit
//   brown      not judged: the ray starts or enters below the surface and never hits it from above
//
// Errors in metres, along the ray:
//
//   early, late    from the hit of the march to the true one
//   lost, false    from the start of the ray to the ground that the march lost, or to its false hit
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/film/film.h"
#include "scarp/scene/scene.h"

namespace scarp {

enum class Verdict : std::uint8_t { right_hit, right_miss, lost, false_hit, early, late, gave_up, not_judged };
constexpr int kVerdicts = 8;

/// "right hit", "lost", ...
std::string_view name_of(Verdict verdict);
/// "grey", "red", ...: the colour of its pixels.
std::string_view colour_name_of(Verdict verdict);
vec3 srgb_of(Verdict verdict);

/// Compares a march's result with the true one. Hits agree if their t differ by at most `tolerance`.
Verdict judge(const Hit& answer, const Hit& truth, double tolerance);

/// Whether pixels of the verdict have an error in metres: lost, false, early and late.
constexpr bool has_metres(Verdict verdict) { return verdict >= Verdict::lost && verdict <= Verdict::late; }
/// Returns that error; 0 for all other verdicts.
double error_metres(Verdict verdict, const Ray& ray, const Hit& answer, const Hit& truth);

struct ErrorSettings {
  double tolerance = 0.1;  ///< hits agree within this many sides of a cell or voxel along the ray; >= 0
  double share = 0.01;     ///< functions and shapes: within this fraction of the distance; >= 0
};

/// Throws Error naming the first setting out of range.
void validate(const ErrorSettings& settings);

/// Errors of the pixels of one verdict, in metres; 0 if there are none.
struct ErrorMetres {
  double mean = 0;
  double p99 = 0;   ///< the smallest error that at least 99 % of the pixels do not exceed
  double most = 0;  ///< the largest
};

struct ErrorCounts {
  std::array<std::int64_t, kVerdicts> pixels{};  ///< by Verdict
  std::array<ErrorMetres, kVerdicts> metres{};   ///< likewise; only where has_metres()
  std::string judges{};                          ///< names of the judges' marches
  std::vector<std::string> caveats{};            ///< Scene::caveats() of the judged scene
  double tolerance_m = 0;           ///< along the ray, of the field with the smallest cells; 0: fields have no cells
  double share = 0;                 ///< tolerance of fields without cells, as a fraction of the distance
  std::int64_t proven = 0;          ///< pixels of a function that interval bisection decided
  std::int64_t contradictions = 0;  ///< pixels among those where the judge disagrees: 0 unless there is a bug

  std::int64_t operator[](Verdict verdict) const { return pixels[static_cast<std::size_t>(verdict)]; }
  const ErrorMetres& of(Verdict verdict) const { return metres[static_cast<std::size_t>(verdict)]; }
};

/// The errors of each pixel, rows from the top.
struct ErrorMap {
  std::vector<Verdict> verdicts;
  std::vector<float> metres;  ///< error_metres()

  /// Returns the errors of the pixels with this verdict, in metres; 0 for all others.
  std::vector<float> metres_of(Verdict verdict) const;
};

struct ErrorPicture {
  Image image;
  ErrorCounts counts;
  ErrorMap map;
};

/// Traces one ray through the centre of each pixel. Throws Interrupted if `progress` returns false.
ErrorPicture render_error(const Scene& scene, const Camera& camera, int width, int height,
                          const ErrorSettings& settings, const Progress& progress);

}  // namespace scarp
