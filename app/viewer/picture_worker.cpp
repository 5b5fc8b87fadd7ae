// SPDX-License-Identifier: MIT
#include "app/viewer/picture_worker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr int kLeastRows = 90;
// Below the resolution of any clock.
constexpr double kLeastSeconds = 1e-6;
// Fraction of the measured rate: pictures of one view differ in cost.
constexpr double kCaution = 0.8;
// Ratio of the costs of successive passes at rest.
constexpr int kGrowth = 4;

class Watch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

WorkedPicture begun(const ViewRequest& request, std::uint64_t generation) {
  WorkedPicture worked;
  worked.generation = generation;
  worked.large_pixels = std::any_of(request.sides.begin(), request.sides.end(),
                                    [](const PictureSide& side) { return entry_of(side.settings.look).large_pixels; });
  return worked;
}

PictureSettings with_rows(PictureSettings settings, int rows) {
  settings.width =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(settings.width) * rows / settings.height)));
  settings.height = rows;
  settings.aa = 1, settings.samples = 0;
  return settings;
}

// Renders a side into `worked`, with its time.
void add_side(WorkedPicture& worked, const ViewRequest& request, const PictureSide& side,
              const PictureSettings& settings, const Progress& progress) {
  const Watch watch;
  worked.sides.push_back(side.render(request.camera(settings.width, settings.height), settings, progress));
  worked.side_seconds.push_back(watch.seconds());
}

// Renders into `worked`, or sets its error. Returns false if it was interrupted.
template <class Render>
bool attempt(WorkedPicture& worked, const Render& render) {
  try {
    render();
  } catch (const Interrupted&) {
    return false;
  } catch (const std::exception& error) {
    worked.error = error.what();
  }
  return true;
}

}  // namespace

PictureWorker::PictureWorker(std::function<void()> ready) : ready_(std::move(ready)), thread_([this] { work(); }) {}

PictureWorker::~PictureWorker() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
    ++generation_;
  }
  wake_.notify_one();
  thread_.join();
}

std::uint64_t PictureWorker::request(ViewRequest request) {
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

std::optional<WorkedVerdict> PictureWorker::take_verdict() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(verdict_, std::nullopt);
}

bool PictureWorker::busy() const {
  const std::scoped_lock lock(mutex_);
  return busy_ || next_.has_value();
}

int PictureWorker::rows_for(double pixels_per_second, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  const int rows = static_cast<int>(std::sqrt(kCaution * pixels_per_second / kFramesPerSecond / aspect));
  return std::clamp(rows, std::min(kLeastRows, height), height);
}

std::vector<int> PictureWorker::rows_between(int rows, int height) {
  std::vector<int> between;
  for (const int part : {4, 2}) {
    if (height / part > rows) between.push_back(height / part);
  }
  return between;
}

std::vector<PictureSettings> PictureWorker::refinement_of(const PictureSettings& settings) {
  std::vector<PictureSettings> passes{settings};
  // Other looks trace one ray per pixel.
  if (!entry_of(settings.look).lit) return passes;
  for (PictureSettings next = settings; next.aa > 1 || next.samples > 0;) {
    // Anti-aliasing multiplies the number of samples and light rays; its cost is quadratic.
    if (next.aa > 1) {
      next.aa /= 2;
    } else {
      next.samples /= kGrowth;
      if (next.samples < kGrowth) next.samples = 0;
    }
    passes.push_back(next);
  }
  std::reverse(passes.begin(), passes.end());
  return passes;
}

bool PictureWorker::outdated(std::uint64_t generation) const {
  const std::scoped_lock lock(mutex_);
  return stop_ || generation != generation_;
}

bool PictureWorker::stopped() const {
  const std::scoped_lock lock(mutex_);
  return stop_;
}

void PictureWorker::work() {
  for (;;) {
    ViewRequest request;
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
    const bool shown = request.stays && moved_ + 1 == generation;
    if ((!shown && !render_moving(request, generation)) || request.moving) continue;
    if (!render_between(request, generation)) continue;
    if (render_at_rest(request, generation)) judge(request, generation);
  }
}

// Publishes the picture. Returns whether there is one.
bool PictureWorker::deliver(WorkedPicture worked) {
  const bool failed = !worked.error.empty();
  {
    const std::scoped_lock lock(mutex_);
    done_ = std::move(worked);
  }
  ready_();
  return !failed;
}

