// SPDX-License-Identifier: MIT
// A request for a picture. resolve() derives the settings from the request, the properties of the input and the
// position of the camera; nothing changes them afterwards. The command line, the window and scene files all fill in a
// PictureRequest.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"

namespace scarp {

/// Default PictureRequest::detail of a texture: the contrast of its image.
constexpr double kTextureDetail = 0.5;

/// Default size of `comanche` in large pixels.
constexpr ImageSize kLowResolution{320, 240};

/// A request for a picture, apart from its camera. Members without a value are not requested. Units and ranges are
/// those of PictureSettings.
struct PictureRequest {
  Look look = Look::shaded;
  int level = 0;                            ///< `level`
  std::optional<int> width{}, height{};     ///< pixels; `comanche` has `low_resolution`
  std::optional<ImageSize> low_resolution;  ///< large pixels, also of `shaded` unless it has a width; the look
                                            ///< `height` then uses the rays of `comanche`
  std::optional<int> aa{};
  std::optional<StepScale> step_scale{};
  std::optional<double> error_tolerance{};  ///< cells or voxels; functions and shapes: percent of the distance

  // Light.
  std::optional<double> sun_azimuth_deg{}, sun_altitude_deg{}, sun_size_deg{};
  std::optional<SkyKind> sky{};
  std::optional<double> sky_turbidity{};
  std::optional<bool> shadows{};
  bool unlit = false;
  std::optional<bool> tone_curve{};
  std::optional<double> haze{};
  std::optional<double> haze_distance{};  ///< replaces `haze`, unless that is requested with higher priority
  std::optional<int> samples{};
  std::optional<double> ao_distance{};
  std::optional<std::uint32_t> seed{};

  // Surfaces.
  std::vector<Material> materials{};
  std::string ramp{};
  std::optional<ReliefRange> ramp_range{};
  bool natural = false;
  std::optional<double> snow_line{};  ///< metres, not exaggerated
  std::optional<double> detail{};     ///< kTextureDetail for a texture, else 0
  double detail_size = 0, contours = 0;

  // Water, enabled by `water_level`.
  std::optional<double> water_level{};
  bool no_water = false;  ///< without the water of the input's own request
  std::optional<vec3> water_srgb{};
  std::optional<double> water_turbidity{}, waves{}, wavelength{};
  std::optional<bool> reflection{}, refraction{};

  // Fog. Its numbers belong to its kind: a request with a kind takes none of another request's numbers.
  std::optional<FogKind> fog{};
  std::optional<double> visibility{}, fog_base{}, fog_falloff{};  ///< metres; `fog_base` is not exaggerated
  std::optional<double> sun_tint{};

  ComancheSettings comanche{};        ///< without `heights` and `interpolate`
  std::optional<bool> interpolate{};  ///< ComancheSettings::interpolate; without `shells`, which it would hide
  std::optional<double> reach{};      ///< maximum length of camera rays in metres
};

/// Returns `asked`, completed by `own`, the request of the input itself.
PictureRequest merged(PictureRequest asked, const PictureRequest& own);

/// Images and tables of a request, as read from their files.
struct PictureFiles {
  std::shared_ptr<const RampStops> ramp_stops{};          ///< null: PictureRequest::ramp
  std::shared_ptr<const DetailTexture> detail_texture{};  ///< null: noise
  std::shared_ptr<const Drape> drape{};                   ///< null: none
};

/// The subject of a picture: its properties apart from the request.
struct PictureSubject {
  PictureRequest own{};           ///< the input's own request: the picture of a scene file, the sun of models
  PictureFiles files{};           //
  double grid_north_azimuth = 0;  ///< radians clockwise from true north
  double across = 0;              ///< extent of the picture in metres; 0: unknown
  ReliefRange heights{};          ///< heights of the ground, exaggerated
  double exaggeration = 1;
  std::optional<double> function_extent{};  ///< side of the shown ground in metres, and the distance of its haze
  WorldBox box{};                           ///< used for the distance of cameras; see resolve()
  std::optional<WorldBox> map{};  ///< extent of a map; a picture without a requested size has its aspect ratio
  ImageSize size{1280, 720};      ///< default size in pixels
  bool sea = false;               ///< whether a terrain function is water, by its default colours
  bool alpha = false;             ///< PictureSettings::alpha
};

/// Returns the size in pixels of a map of a box, given that of its longer side.
ImageSize size_of_map(const WorldBox& box, int longer_side);

/// The material of terrain functions in the settings of their pictures.
constexpr std::uint32_t kFunctionMaterial = 2;
/// Default haze of terrain functions over PictureSubject::function_extent.
constexpr double kFunctionHaze = 0.2;
/// Returns the distance in metres at which rays over a terrain function may end: haze hides all but 1/64 of everything
/// behind.
double function_reach(const PictureRequest& asked, double extent);

/// Returns the look of the settings: `comanche` for the look `height` in large pixels.
Look look_of(const PictureRequest& asked);

/// Returns the settings of a picture. A camera at a distance from PictureSubject::box adds ten times that distance to
/// the visibility, unless that is requested: less than a third of the contrast is lost in between. Throws Error naming
/// the first setting that is out of range.
PictureSettings resolve(const PictureRequest& asked, const PictureSubject& subject, const Camera* camera = nullptr);

}  // namespace scarp
