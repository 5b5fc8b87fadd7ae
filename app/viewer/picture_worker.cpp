// SPDX-License-Identifier: MIT
#include "app/viewer/picture_worker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr int kLeastRows = 90;
// At least as many as that, where kLeastFramesPerSecond allow it.
constexpr int kGoodRows = 360;
// No clock resolves less.
constexpr double kLeastSeconds = 1e-6;
// Of the measured rate: pictures of one view differ in cost.
constexpr double kCaution = 0.8;

}  // namespace

PictureWorker::PictureWorker(Render render, std::function<void()> ready)
    : render_(std::move(render)), ready_(std::move(ready)), thread_([this] { work(); }) {}

PictureWorker::~PictureWorker() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
    ++generation_;
  }
  wake_.notify_one();
  thread_.join();
}

std::uint64_t PictureWorker::request(PictureRequest request) {
  std::uint64_t generation;
  {
    const std::scoped_lock lock(mutex_);
    next_ = std::move(request);
    generation = ++generation_;
  }
  wake_.notify_one();
  return generation;
}

std::optional<WorkedPicture> PictureWorker::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

bool PictureWorker::busy() const {
  const std::scoped_lock lock(mutex_);
  return busy_ || next_.has_value();
}

int PictureWorker::rows_for(double pixels_per_second, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  const auto rows_in = [&](double seconds) {
    return static_cast<int>(std::sqrt(kCaution * pixels_per_second * seconds / aspect));
  };
  // Fewer pictures rather than few rows, as long as they still move.
  int rows = rows_in(1 / kFramesPerSecond);
  if (rows < kGoodRows) rows = std::min(kGoodRows, rows_in(1 / kLeastFramesPerSecond));
  return std::clamp(rows, std::min(kLeastRows, height), height);
}

bool PictureWorker::outdated(std::uint64_t generation) const {
  const std::scoped_lock lock(mutex_);
  return stop_ || generation != generation_;
}

void PictureWorker::work() {
  for (;;) {
    PictureRequest request;
    std::uint64_t generation;
    {
      std::unique_lock lock(mutex_);
      busy_ = false;
      wake_.wait(lock, [&] { return stop_ || next_.has_value(); });
      if (stop_) return;
      request = std::move(*next_);
      next_.reset();
      generation = generation_;
      busy_ = true;
    }
    bool goes_on = render_stage(request, PictureStage::moving, generation);
    if (request.moving) continue;
    for (const PictureStage stage : {PictureStage::full, PictureStage::converged})
      goes_on = goes_on && render_stage(request, stage, generation);
  }
}

// Returns whether the next stage is wanted.
bool PictureWorker::render_stage(const PictureRequest& request, PictureStage stage, std::uint64_t generation) {
  PictureSettings settings = request.settings;
  const bool is_full = settings.aa == 1 && settings.samples == 0;
  if (stage == PictureStage::full && is_full) return true;  // the same as converged
  if (stage != PictureStage::converged) settings.aa = 1, settings.samples = 0;
  if (stage == PictureStage::moving) {
    const int rows = rows_for(pixels_per_second_, settings.width, settings.height);
    settings.width =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(settings.width) * rows / settings.height)));
    settings.height = rows;
  }
  const auto begin = std::chrono::steady_clock::now();
  WorkedPicture worked;
  worked.stage = stage;
  worked.generation = generation;
  try {
    worked.picture = render_(request.camera(settings.width, settings.height), settings, [&](double) {
      // What is under way while moving is shown; only the end of the window ends it.
      if (stage != PictureStage::moving) return !outdated(generation);
      const std::scoped_lock lock(mutex_);
      return !stop_;
    });
  } catch (const Interrupted&) {
    return false;
  } catch (const std::exception& error) {
    worked.error = error.what();
  }
  worked.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (stage == PictureStage::moving && worked.error.empty())
    pixels_per_second_ =
        static_cast<double>(settings.width) * settings.height / std::max(worked.seconds, kLeastSeconds);
  const bool failed = !worked.error.empty();
  {
    const std::scoped_lock lock(mutex_);
    done_ = std::move(worked);
  }
  ready_();
  return !failed && !outdated(generation);
}

}  // namespace scarp::viewer
