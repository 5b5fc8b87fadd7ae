// SPDX-License-Identifier: MIT
#include "scarp/render/film/tile_work.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/kept_memory.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

using Question = RayRound::Question;

constexpr std::size_t kRaysAtOnce = 1 << 18;  // on a device
// Areas that are traced by fans: enough for many threads, and as high as possible. An area of the maximum size has 2^17
// points, 1 MiB.
constexpr std::int64_t kAreas = 128, kMostTilesOfArea = 128;

// A round whose memory is reused by the next tile.
struct KeptRound : RayRound {
  KeptRound() { borrow(rays), borrow(from), borrow(sights), borrow(hits), borrow(steps), borrow(blocked); }
  ~KeptRound() { keep(rays), keep(from), keep(sights), keep(hits), keep(steps), keep(blocked); }
  KeptRound(const KeptRound&) = delete;
  KeptRound& operator=(const KeptRound&) = delete;
  // For the next tile.
  void reset() {
    question = Question::closest;
    rays.clear(), from.clear(), sights.clear(), hits.clear(), steps.clear(), blocked.clear();
  }
};

void answer(const Scene& scene, RayRound& round) {
  if (round.question == Question::any) {
    round.blocked.resize(round.rays.size());
    return scene.occluded(round.rays, round.blocked, round.from);
  }
  round.hits.resize(round.rays.size());
  if (!round.sights.empty()) {
    scene.closest_hits(round.rays, round.sights, round.hits);
    return round.sights.clear();
  }
  round.steps.resize(round.question == Question::closest_cost ? round.rays.size() : 0);
  scene.closest_hits(round.rays, round.hits, round.steps, round.from);
}

struct OpenTile {
  std::unique_ptr<TileWork> work;
  RayRound round;
  bool open = true;
  std::size_t first = 0;  // index of its first ray in the batch
};

// One batch for all tiles with the same query.
class Together {
 public:
  void answer(const Scene& scene, std::vector<OpenTile>& tiles, Question question) {
    std::size_t rays = 0;
    bool from = false;
    for (OpenTile& tile : tiles) {
      if (!asks(tile, question)) continue;
      tile.first = rays;
      rays += tile.round.rays.size();
      from = from || !tile.round.from.empty();
    }
    if (rays == 0) return;
    batch_.question = question;
    batch_.rays.resize(rays);
    batch_.from.assign(from ? rays : 0, nullptr);
    for_each(tiles, question, [&](OpenTile& tile) {
      std::copy(tile.round.rays.begin(), tile.round.rays.end(), batch_.rays.begin() + at(tile.first));
      std::copy(tile.round.from.begin(), tile.round.from.end(), batch_.from.begin() + (from ? at(tile.first) : 0));
    });
    scarp::answer(scene, batch_);
    for_each(tiles, question, [&](OpenTile& tile) {
      const std::size_t count = tile.round.rays.size();
      hand_out(batch_.blocked, tile.first, count, question == Question::any, tile.round.blocked);
      hand_out(batch_.hits, tile.first, count, question != Question::any, tile.round.hits);
      hand_out(batch_.steps, tile.first, count, question == Question::closest_cost, tile.round.steps);
    });
  }

 private:
  static bool asks(const OpenTile& tile, Question question) { return tile.open && tile.round.question == question; }
  static std::ptrdiff_t at(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  template <class Body>
  static void for_each(std::vector<OpenTile>& tiles, Question question, const Body& body) {
    parallel_for(static_cast<std::int64_t>(tiles.size()), 1, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        if (asks(tiles[i], question)) body(tiles[i]);
      }
    });
  }

  template <class Answer>
  static void hand_out(const std::vector<Answer>& all, std::size_t first, std::size_t count, bool asked,
                       std::vector<Answer>& answers) {
    if (asked) answers.assign(all.begin() + at(first), all.begin() + at(first + count));
  }

  RayRound batch_;
};

