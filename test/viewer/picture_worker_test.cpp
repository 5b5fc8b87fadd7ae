// SPDX-License-Identifier: MIT
// The thread that renders a window's pictures: stages, what newer requests end, errors, and its own end.
#include "app/viewer/picture_worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <vector>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

using namespace std::chrono_literals;

struct Asked {
  int width, height, aa, samples;
};

class Worker : public testing::Test {
 protected:
  PictureRequest request(bool moving, int aa = 2, int samples = 4) {
    PictureSettings settings;
    settings.width = 400, settings.height = 300;
    settings.aa = aa, settings.samples = samples;
    return {[](int width, int height) {
              return Camera::look_at({0, 0, 1}, {0, 1, 0}, 40, width, height);
            },
            settings, moving};
  }

  // Renders nothing, for `render_time` or until it is interrupted.
  Picture render(const PictureSettings& settings, const Progress& progress) {
    {
      const std::scoped_lock lock(mutex_);
      asked_.push_back({settings.width, settings.height, settings.aa, settings.samples});
    }
    const auto end = std::chrono::steady_clock::now() + render_time_;
    do {
      if (!progress(0)) throw Interrupted();
      if (fails_) throw Error("no such picture");
      std::this_thread::sleep_for(1ms);
    } while (std::chrono::steady_clock::now() < end);
    return {Image(settings.width, settings.height)};
  }

  std::unique_ptr<PictureWorker> make() {
    return std::make_unique<PictureWorker>([this](const Camera&, const PictureSettings& settings,
                                                  const Progress& progress) { return render(settings, progress); },
                                           [this] { ++ready_; });
  }

  // The next picture, within ten seconds.
  std::optional<WorkedPicture> next(PictureWorker& worker) {
    for (int i = 0; i < 10'000; ++i) {
      if (auto worked = worker.take()) return worked;
      std::this_thread::sleep_for(1ms);
    }
    return {};
  }
  std::optional<WorkedPicture> converged(PictureWorker& worker) {
    for (;;) {
      auto worked = next(worker);
      if (!worked || worked->stage == PictureStage::converged) return worked;
    }
  }

  std::mutex mutex_;
  std::vector<Asked> asked_;
  std::atomic<bool> fails_ = false;
  std::atomic<int> ready_ = 0;
  std::chrono::milliseconds render_time_ = 5ms;
};

TEST_F(Worker, GoesThroughAllStages) {
  const auto worker = make();
  const auto generation = worker->request(request(false));
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->generation, generation);
  EXPECT_EQ(last->picture.image.width, 400);
  const std::scoped_lock lock(mutex_);
  ASSERT_EQ(asked_.size(), 3u);
  EXPECT_LE(asked_[0].height, 300);
  EXPECT_EQ(asked_[0].aa, 1);
  EXPECT_EQ(asked_[1].height, 300);
  EXPECT_EQ(asked_[1].samples, 0);
  EXPECT_EQ(asked_[2].aa, 2);
  EXPECT_EQ(asked_[2].samples, 4);
  EXPECT_GE(ready_, 1);
}

TEST_F(Worker, SkipsAStageThatIsTheSame) {
  const auto worker = make();
  worker->request(request(false, 1, 0));
  ASSERT_TRUE(converged(*worker));
  const std::scoped_lock lock(mutex_);
  EXPECT_EQ(asked_.size(), 2u);
}

TEST_F(Worker, RendersTheFirstStageAloneWhileMoving) {
  const auto worker = make();
  worker->request(request(true));
  const auto worked = next(*worker);
  ASSERT_TRUE(worked);
  EXPECT_EQ(worked->stage, PictureStage::moving);
  std::this_thread::sleep_for(30ms);
  EXPECT_FALSE(worker->busy());
  EXPECT_FALSE(worker->take());
}

TEST_F(Worker, ANewerRequestEndsTheOlderOne) {
  render_time_ = 20s;  // the second stage would take that long
  const auto worker = make();
  render_time_ = 5ms;
  worker->request(request(false));
  ASSERT_TRUE(next(*worker));
  const auto newer = worker->request(request(false));
  const auto begin = std::chrono::steady_clock::now();
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->generation, newer);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
}

TEST_F(Worker, TellsWhyThereIsNoPictureAndGoesOn) {
  const auto worker = make();
  fails_ = true;
  worker->request(request(false));
  const auto worked = next(*worker);
  ASSERT_TRUE(worked);
  EXPECT_EQ(worked->error, "no such picture");
  fails_ = false;
  worker->request(request(false));
  EXPECT_TRUE(converged(*worker));
}

TEST_F(Worker, EndsWhileItRenders) {
  render_time_ = 20s;
  const auto begin = std::chrono::steady_clock::now();
  {
    const auto worker = make();
    worker->request(request(false));
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
}

TEST_F(Worker, TakesRequestsByTheThousand) {
  render_time_ = 0ms;
  const auto worker = make();
  std::uint64_t generation = 0;
  for (int i = 0; i < 2000; ++i) generation = worker->request(request(i % 3 != 0));
  generation = worker->request(request(false));
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  while (worker->busy()) std::this_thread::sleep_for(1ms);
  const auto newest = worker->take();
  EXPECT_EQ(newest ? newest->generation : last->generation, generation);
}

TEST_F(Worker, RowsFollowTheMeasuredRate) {
  EXPECT_EQ(PictureWorker::rows_for(1e12, 1280, 720), 720);
  EXPECT_EQ(PictureWorker::rows_for(1, 1280, 720), 90);
  EXPECT_EQ(PictureWorker::rows_for(1, 128, 72), 72);
  const auto expect_rate = [](double pixels_per_second, double pictures_per_second) {
    const int rows = PictureWorker::rows_for(pixels_per_second, 1280, 720);
    EXPECT_NEAR(rows * rows * 1280.0 / 720 * pictures_per_second, 0.8 * pixels_per_second, 0.05 * pixels_per_second);
  };
  expect_rate(2e7, 30);
  expect_rate(4e6, 20);
  EXPECT_EQ(PictureWorker::rows_for(7e6, 1280, 720), 360) << "between the two";
}

}  // namespace
}  // namespace scarp::viewer
