// SPDX-License-Identifier: MIT
// The thread that renders a window's pictures: passes, interruption by newer requests, errors, and shutdown.
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
  ViewRequest request(bool moving, int aa = 2, int samples = 4) {
    PictureSettings settings;
    settings.width = 400, settings.height = 300;
    settings.aa = aa, settings.samples = samples;
    return {[](int width, int height) {
              return Camera::look_at({0, 0, 1}, {0, 1, 0}, 40, width, height);
            },
            {side(settings)},
            moving};
  }
  PictureSide side(const PictureSettings& settings) {
    return {settings, [this](const Camera&, const PictureSettings& asked, const Progress& progress) {
              return render(asked, progress);
            }};
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
    return std::make_unique<PictureWorker>([this] { ++ready_; });
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
      if (!worked || worked->pass == PicturePass::converged) return worked;
    }
  }

  std::mutex mutex_;
  std::vector<Asked> asked_;
  std::atomic<bool> fails_ = false;
  std::atomic<int> ready_ = 0;
  std::chrono::milliseconds render_time_ = 5ms;
};

TEST_F(Worker, RunsAllPasses) {
  const auto worker = make();
  const auto generation = worker->request(request(false));
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->generation, generation);
  EXPECT_EQ(last->sides.front().image.width, 400);
  const std::scoped_lock lock(mutex_);
  ASSERT_EQ(asked_.size(), 4u);
  EXPECT_LE(asked_[0].height, 300);
  EXPECT_EQ(asked_[0].aa, 1);
  EXPECT_EQ(asked_[1].height, 300);
  EXPECT_EQ(asked_[1].samples, 0);
  EXPECT_EQ(asked_[2].aa, 1);
  EXPECT_EQ(asked_[2].samples, 4);
  EXPECT_EQ(asked_[3].aa, 2);
  EXPECT_EQ(asked_[3].samples, 4);
  EXPECT_GE(ready_, 1);
}

TEST_F(Worker, SidesHaveTheirOwnSizes) {
  const auto worker = make();
  ViewRequest both = request(false, 1, 0);
  std::vector<dvec2> cameras;  // accessed only by the worker thread until it converges
  PictureSettings large;
  large.look = Look::comanche;
  large.width = 40, large.height = 30, large.aa = 1;
  both.sides.push_back({large, [&](const Camera& camera, const PictureSettings& asked, const Progress&) {
                          cameras.push_back(camera.size());
                          return Picture{Image(asked.width, asked.height)};
                        }});
  worker->request(std::move(both));
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  EXPECT_TRUE(last->large_pixels);
  EXPECT_EQ(last->sides[0].image.width, 400);
  EXPECT_EQ(last->sides[1].image.width, 40);
  EXPECT_EQ(last->sides[1].image.height, 30);
  ASSERT_EQ(cameras.size(), 2u);
  for (const dvec2& size : cameras) EXPECT_TRUE(size.x == 40 && size.y == 30) << size.x << ' ' << size.y;
}

TEST_F(Worker, SkipsIdenticalPasses) {
  const auto worker = make();
  worker->request(request(false, 1, 0));
  ASSERT_TRUE(converged(*worker));
  const std::scoped_lock lock(mutex_);
  EXPECT_EQ(asked_.size(), 2u);
}

// Rays of a picture: each sample has one, plus the requested numbers to the sun and to the sky.
double cost_of(const PictureSettings& settings) { return settings.aa * settings.aa * (1 + 2.0 * settings.samples); }

TEST_F(Worker, EarlierPassesAddAboutAThirdOfTheCost) {
  for (const auto& [aa, samples] : {std::pair{1, 0}, {2, 0}, {4, 64}, {3, 5}, {16, 0}, {1, 4096}}) {
    PictureSettings settings;
    settings.aa = aa, settings.samples = samples;
    const std::vector<PictureSettings> passes = PictureWorker::refinement_of(settings);
    EXPECT_EQ(cost_of(passes.front()), 1) << aa << ' ' << samples;
    EXPECT_EQ(passes.back().aa, aa);
    EXPECT_EQ(passes.back().samples, samples);
    double before_the_last = 0;
    for (std::size_t i = 0; i + 1 < passes.size(); ++i) {
      before_the_last += cost_of(passes[i]);
      EXPECT_GT(cost_of(passes[i + 1]), 3 * cost_of(passes[i]));
    }
    // For 4^k samples: 1 + sum(1 + 2 * 4^j, j = 1..k-1) = (1 + 2 * 4^k) / 3 + k - 3.
    EXPECT_LE(before_the_last, cost_of(passes.back()) / 3 + 3) << aa << ' ' << samples;
  }
  PictureSettings counted;
  counted.look = Look::steps, counted.aa = 4, counted.samples = 64;
  EXPECT_EQ(PictureWorker::refinement_of(counted).size(), 1u);
}

TEST_F(Worker, CompletesBothSides) {
  ViewRequest both = request(false, 4, 16);
  PictureSettings counted = both.sides.front().settings;
  counted.look = Look::steps;
  both.sides.push_back(side(counted));
  const auto worker = make();
  worker->request(both);
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->sides.size(), 2u);
  const std::scoped_lock lock(mutex_);
  // Moving: both. At rest: (1, 0), the step-count side once, (1, 4), (1, 16), (2, 16), (4, 16).
  ASSERT_EQ(asked_.size(), 8u);
  EXPECT_EQ(asked_[3].samples, 16);
  EXPECT_EQ(asked_[5].samples, 16);
  EXPECT_EQ(asked_[7].aa, 4);
  EXPECT_EQ(asked_[7].samples, 16);
}

