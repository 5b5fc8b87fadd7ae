// SPDX-License-Identifier: MIT
// Pictures in rounds of questions: the work on a tile asks rays, gets all answers at once, asks again, until it knows
// its pixels.
//
//   on the CPU      every thread works on a tile of its own; its rays are a batch of hundreds
//   on a device     many tiles are worked on together, and what they ask in a round is one batch of 2^18 rays at most
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/render/frame/film.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Rays of one tile that wait for their answers, and then the answers.
struct RayRound {
  enum class Question {
    closest,       ///< answered in `hits`
    closest_cost,  ///< in `hits` and `steps`
    any,           ///< in `blocked`
  };
  Question question = Question::closest;
  std::vector<Ray> rays;
  /// Hits on whose surfaces the rays begin, as in Scene::closest_hits(); empty: none, or Ray::start says so.
  std::vector<const Hit*> from;
  std::vector<Hit> hits;
  std::vector<std::uint32_t> steps;
  std::vector<std::uint8_t> blocked;
};

/// No tile asks more at once.
constexpr std::size_t kMostRaysOfRound = 8192;

class TileWork {
 public:
  virtual ~TileWork() = default;
  /// Reads the answers of the round before (none in the first call) and sets the next question and its rays, at most
  /// kMostRaysOfRound. False: the tile is done.
  virtual bool next(RayRound& round) = 0;
};

/// Makes the work on one tile; called on any thread.
using MakeTileWork = std::function<std::unique_ptr<TileWork>(const PixelTile&)>;

/// Does the work on all tiles, on all threads. `most_rays` is what a tile asks at most in a round, 1 to
/// kMostRaysOfRound. Throws Interrupted when progress asks for it.
void work_on_tiles(const Scene& scene, const PixelTiles& tiles, std::size_t most_rays, const MakeTileWork& make,
                   const Progress& progress);

}  // namespace scarp
