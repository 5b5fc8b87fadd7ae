// SPDX-License-Identifier: MIT
// Use in an engine: rays as arrays of floats, on the engine's own threads.
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include "scarp/base/executor.h"
#include "scarp/scarp.h"
#include "scarp/scene/ray_arrays.h"

namespace {

// Stands in for the engine's job system: runs jobs by index and waits until all have finished.
class Jobs final : public scarp::Executor {
 public:
  void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
    ++loops;
    std::atomic<std::int64_t> next{0};
    const auto work = [&] {
      for (std::int64_t i = next++; i < pieces; i = next++) piece(i);
    };
    std::thread other(work);
    work();
    other.join();
  }
  int loops = 0;
};

}  // namespace

int main() {
  // A plain of 1 km x 1 km at height 0 with a ridge of 100 m across.
  const int side = 101;
  std::vector<float> heights(side * side);
  for (int row = 0; row < side; ++row) heights[static_cast<std::size_t>(row * side + 50)] = 100;
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = 10, .cell_y = 10});

  // A scanner 50 m above the west end: rays in all directions below the horizon.
  const std::size_t count = 100'000;
  const std::vector<float> x(count, 5.0f), y(count, 500.0f), z(count, 50.0f);
  std::vector<float> dx(count), dy(count), dz(count), t(count);
  for (std::size_t i = 0; i < count; ++i) {
    dx[i] = 1;
    dy[i] = 0.0002f * static_cast<float>(i % 1000) - 0.1f;
    dz[i] = -0.002f * static_cast<float>(i / 1000);
  }
  Jobs jobs;
  const scarp::ExecutorScope scope(jobs);
  scarp::cast(terrain, scarp::RayArrays{x, y, z, dx, dy, dz}, {.t = t});
  int ridge = 0;
  for (std::size_t i = 0; i < count; ++i) ridge += t[i] > 480 && t[i] < 500;
  std::printf("%d of %zu rays hit the ridge; on threads of our own: %s\n", ridge, count, jobs.loops > 0 ? "yes" : "no");
  return 0;
}
