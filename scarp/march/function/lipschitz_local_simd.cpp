// SPDX-License-Identifier: MIT
#include "scarp/march/function/lipschitz_local_simd.h"

#include <array>
#include <cstddef>
#include <vector>

#include "scarp/march/function/lipschitz_local.h"
#include "scarp/march/function/lipschitz_local_walk.h"
#include "scarp/march/usual_ray.h"

// Compiled once per instruction set. Vectors whose length is unknown at compile time cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/function/lipschitz_local_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/march/function/function_simd_taylor.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t kWalks = 6 * N;  // in progress at once

// The queries of one vector, from N walks; the last ones may be repeated.
struct Asked {
  alignas(64) double ox[N], oy[N], dx[N], dy[N], t0[N], t1[N];

  void put(std::size_t lane, const LocalWalk& walk) {
    const Ray& ray = walk.ray();
    ox[lane] = ray.origin.x, oy[lane] = ray.origin.y, dx[lane] = ray.direction.x, dy[lane] = ray.direction.y;
    t0[lane] = walk.t0(), t1[lane] = walk.t1();
  }
};

// As coordinate() in height_function.cpp.
HWY_INLINE VT coordinate(V origin, V direction, V t0, V t1) {
  VT t;
  const V middle = scaled(0.5, hn::Add(t0, t1)), half = scaled(0.5, hn::Sub(t1, t0));
  const V rounding = scaled(kSlack, hn::Add(vabs(origin), hn::Mul(vabs(direction), vmax(vabs(t0), vabs(t1)))));
  t.mid = hn::Add(origin, hn::Mul(direction, middle));
  t.slope = hn::Mul(direction, half);
  t.rest = rounding;
  t.low = hn::Sub(hn::Sub(t.mid, vabs(t.slope)), rounding);
  t.high = hn::Add(hn::Add(t.mid, vabs(t.slope)), rounding);
  t.error = rounding;
  return t;
}

class Answers {
 public:
  Answers(const FunctionProgram& program) : program_(program) {}

  void bounds(const Asked& asked, SegmentBound* out) const {
    const V t0 = hn::Load(dd, asked.t0), t1 = hn::Load(dd, asked.t1);
    const VT x = coordinate(hn::Load(dd, asked.ox), hn::Load(dd, asked.dx), t0, t1);
    const VT y = coordinate(hn::Load(dd, asked.oy), hn::Load(dd, asked.dy), t0, t1);
    const Spilled<VT> h(run(directions_, program_, x, y));
    for (std::size_t i = 0; i < N; ++i) out[i] = {h.mid[i], h.slope[i], h.rest[i], h.low[i], h.high[i], h.error[i]};
  }
  void gains(const Asked& asked, dvec2* out) const {
    const V t0 = hn::Load(dd, asked.t0), t1 = hn::Load(dd, asked.t1);
    const V dx = hn::Load(dd, asked.dx), dy = hn::Load(dd, asked.dy);
    const VJ x{coordinate(hn::Load(dd, asked.ox), dx, t0, t1), constant_model(dx)};
    const VJ y{coordinate(hn::Load(dd, asked.oy), dy, t0, t1), constant_model(dy)};
    const Spilled<VT> h(run(directions_, program_, x, y).d);
    for (std::size_t i = 0; i < N; ++i) out[i] = {h.low[i], h.high[i]};
  }
  void heights(const Asked& asked, double* out) const {
    const V t = hn::Load(dd, asked.t0);
    const V x = hn::Add(hn::Load(dd, asked.ox), hn::Mul(hn::Load(dd, asked.dx), t));
    const V y = hn::Add(hn::Load(dd, asked.oy), hn::Mul(hn::Load(dd, asked.dy), t));
    hn::StoreU(run(directions_, program_, x, y), dd, out);
  }

 private:
  const FunctionProgram& program_;
  Directions directions_;
};

class Walks {
 public:
  Walks(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits, const MarchSettings& settings,
        std::span<std::uint32_t> steps, FunctionUse use)
      : function_(function),
        rays_(rays),
        hits_(hits),
        settings_(settings),
        steps_(steps),
        use_(use),
        answers_(function.program(use)) {}