void work_together(const Scene& scene, const PixelTiles& tiles, std::size_t tiles_at_once, const MakeTileWork& make,
                   const Progress& progress) {
  Together together;
  for (std::int64_t first = 0; first < tiles.count(); first += static_cast<std::int64_t>(tiles_at_once)) {
    // The fraction within a round is unknown; the call only polls for a request to stop.
    Progress listen;
    if (progress) {
      listen = [&](double) { return progress(static_cast<double>(first) / static_cast<double>(tiles.count())); };
    }
    std::vector<OpenTile> group(std::min(tiles_at_once, static_cast<std::size_t>(tiles.count() - first)));
    for (bool open = true; open;) {
      parallel_for(
          static_cast<std::int64_t>(group.size()), 1,
          [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
              OpenTile& tile = group[static_cast<std::size_t>(i)];
              if (!tile.work) tile.work = make(tiles[first + i]);
              if (tile.open) tile.open = tile.work->next(tile.round);
            }
          },
          listen);
      for (const Question question : {Question::closest, Question::closest_cost, Question::any}) {
        together.answer(scene, group, question);
      }
      open = std::any_of(group.begin(), group.end(), [](const OpenTile& tile) { return tile.open; });
    }
  }
  if (progress && !progress(1.0)) throw Interrupted();
}

}  // namespace

void work_on_tiles(const Scene& scene, const PixelTiles& tiles, std::size_t most_rays, const MakeTileWork& make,
                   const Progress& progress) {
  if (scene.on_device()) return work_together(scene, tiles, kRaysAtOnce / most_rays, make, progress);
  parallel_for(
      tiles.count(), 1,
      [&](std::int64_t begin, std::int64_t end) {
        KeptRound round;
        for (std::int64_t i = begin; i < end; ++i) {
          const std::unique_ptr<TileWork> work = make(tiles[i]);
          round.reset();
          while (work->next(round)) answer(scene, round);
        }
      },
      progress);
}

void work_on_camera_tiles(const Scene& scene, const Camera& camera, int width, int height, int aa,
                          std::size_t most_rays, const MakeCameraWork& make, const Progress& progress) {
  const PixelTiles tiles(width, height, aa);
  const std::int64_t most = std::max<std::int64_t>(1, (tiles.columns() * tiles.rows() + kAreas - 1) / kAreas);
  const std::int64_t height_of_area = std::min({most, tiles.rows(), kMostTilesOfArea});
  const CameraFan fan(scene, camera, static_cast<int>(height_of_area) * tiles.side(), aa);
  if (!fan.pays()) {
    return work_on_tiles(
        scene, tiles, most_rays, [&](const PixelTile& tile) { return make(tile, nullptr); }, progress);
  }
  // The first tile of an area traces the fans of the whole area; the others wait. Work is divided by tiles, so that a
  // picture ends soon after it is stopped.
  struct Area {
    std::once_flag looked;
    std::optional<CameraSights> sights;
    std::atomic<std::int64_t> left;  // tiles
  };
  const std::int64_t down = (tiles.rows() + height_of_area - 1) / height_of_area;
  std::vector<Area> areas(static_cast<std::size_t>(tiles.columns() * down));
  const auto rows_of = [&](std::int64_t area) {
    const std::int64_t first = area / tiles.columns() * height_of_area;
    return std::pair(first, std::min(first + height_of_area, tiles.rows()));
  };
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const auto [first, last] = rows_of(static_cast<std::int64_t>(i));
    areas[i].left = last - first;
  }
  parallel_for(
      tiles.columns() * down * height_of_area, 1,
      [&](std::int64_t begin, std::int64_t end) {
        KeptRound round;
        for (std::int64_t i = begin; i < end; ++i) {
          const std::int64_t number = i / height_of_area, column = number % tiles.columns();
          const auto [first, last] = rows_of(number);
          const std::int64_t row = first + i % height_of_area;
          if (row >= last) continue;
          Area& area = areas[static_cast<std::size_t>(number)];
          std::call_once(area.looked, [&, from = first, to = last] {
            const PixelTile top = tiles[from * tiles.columns() + column];
            fan.look({top.x0, top.y0, top.x1, tiles[(to - 1) * tiles.columns() + column].y1}, area.sights.emplace());
          });
          const std::unique_ptr<TileWork> work = make(tiles[row * tiles.columns() + column], &*area.sights);
          round.reset();
          while (work->next(round)) answer(scene, round);
          if (--area.left == 0) area.sights.reset();
        }
      },
      progress);
}

}  // namespace scarp