// Returns whether the next pass is needed, like the two functions below.
bool PictureWorker::render_moving(const ViewRequest& request, std::uint64_t generation) {
  std::int64_t most_pixels = 0;                      // of one side
  int least_rows = std::numeric_limits<int>::max();  // of sides that need more
  WorkedPicture worked = begun(request, generation);
  const Watch watch;
  const bool done = attempt(worked, [&] {
    for (const PictureSide& side : request.sides) {
      const int rows = rows_for(pixels_per_second_, side.settings.width, side.settings.height);
      const PictureSettings settings = with_rows(side.settings, rows);
      most_pixels = std::max(most_pixels, std::int64_t{settings.width} * settings.height);
      least_rows = std::min(least_rows, rows < side.settings.height ? rows : least_rows);
      // A picture that was started while moving is always shown; only closing the window cancels it.
      add_side(worked, request, side, settings, [&](double) { return !stopped(); });
    }
  });
  if (!done) return false;
  worked.seconds = watch.seconds();
  if (worked.error.empty()) {
    pixels_per_second_ = static_cast<double>(most_pixels) / std::max(worked.seconds, kLeastSeconds);
    moved_ = generation, moved_rows_ = least_rows;
  }
  return deliver(std::move(worked)) && !outdated(generation);
}

bool PictureWorker::render_between(const ViewRequest& request, std::uint64_t generation) {
  int height = 0;
  for (const PictureSide& side : request.sides) height = std::max(height, side.settings.height);
  for (const int rows : rows_between(moved_rows_, height)) {
    WorkedPicture worked = begun(request, generation);
    worked.pass = PicturePass::coarse;
    const Watch watch;
    const bool done = attempt(worked, [&] {
      for (const PictureSide& side : request.sides) {
        // Large pixels are few: they are all there from the first pass on.
        const int own = std::min(rows, side.settings.height);
        add_side(worked, request, side, with_rows(side.settings, own), [&](double) { return !outdated(generation); });
      }
    });
    worked.seconds = watch.seconds();
    if (!done || !deliver(std::move(worked)) || outdated(generation)) return false;
  }
  return true;
}

bool PictureWorker::render_at_rest(const ViewRequest& request, std::uint64_t generation) {
  std::vector<std::vector<PictureSettings>> passes;
  std::size_t count = 1;
  for (const PictureSide& side : request.sides) {
    passes.push_back(refinement_of(side.settings));
    count = std::max(count, passes.back().size());
  }
  std::vector<Picture> before;
  std::vector<double> seconds_before;
  for (std::size_t i = 0; i < count; ++i) {
    WorkedPicture worked = begun(request, generation);
    worked.pass = i + 1 == count ? PicturePass::converged : i == 0 ? PicturePass::full : PicturePass::refining;
    const Watch watch;
    const bool done = attempt(worked, [&] {
      for (std::size_t s = 0; s < passes.size(); ++s) {
        // All sides are complete after the last pass.
        const std::size_t last = passes[s].size() - 1, left = count - 1 - i;
        const PictureSettings& settings = passes[s][last - std::min(last, left)];
        if (i > 0 && left >= last) {
          worked.sides.push_back(before[s]);  // its only pass so far
          worked.side_seconds.push_back(seconds_before[s]);
          continue;
        }
        if (s == 0) worked.aa = settings.aa, worked.samples = settings.samples;
        add_side(worked, request, request.sides[s], settings, [&](double) { return !outdated(generation); });
      }
    });
    worked.seconds = watch.seconds();
    if (i + 1 < count) before = worked.sides, seconds_before = worked.side_seconds;
    if (!done || !deliver(std::move(worked)) || outdated(generation)) return false;
  }
  return true;
}

void PictureWorker::judge(const ViewRequest& request, std::uint64_t generation) {
  WorkedVerdict verdict;
  verdict.generation = generation;
  try {
    for (const PictureSide& side : request.sides) {
      verdict.sides.push_back(side.judge ? side.judge(request.camera(side.settings.width, side.settings.height),
                                                      [&](double) { return !outdated(generation); })
                                         : std::nullopt);
    }
  } catch (const std::exception&) {
    return;  // interrupted, or the device is lost: the picture is already complete
  }
  {
    const std::scoped_lock lock(mutex_);
    verdict_ = std::move(verdict);
  }
  ready_();
}

}  // namespace scarp::viewer
