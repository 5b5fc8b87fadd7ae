// SPDX-License-Identifier: MIT
// The colours of a tile's points in the look `shaded`, in rounds: rays of the camera, then rays from the ground that
// they meet to sun and sky, in as many rounds as these need.
#pragma once

#include <span>
#include <vector>

#include "scarp/render/frame/shader.h"
#include "scarp/render/frame/tile_work.h"

namespace scarp {

/// What does not change from tile to tile; all must outlive the tiles.
struct ShadedView {
  const Camera& camera;
  const std::optional<Plinth>& plinth;
  const Shader& shader;
  int aa;
};

/// What such a tile asks at most in a round.
std::size_t most_rays_of(const Shader& shader);

class ShadedTile {
 public:
  ShadedTile(const ShadedView& view, const PixelTile& tile);

  /// As TileWork::next.
  bool next(RayRound& round);
  /// The mean colours of the pixels, row by row, in linear light, when there is no further round.
  std::vector<vec3> pixels() const;
  /// Likewise of each point (points_of), with its ray and what that met.
  const std::vector<vec3>& colours() const { return colours_; }
  const std::vector<PicturePoint>& points() const { return points_; }
  const std::vector<Ray>& rays() const { return rays_; }
  const std::vector<Sight>& sights() const { return sights_; }

 private:
  bool ask_light(RayRound& round);
  void take_light(const RayRound& round);

  // A point on the ground whose light has been asked for.
  struct Open {
    std::size_t point;
    GroundPoint ground;
    LightRays asked;
  };

  const ShadedView& view_;
  std::vector<PicturePoint> points_;
  std::vector<Ray> rays_;
  SightRound looking_;
  std::vector<Sight> sights_;
  bool looks_ = false;
  std::size_t asked_points_ = 0;
  std::vector<Open> open_;
  std::vector<vec3> colours_;
};

}  // namespace scarp
