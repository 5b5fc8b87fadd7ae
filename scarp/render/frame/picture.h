// SPDX-License-Identifier: MIT
// A picture of a terrain scene, in one of several looks.
//
//   shaded  colours by height, sun with exact hard shadows (or, with `samples`, soft ones and ambient occlusion),
//           sky, a block below the terrain
//   height  grey, linear in height from the field's lowest (1) to its highest point (255); misses are black (0);
//           of scenes from the lowest to the highest point in the picture, see height_look.h
//   steps   what the march cost: steps per ray as a ramp from the least to the most in the picture
//   comanche  few large pixels, see comanche.h
//   error   where the march is wrong, see error_look.h
//
// The block hides what lies behind its walls and below its base; only `shaded` shows it, and in `error` there is none.
// Only `shaded` takes several samples per pixel; the others show one ray's answer, through the middle of the pixel.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "scarp/base/progress.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/film.h"
#include "scarp/render/light/fog.h"
#include "scarp/render/light/light.h"
#include "scarp/render/look/comanche.h"
#include "scarp/render/look/error_look.h"
#include "scarp/render/surface/ground_paint.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/render/surface/water.h"
#include "scarp/scene/terrain_scene.h"

namespace scarp {

class SunShadow;

enum class Look { shaded, height, steps, error, comanche };

/// "shaded", "height", "steps", "error", "comanche".
std::string_view name_of(Look look);
/// Throws Error listing the names when there is no such look.
Look find_look(std::string_view name);

/// As far as there is ground.
constexpr double kWholeField = std::numeric_limits<double>::infinity();

/// How a picture is made. Where it is seen from is the camera's matter.
struct PictureSettings {
  int width = 1280;  ///< pixels, 1..65536; width * height at most 2^28
  int height = 720;  ///< pixels, 1..65536
  Look look = Look::shaded;
  int aa = 2;          ///< aa x aa samples per pixel in `shaded`; 1..16
  std::string ramp{};  ///< a name of ramp_names(); empty: hypsometric, and viridis for `steps`
  std::shared_ptr<const RampStops> ramp_stops{};  ///< instead of `ramp`; null: none
  SunSettings sun{};
  bool shadows = true;                            ///< of the sun; false: it shines through the ground
  std::shared_ptr<const SunShadow> sun_shadow{};  ///< what stands in the sun beside the ground; null: nothing
  int samples = 0;  ///< rays to the sun's disc, and to the sky, per sample of `shaded`; 0..4096; 0: exact hard
                    ///< shadows of the disc's middle and no ambient occlusion
  double ao_distance = kWholeField;      ///< metres within which ground hides the sky, >= 0; 0: no ambient occlusion
  std::uint32_t seed = 0;                ///< of the samples' pattern
  bool plinth = true;                    ///< a block below the terrain: walls down to a common base
  double haze = 0.1;                     ///< share of haze over a distance as long as the field's diagonal; 0..0.95
  std::optional<WaterSettings> water{};  ///< of `shaded` and `comanche`
  GroundPaintSettings ground{};          ///< likewise
  FogSettings fog{};                     ///< instead of haze, likewise
  ComancheSettings comanche{};
  double error_tolerance = 0.1;  ///< of `error`, along the ray, in shorter sides of a cell; >= 0
};

/// The name of the ramp in the settings, or what suits the look.
std::string_view ramp_of(const PictureSettings& settings);
/// The ramp of the settings over a range of heights (exaggerated) or other numbers.
Ramp ramp_over(const PictureSettings& settings, double low, double high, double scale = 1);

/// Throws Error naming the first setting out of its range.
void validate(const PictureSettings& settings);

/// What a camera should have in the picture: the field, with the block below it when `plinth` is on, whatever the look,
/// so that pictures of several looks lie on one another.
Box picture_box(const HeightField& field, bool plinth);

/// What was found besides the picture.
struct StepRange {
  std::uint32_t least = 0;
  std::uint32_t most = 0;
  double mean = 0;
};

/// Metres, world z.
struct SeenHeights {
  double low = 0, high = 0;
};

struct Picture {
  Image image;
  std::optional<StepRange> steps;        ///< of `steps`
  std::optional<ErrorCounts> errors;     ///< of `error`
  std::optional<SeenHeights> heights{};  ///< of `height` of scenes: what grey 1 and 255 mean; none: nothing was hit
};

/// `camera` must have been made for the settings' width and height. Throws Error when a setting is out of its range or
/// the scene has nothing to see (no cells, no valid samples), Interrupted when progress asks for it.
Picture render_picture(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                       const PictureSettings& settings, const Progress& progress = {});

}  // namespace scarp