TEST_F(Worker, JudgesTheCompletePicture) {
  ViewRequest judged = request(false);
  judged.sides.front().judge = [](const Camera& camera, const Progress& progress) -> std::optional<JudgedRays> {
    if (!progress(0)) throw Interrupted();
    JudgedRays rays;
    rays.mean_steps = camera.size().x;
    return rays;
  };
  const auto worker = make();
  const auto generation = worker->request(judged);
  ASSERT_TRUE(converged(*worker));
  while (worker->busy()) std::this_thread::sleep_for(1ms);
  const auto verdict = worker->take_verdict();
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->generation, generation);
  ASSERT_TRUE(verdict->sides.at(0));
  EXPECT_EQ(verdict->sides[0]->mean_steps, 400);
  EXPECT_FALSE(worker->take_verdict());
  // No verdicts while the view moves.
  judged.moving = true;
  worker->request(judged);
  ASSERT_TRUE(next(*worker));
  while (worker->busy()) std::this_thread::sleep_for(1ms);
  EXPECT_FALSE(worker->take_verdict());
}

TEST_F(Worker, RendersOnlyTheFirstPassWhileMoving) {
  const auto worker = make();
  worker->request(request(true));
  const auto worked = next(*worker);
  ASSERT_TRUE(worked);
  EXPECT_EQ(worked->pass, PicturePass::moving);
  std::this_thread::sleep_for(30ms);
  EXPECT_FALSE(worker->busy());
  EXPECT_FALSE(worker->take());
}

TEST_F(Worker, NewerRequestCancelsTheOlderOne) {
  render_time_ = 20s;  // the second pass would take that long
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

TEST_F(Worker, ReportsErrorsAndContinues) {
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

// A first pass of 283 rows, by the assumed rate, is followed by a quarter, half and all of 1,200.
TEST_F(Worker, ResolutionGrowsInSteps) {
  ViewRequest large = request(false, 1, 0);
  PictureSettings& settings = large.sides.front().settings;
  settings.width = 1600, settings.height = 1200;
  const auto worker = make();
  worker->request(large);
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->side_seconds.size(), 1u);
  const std::scoped_lock lock(mutex_);
  ASSERT_EQ(asked_.size(), 4u);
  EXPECT_LT(asked_[0].height, 300);
  EXPECT_EQ(asked_[1].height, 300);
  EXPECT_EQ(asked_[1].width, 400);
  EXPECT_EQ(asked_[2].height, 600);
  EXPECT_EQ(asked_[3].height, 1200);
}

// A view that stays gets no second first pass: it might be coarser than what is shown.
TEST_F(Worker, ResolutionNeverFalls) {
  render_time_ = 40ms;  // a slow first pass: a second one would have fewer rows
  ViewRequest large = request(true, 1, 0);
  PictureSettings& settings = large.sides.front().settings;
  settings.width = 1600, settings.height = 1200;
  const auto worker = make();
  worker->request(large);
  ASSERT_TRUE(next(*worker));
  while (worker->busy()) std::this_thread::sleep_for(1ms);
  large.moving = false, large.stays = true;
  worker->request(large);
  ASSERT_TRUE(converged(*worker));
  {
    const std::scoped_lock lock(mutex_);
    for (std::size_t i = 1; i < asked_.size(); ++i) EXPECT_GT(asked_[i].height, asked_[i - 1].height) << i;
    EXPECT_EQ(asked_.back().height, 1200);
    asked_.clear();
  }
  // Without a first pass of the request before, it is rendered.
  fails_ = true;
  worker->request(large);
  ASSERT_TRUE(next(*worker));
  fails_ = false;
  while (worker->busy()) std::this_thread::sleep_for(1ms);
  const std::scoped_lock lock(mutex_);
  ASSERT_FALSE(asked_.empty());
  EXPECT_LT(asked_.front().height, 300);
}

TEST_F(Worker, MeasuresTheTimeOfEachSide) {
  ViewRequest both = request(false, 1, 0);
  both.sides.push_back(both.sides.front());
  both.sides.back().render = [](const Camera&, const PictureSettings& asked, const Progress&) {
    std::this_thread::sleep_for(30ms);
    return Picture{Image(asked.width, asked.height)};
  };
  const auto worker = make();
  worker->request(both);
  const auto last = converged(*worker);
  ASSERT_TRUE(last);
  ASSERT_EQ(last->side_seconds.size(), 2u);
  EXPECT_GE(last->side_seconds[1], 0.03);
  EXPECT_GE(last->seconds, last->side_seconds[0] + last->side_seconds[1]);
}

TEST_F(Worker, StopsWhileRendering) {
  render_time_ = 20s;
  const auto begin = std::chrono::steady_clock::now();
  {
    const auto worker = make();
    worker->request(request(false));
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
}

TEST_F(Worker, HandlesThousandsOfRequests) {
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
  const int rows = PictureWorker::rows_for(8e6, 1280, 720);
  EXPECT_NEAR(rows * rows * 1280.0 / 720 * 30, 0.8 * 8e6, 0.05 * 8e6);
}

}  // namespace
}  // namespace scarp::viewer
