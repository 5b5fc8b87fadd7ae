// SPDX-License-Identifier: MIT
// What rays of the camera meet: ground, or walls of the block below it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scarp/render/frame/picture.h"
#include "scarp/render/frame/tile_work.h"
#include "scarp/render/surface/plinth.h"

namespace scarp {

/// Nothing when the settings want none.
std::optional<Plinth> plinth_of(const HeightField& field, const PictureSettings& settings);

/// What a ray of the camera meets: ground, or else perhaps a wall.
struct Sight {
  Hit hit;
  std::optional<Plinth::Wall> wall;
  std::uint32_t steps = 0;  ///< of the march, when they were asked for
};

/// The rays through the middles of a tile's pixels, row by row.
std::vector<Ray> rays_through_middles(const Camera& camera, const PixelTile& tile);

/// Asks for the sights of a tile's rays, in one round. Rays are not marched where the block hides the field: below its
/// base and behind its outer walls.
class SightRound {
 public:
  /// `plinth` must outlive this.
  explicit SightRound(const std::optional<Plinth>& plinth) : plinth_(plinth) {}

  void ask(std::span<const Ray> rays, bool steps, RayRound& round);
  /// In the order of the rays.
  std::vector<Sight> answers(const RayRound& round);

 private:
  const std::optional<Plinth>& plinth_;
  std::vector<Sight> sights_;
  std::vector<std::size_t> marched_;  // the rays of the round
};

}  // namespace scarp
