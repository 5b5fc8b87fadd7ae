// SPDX-License-Identifier: MIT
// Renders pictures in rounds: the work on a tile submits rays, receives all results at once, and submits again until
// its pixels are done.
//
//   on the CPU      every thread works on its own tile; its rays are a batch of hundreds
//   on a device     many tiles are worked on together, and their rays of a round are one batch of at most 2^18
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/render/film/camera_fan.h"
#include "scarp/render/film/film.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Rays of one tile that wait for their results, then the results.
struct RayRound {
  enum class Question {
    closest,       ///< answered in `hits`
    closest_cost,  ///< in `hits` and `steps`
    any,           ///< in `blocked`
  };
  Question question = Question::closest;
  std::vector<Ray> rays;
  /// Hits on whose surfaces the rays start, as in Scene::closest_hits(); empty: rays start as Ray::start states.
  std::vector<const Hit*> from;
  /// Question::closest: what a fan has found for the rays, valid only for the next query; empty: nothing.
  std::vector<FanSight> sights;
  std::vector<Hit> hits;
  std::vector<std::uint32_t> steps;
  std::vector<std::uint8_t> blocked;
};

/// Maximum number of rays of a tile in one round.
constexpr std::size_t kMostRaysOfRound = 8192;

class TileWork {
 public:
  virtual ~TileWork() = default;
  /// Reads the results of the previous round (none in the first call) and sets the next query and its rays, at most
  /// kMostRaysOfRound. Returns false if the tile is done.
  virtual bool next(RayRound& round) = 0;
};

/// Creates the work on one tile; called on any thread.
using MakeTileWork = std::function<std::unique_ptr<TileWork>(const PixelTile&)>;

/// Does the work on all tiles, on all threads. `most_rays` is the maximum number of rays of a tile in a round, 1 to
/// kMostRaysOfRound. Throws Interrupted if `progress` returns false.
void work_on_tiles(const Scene& scene, const PixelTiles& tiles, std::size_t most_rays, const MakeTileWork& make,
                   const Progress& progress);

/// The same for a picture of width x height pixels with aa x aa points each. If it is faster, a fan traces the camera
/// rays, and the work receives its results; otherwise the work receives null.
using MakeCameraWork = std::function<std::unique_ptr<TileWork>(const PixelTile&, const CameraSights*)>;
void work_on_camera_tiles(const Scene& scene, const Camera& camera, int width, int height, int aa,
                          std::size_t most_rays, const MakeCameraWork& make, const Progress& progress);

}  // namespace scarp
