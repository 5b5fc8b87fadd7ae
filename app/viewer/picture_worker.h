// SPDX-License-Identifier: MIT
// A thread that renders the picture of a window, so that the window never waits.
//
//   while moving   only as many rows as can be traced in a frame; one sample per pixel, hard shadows
//   then           a quarter and half of the resolution, where that is finer; full resolution, one sample per pixel
//   refining       more and more samples, see refinement_of()
//   at rest        the settings as requested: the picture of `scarp render`
//   afterwards     some rays of the picture are judged
//
// A picture may have two sides, such as the same view by two marches. Each pass renders both.
//
// Each request has a number, its generation. A newer request cancels all passes of the older request except the first,
// which is shown even if the view keeps moving.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/look/judged_rays.h"

namespace scarp::viewer {

enum class PicturePass { moving, coarse, full, refining, converged };

struct PictureSide {
  PictureSettings settings;  ///< of the converged picture
  /// Renders a picture; throws Interrupted if the progress returns false. Called only on the worker's thread.
  std::function<Picture(const Camera& camera, const PictureSettings& settings, const Progress& progress)> render;
  /// Judges some rays of a camera; nullopt: not judged. Called, and throws, as `render`. May be null.
  std::function<std::optional<JudgedRays>(const Camera& camera, const Progress& progress)> judge{};
};

struct ViewRequest {
  std::function<Camera(int width, int height)> camera;
  std::vector<PictureSide> sides;  ///< at least one
  bool moving = false;             ///< more requests will follow soon: only the first pass is started
  /// The view is that of the request before: its first pass, once shown, is not rendered again, because its resolution
  /// might be coarser this time.
  bool stays = false;
};

struct WorkedPicture {
  std::vector<Picture> sides{};
  PicturePass pass = PicturePass::moving;
  int aa = 1, samples = 0;    ///< of this pass
  bool large_pixels = false;  ///< at least one side has the look comanche
  std::uint64_t generation = 0;
  double seconds = 0;
  std::vector<double> side_seconds{};  ///< of each side; a side that an earlier pass completed keeps its time
  std::string error{};                 ///< empty: there is a picture
};

struct WorkedVerdict {
  std::vector<std::optional<JudgedRays>> sides{};
  std::uint64_t generation = 0;
};

class PictureWorker {
 public:
  /// `ready` is called on the worker's thread when a result is available.
  explicit PictureWorker(std::function<void()> ready);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  /// Replaces the previous request. Returns the new generation.
  std::uint64_t request(ViewRequest request);
  /// The newest picture that has not been taken yet.
  std::optional<WorkedPicture> take();
  /// Returns the newest verdict not yet taken.
  std::optional<WorkedVerdict> take_verdict();
  /// Whether there is work to do.
  bool busy() const;

  /// Pictures per second of the first pass.
  static constexpr double kFramesPerSecond = 30;
  /// Number of rows of the first pass, at most `height`: as many as can be rendered in a frame, given the rate in
  /// pixels per second of the previous first pass.
  static int rows_for(double pixels_per_second, int width, int height);
  /// The rows of the passes between a first pass of `rows` and one of `height` rows, each finer than the one before.
  static std::vector<int> rows_between(int rows, int height);
  /// The settings of the passes at rest, from one sample per pixel to the requested ones. Each costs at least about
  /// four times as much as the previous one, so all earlier passes together cost about a third of the last.
  static std::vector<PictureSettings> refinement_of(const PictureSettings& settings);

 private:
  void work();
  bool render_moving(const ViewRequest& request, std::uint64_t generation);
  bool render_between(const ViewRequest& request, std::uint64_t generation);
  bool render_at_rest(const ViewRequest& request, std::uint64_t generation);
  void judge(const ViewRequest& request, std::uint64_t generation);
  bool deliver(WorkedPicture worked);
  bool outdated(std::uint64_t generation) const;
  bool stopped() const;

  std::function<void()> ready_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<ViewRequest> next_;
  std::optional<WorkedPicture> done_;
  std::optional<WorkedVerdict> verdict_;
  std::uint64_t generation_ = 0;
  bool stop_ = false, busy_ = false;
  // Used only by the worker's thread.
  double pixels_per_second_ = 4e6;  // until measured
  std::uint64_t moved_ = 0;         // generation of the last first pass that was shown
  int moved_rows_ = 0;              // of its coarsest side
  std::thread thread_;
};

}  // namespace scarp::viewer
