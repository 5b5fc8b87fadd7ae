// SPDX-License-Identifier: MIT
// Renders a picture of a scene in one of several looks (look/look.h).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/film/film.h"
#include "scarp/render/light/fog.h"
#include "scarp/render/light/sky.h"
#include "scarp/render/light/sun.h"
#include "scarp/render/look/comanche.h"
#include "scarp/render/look/error_look.h"
#include "scarp/render/look/look.h"
#include "scarp/render/surface/ground_paint.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/render/surface/water.h"
#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Settings of a picture, apart from the camera.
struct PictureSettings {
  int width = 1280;  ///< pixels, 1..65536; width * height at most 2^28
  int height = 720;  ///< pixels, 1..65536
  Look look = Look::shaded;
  int aa = 2;  ///< `shaded`: aa x aa samples per pixel, 1..16

  // Surfaces.
  std::vector<Material> materials{};  ///< indexed by SceneObject::material
  GroundPaintSettings ground{};       ///< ground colours; overlay, patches and contours apply to all surfaces
  std::string ramp{};                 ///< one of ramp_names(); empty: viridis for `steps` and `cost`, else hypsometric
  std::shared_ptr<const RampStops> ramp_stops{};  ///< replaces `ramp` unless null
  /// Heights of the first and last colour of ramps and of grey, in metres, not exaggerated; low < high; nullopt: the
  /// lowest and highest of the scene. Values outside have the colour of the nearer end.
  std::optional<ReliefRange> ramp_range{};
  /// Range of heights for `ramp` and `ground`, and extent of the overlay; nullopt: the scene's.
  std::optional<WorldBox> ground_box{};

  // Environment.
  double grid_north_azimuth = 0;  ///< compass azimuth of the world's y axis: radians clockwise from true north
  SunSettings sun{};
  SkySettings sky{};
  bool shadows = true;                ///< whether surfaces block the sun
  bool unlit = false;                 ///< surfaces keep their own colours: no light of sun and sky, no shadows
  double haze = 0.1;                  ///< fraction of haze over a distance equal to the scene's diagonal, 0..0.95
  double haze_distance = kUnlimited;  ///< replaces `haze` if finite: metres over which contrast falls to 1/e, > 0
  FogSettings fog{};                  ///< replaces haze unless its kind is `none`
  std::optional<WaterSettings> water{};

  /// Whether Image::alpha is filled with the fraction of each pixel that shows ground, a model or water. Colours are
  /// then means over that part only, and black where it is empty.
  bool alpha = false;

  bool tone_curve = true;  ///< whether `shaded` and `comanche` compress bright colours (toned()); layers never do

  // Sampling of light.
  int samples = 0;  ///< rays to the sun's disc, and as many to the sky, per sample of `shaded`, 0..4096; 0: hard
                    ///< shadows from the centre of the disc, and no ambient occlusion
  double ao_distance = kUnlimited;  ///< maximum distance of ambient occlusion in metres, >= 0; 0 disables it
  std::uint32_t seed = 0;           ///< seed of the sampling pattern

  // Looks.
  bool large_pixels = false;  ///< `shaded`: pixels are scaled up by ComancheSettings::scale, as `comanche` always does
  ComancheSettings comanche{};
  ErrorSettings error{};
  std::optional<StepScale> step_scale{};  ///< `steps`, `cost`: range of the ramp, clamped; nullopt: the minimum and
                                          ///< maximum in the picture
  int level = 0;                          ///< `level`: level of the pyramid, 0 (cells) to the coarsest
};

/// Returns whether the tone curve applies: not to pictures of counts or unlit pictures.
bool uses_tone_curve(const PictureSettings& settings);

/// Returns the side of a pixel of the picture in pixels of its image.
int pixel_side(const PictureSettings& settings);

/// Returns the name of the ramp in the settings or, if that is empty, the default for the look.
std::string_view ramp_of(const PictureSettings& settings);
/// Returns the ramp of the settings over a range of exaggerated heights or other values, low <= high. `scale` is the
/// factor for heights in PictureSettings::ramp_stops, such as the exaggeration. Throws Error if the ramp is unknown.
Ramp ramp_over(const PictureSettings& settings, double low, double high, double scale = 1);
/// Returns the extent of the scene, or of PictureSettings::ground_box, that ground colours refer to.
PaintExtent paint_extent(const Scene& scene, const PictureSettings& settings);
/// Returns the exaggerated heights of PictureSettings::ramp_range, or of that extent.
ReliefRange ramp_heights(const Scene& scene, const PictureSettings& settings);
/// Returns the ramp over ramp_heights().
Ramp ground_ramp(const Scene& scene, const PictureSettings& settings);
/// Returns whether that ramp colours a field without a material: heights, and functions if the settings name a ramp.
bool is_ramped(const SceneField& field, const PictureSettings& settings);

/// Throws Error naming the first setting that is out of range.
void validate(const PictureSettings& settings);

/// Returns the box to frame: around all bounded objects and, if terrain wraps, one period of it. Throws Error if it is
/// empty.
WorldBox picture_box(const Scene& scene);

using Srgb = std::array<std::uint8_t, 3>;

/// The meaning of a picture's colours: a scale of numbers, or classes.
struct PictureLegend {
  std::string title{};
  std::vector<Srgb> colours{};  ///< of the scale, evenly spaced from `low` to `high`; empty: classes
  double low = 0, high = 0;
  double least_step = 0;  ///< of labels; 1: whole numbers
  struct Class {
    Srgb colour;
    std::string name;
  };
  std::vector<Class> classes{};  ///< those in the picture
};

/// A picture, and statistics of some looks.
struct Picture {
  Image image;
  std::optional<PictureLegend> legend{};  ///< nullopt if its colours are those of materials, or have no unit
  std::optional<StepRange> steps{};       ///< set by the look `steps`
  std::optional<StepRange> cost{};        ///< reads, set by the look `cost`
  std::optional<ErrorCounts> errors{};    ///< set by the look `error`
  std::optional<ErrorMap> error_map{};    ///< likewise
  /// Set by the looks `slope` and `aspect` (degrees) and `multidirectional` (1 to 255), see relief_look.h: one per
  /// pixel, rows from the top; NaN: none.
  std::vector<float> numbers{};
  std::optional<ReliefRange> heights{};  ///< set by the look `height`, if anything was hit: heights of grey 1 and 255
};

/// Renders a picture. `camera` must have been created with the width and height of the settings; if terrain wraps, it
/// needs a finite reach. Throws Error if a setting is out of range, nothing in the scene is visible, the eye is not
/// above the water, or the scene lacks the level. Throws Interrupted if `progress` returns false.
Picture render_picture(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                       const Progress& progress = {});

/// Throws Error if nothing in the scene is visible: no cells, no valid samples, or no objects.
void require_visible(const Scene& scene);

}  // namespace scarp
