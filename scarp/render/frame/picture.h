// SPDX-License-Identifier: MIT
// A picture of a scene, in one of several looks. Looks are functions of what the rays of the camera hit.
//
//   shaded    materials in the light of sun and sky, exact hard shadows (or, with `samples`, soft ones and ambient
//             occlusion); water, haze or fog, sky
//   height    grey, linear in height, see height_look.h
//   steps     what the march cost: steps per ray as a ramp from the least to the most in the picture
//   comanche  like `shaded`, in few large pixels, see comanche.h
//   error     where the march is wrong, see error_look.h
//
// `shaded` takes several samples per pixel; `height`, `steps` and `error` show one ray's answer, through the middle of
// the pixel.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

enum class Look { shaded, height, steps, error, comanche };

/// "shaded", "height", "steps", "error", "comanche".
std::string_view name_of(Look look);
/// Throws Error listing the names when there is no such look.
Look find_look(std::string_view name);

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Metres, world z.
struct ReliefRange {
  double low = 0, high = 0;
};

/// How a picture is made. The camera says where it is seen from.
struct PictureSettings {
  int width = 1280;  ///< pixels, 1..65536; width * height at most 2^28
  int height = 720;  ///< pixels, 1..65536
  Look look = Look::shaded;
  int aa = 2;  ///< aa x aa samples per pixel in `shaded`; 1..16

  // Surfaces.
  std::vector<Material> materials{};  ///< SceneObject::material is an index into it
  GroundPaintSettings ground{};       ///< of height fields without a material, and on top of all surfaces
  std::string ramp{};                 ///< a name of ramp_names(); empty: hypsometric, and viridis for `steps`
  std::shared_ptr<const RampStops> ramp_stops{};  ///< instead of `ramp`; null: none
  std::optional<WorldBox>
      ground_box{};  ///< heights of `ramp` and `ground`, place of the overlay; nothing: the scene's own

  // Environment.
  double grid_north_azimuth = 0;  ///< of the world's y axis, radians clockwise from true north
  SunSettings sun{};
  bool shadows = true;                ///< of the sun; false: it shines through everything
  double haze = 0.1;                  ///< share of haze over a distance as long as the scene's diagonal; 0..0.95
  double haze_distance = kUnlimited;  ///< metres after which 1/e of a colour is left, instead of `haze`; > 0
  FogSettings fog{};                  ///< instead of haze
  std::optional<WaterSettings> water{};

  // Sampling of light.
  int samples = 0;  ///< rays to the sun's disc, and to the sky, per sample of `shaded`; 0..4096; 0: exact hard shadows
                    ///< of the disc's middle and no ambient occlusion
  double ao_distance = kUnlimited;  ///< maximum distance of ambient occlusion in metres, >= 0; 0 disables it
  std::uint32_t seed = 0;           ///< of the samples' pattern

  // Looks.
  ComancheSettings comanche{};
  ErrorSettings error{};
};

/// The name of the ramp in the settings, or what suits the look.
std::string_view ramp_of(const PictureSettings& settings);
/// The ramp of the settings over a range of heights (exaggerated) or other numbers.
Ramp ramp_over(const PictureSettings& settings, double low, double high, double scale = 1);
/// The extent of the scene that ground is painted by, and the ramp of its heights.
PaintExtent paint_extent(const Scene& scene, const PictureSettings& settings);
Ramp ground_ramp(const Scene& scene, const PictureSettings& settings);
/// Returns whether that ramp colours a field without a material: heights, and functions if the settings name a ramp.
bool is_ramped(const SceneField& field, const PictureSettings& settings);

/// Throws Error naming the first setting out of its range.
void validate(const PictureSettings& settings);

/// What a camera should have in the picture: everything that has an end. Throws Error if there is nothing.
WorldBox picture_box(const Scene& scene);

/// What was found besides the picture.
struct StepRange {
  std::uint32_t least = 0;
  std::uint32_t most = 0;
  double mean = 0;
};

struct Picture {
  Image image;
  std::optional<StepRange> steps{};      ///< of `steps`
  std::optional<ErrorCounts> errors{};   ///< of `error`
  std::optional<ReliefRange> heights{};  ///< of `height`: what grey 1 and 255 mean; nothing if nothing was hit
};

/// `camera` must have been made for the settings' width and height; over ground that wraps round it needs a reach.
/// Throws Error when a setting is out of its range or the scene has nothing to see (no cells, no valid samples),
/// Interrupted when progress asks for it.
Picture render_picture(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                       const Progress& progress = {});

/// Throws Error when the scene has nothing to see: no cells, no valid samples, no objects.
void require_visible(const Scene& scene);

}  // namespace scarp