  void run() {
    while (take() > 0) {
      // Queries that fill a vector; if there are not enough, all remaining ones.
      bool full = false;
      for (auto& asking : asking_) asking.clear();
      for (std::size_t w = 0; w < count_; ++w) {
        auto& asking = asking_[static_cast<std::size_t>(walks_[w].question())];
        asking.push_back(w);
        full = full || asking.size() >= N;
      }
      for (std::size_t question = 0; question < kQuestions; ++question) {
        const auto& asking = asking_[question];
        for (std::size_t first = 0; first < asking.size(); first += N) {
          const std::size_t count = std::min(N, asking.size() - first);
          if (count < N && full) break;
          answer(static_cast<LocalWalk::Question>(question), &asking[first], count);
        }
      }
    }
  }

 private:
  static constexpr std::size_t kQuestions = static_cast<std::size_t>(LocalWalk::Question::done);

  // Stores finished walks and starts new ones in their place; returns how many are in progress.
  std::size_t take() {
    for (std::size_t w = 0; w < count_ || (w < kWalks && next_ < rays_.size());) {
      if (w == count_) {
        ++count_;
      } else if (walks_[w].question() == LocalWalk::Question::done) {
        put_away(w);
      } else {
        ++w;
        continue;
      }
      if (next_ < rays_.size()) {
        ray_[w] = next_;
        walks_[w] = LocalWalk(function_, rays_[next_++], use_, settings_);
      } else {
        --count_;
        if (w < count_) walks_[w] = walks_[count_], ray_[w] = ray_[count_];
      }
    }
    return count_;
  }
  void put_away(std::size_t w) {
    hits_[ray_[w]] = walks_[w].hit();
    if (!steps_.empty()) steps_[ray_[w]] = walks_[w].stats().steps + walks_[w].stats().cell_tests;
  }

  void answer(LocalWalk::Question question, const std::size_t* asking, std::size_t count) {
    Asked asked;
    for (std::size_t lane = 0; lane < N; ++lane) asked.put(lane, walks_[asking[std::min(lane, count - 1)]]);
    if (question == LocalWalk::Question::bound) {
      SegmentBound bounds[N];
      answers_.bounds(asked, bounds);
      for (std::size_t lane = 0; lane < count; ++lane) walks_[asking[lane]].answer(bounds[lane]);
    } else if (question == LocalWalk::Question::gain) {
      dvec2 gains[N];
      answers_.gains(asked, gains);
      for (std::size_t lane = 0; lane < count; ++lane) walks_[asking[lane]].answer_gain(gains[lane]);
    } else {
      double heights[N];
      answers_.heights(asked, heights);
      for (std::size_t lane = 0; lane < count; ++lane) walks_[asking[lane]].answer_height(heights[lane]);
    }
  }

  const HeightFunction& function_;
  std::span<const Ray> rays_;
  std::span<Hit> hits_;
  const MarchSettings& settings_;
  std::span<std::uint32_t> steps_;
  FunctionUse use_;
  Answers answers_;
  std::size_t next_ = 0, count_ = 0;
  std::array<LocalWalk, kWalks> walks_;
  std::array<std::size_t, kWalks> ray_;
  std::array<std::vector<std::size_t>, kQuestions + 1> asking_;
};

void walk(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits, const MarchSettings& settings,
          std::span<std::uint32_t> steps, FunctionUse use) {
  Walks(function, rays, hits, settings, steps, use).run();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(walk);

}  // namespace

void closest_hits_lipschitz_local_simd(const HeightFunction& function, std::span<const Ray> rays, std::span<Hit> hits,
                                       const MarchSettings& settings, std::span<std::uint32_t> steps, FunctionUse use) {
  HWY_DYNAMIC_DISPATCH(walk)(function, rays, hits, settings, steps, use);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (is_usual(longest_of(rays[i].direction))) [[likely]]
      continue;
    MarchStats stats;
    hits[i] = march_lipschitz_local(function, rays[i], settings, &stats, use);
    if (!steps.empty()) steps[i] = stats.steps + stats.cell_tests;
  }
}

}  // namespace scarp
#endif
