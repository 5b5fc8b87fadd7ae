// SPDX-License-Identifier: MIT
// Warns about pictures that show nothing, with the reason. A coarse grid of camera rays measures the fraction of the
// picture on surfaces above water. Below half a percent the picture counts as blank, and the reason is derived from the
// position of the eye, obstructions and heights. A picture of one colour counts as blank, too. A mesh that no sample of
// the picture shows gets a note.
#pragma once

#include <string>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

/// Fractions of a picture, 0 to 1, measured with a coarse grid of rays.
struct SeenShares {
  double surfaces = 0;     ///< surfaces above water, not hidden by fog; plinths do not count
  double under_water = 0;  ///< ground below the level of the water
  double in_fog = 0;       ///< surfaces beyond the visibility
  double inside = 0;       ///< rays that start inside a solid
  double nearest = 0;      ///< metres to the nearest hit; 0 without one
};

/// Traces at most a few thousand rays.
SeenShares seen_shares(const Scene& scene, const Camera& camera, const PictureSettings& picture);

/// Facts for the reasons, besides scene and camera.
struct BlankFacts {
  ReliefRange heights{};  ///< of the ground, exaggerated
  bool one_colour = false;
  bool area = false;          ///< whether --area determined the view
  double function_reach = 0;  ///< metres, of rays over functions; 0: no function
};

/// Returns why a picture is blank, as text after a colon; empty if it is not.
std::string why_blank(const Scene& scene, const Camera& camera, const PictureSettings& picture,
                      const BlankFacts& facts);

/// Returns whether all pixels have one colour.
bool has_one_colour(const Image& image);
bool has_one_colour(const PictureLayers& layers);

/// Collects blank pictures of one run, for one warning.
class BlankPictures {
 public:
  /// `why` is the result of why_blank().
  void add(const std::string& name, const std::string& why);
  /// Prints the warning, if any; returns whether it printed one.
  bool tell() const;
  /// Returns the number of blank pictures.
  int count() const { return blank_; }

 private:
  int pictures_ = 0, blank_ = 0;
  std::string first_, why_;  // name and reason of the first blank picture
};

/// Returns why a picture shows an object of the scene in no sample, or smaller than a pixel, as text that follows its
/// name; empty: it is visible. Traces the picture's camera rays around the object until one hits it.
std::string why_unseen(const Scene& scene, std::uint32_t object, const Camera& camera, const PictureSettings& picture);

/// Returns a note for water below all ground; empty: there is none.
std::string note_on_low_water(const Scene& scene, const PictureSettings& picture, const BlankFacts& facts);

}  // namespace scarp::cli
