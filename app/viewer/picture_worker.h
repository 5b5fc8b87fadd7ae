// SPDX-License-Identifier: MIT
// A thread that renders the picture of a window, so that the window never waits.
//
//   while moving   few rows, as many as can be traced in a frame; one sample per pixel, hard shadows
//   then           full resolution, one sample per pixel
//   at rest        the settings as they were asked for: what `scarp render` writes
//
// Each request has a number, its generation. A newer request ends the work on all but the first stage of the older
// one, which is shown even if the view goes on to move.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"

namespace scarp::viewer {

enum class PictureStage { moving, full, converged };

struct PictureRequest {
  std::function<Camera(int width, int height)> camera;
  PictureSettings settings;  ///< of the converged picture
  bool moving = false;       ///< more requests will follow soon: no other stage than the first is begun
};

struct WorkedPicture {
  Picture picture;
  PictureStage stage = PictureStage::moving;
  std::uint64_t generation = 0;
  double seconds = 0;
  std::string error{};  ///< why there is no picture
};

class PictureWorker {
 public:
  /// Renders a picture; throws Interrupted when the progress asks for it. Called on the worker's thread alone.
  using Render =
      std::function<Picture(const Camera& camera, const PictureSettings& settings, const Progress& progress)>;
  /// `ready` is called on the worker's thread when there is something to take().
  PictureWorker(Render render, std::function<void()> ready);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  /// Replaces the request before. Returns its generation.
  std::uint64_t request(PictureRequest request);
  /// The newest picture that was not taken yet.
  std::optional<WorkedPicture> take();
  /// Whether there is work to do.
  bool busy() const;

  /// Pictures per second of the first stage.
  static constexpr double kFramesPerSecond = 30, kLeastFramesPerSecond = 20;
  /// Rows of the first stage: as many as can be rendered in a frame, of at most `height`, by the pixels per second of
  /// the last first stage.
  static int rows_for(double pixels_per_second, int width, int height);

 private:
  void work();
  bool render_stage(const PictureRequest& request, PictureStage stage, std::uint64_t generation);
  bool outdated(std::uint64_t generation) const;

  Render render_;
  std::function<void()> ready_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<PictureRequest> next_;
  std::optional<WorkedPicture> done_;
  std::uint64_t generation_ = 0;
  bool stop_ = false, busy_ = false;
  double pixels_per_second_ = 4e6;  // until it was measured; of the worker's thread alone
  std::thread thread_;
};

}  // namespace scarp::viewer
