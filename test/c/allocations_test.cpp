// SPDX-License-Identifier: MIT
// Single queries of the C interface do not allocate, and what the library allocates comes from the `new` of the program
// that loads it, as doc/library/c.md says.
#include "allocations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "scarp/scarp_c.h"

namespace {

std::size_t bytes_of_new = 0;

void* memory_of(std::size_t size, std::size_t alignment) {
  bytes_of_new += size;
  void* memory = alignment ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                           : std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

// The other forms of `new` call these. Batches, which run on other threads, are not part of this test.
void* operator new(std::size_t size) { return memory_of(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return memory_of(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace {

constexpr int kSide = 65;

class CAllocations : public testing::Test {
 protected:
  CAllocations() {
    const scarp_threads own{sizeof own,
                            [](void*, std::int64_t pieces, void (*piece)(void*, std::int64_t), void* context) {
                              for (std::int64_t i = 0; i < pieces; ++i) piece(context, i);
                            },
                            nullptr};
    EXPECT_EQ(scarp_use_threads(&own), SCARP_OK);
    for (int i = 0; i < kSide * kSide; ++i)
      samples_.push_back(static_cast<float>(20 + 8 * std::sin(i % kSide / 3.0) * std::cos(i / kSide / 4.0)));
    scarp_heights heights{};
    heights.struct_size = sizeof heights;
    heights.samples = samples_.data();
    heights.cols = heights.rows = kSide;
    EXPECT_EQ(scarp_heights_copy(&heights, &ground_), SCARP_OK) << scarp_last_error();
    for (std::size_t i = 0; i < indices_.size(); ++i) indices_[i] = i % 29 == 0;
    scarp_voxels voxels{};
    voxels.struct_size = sizeof voxels;
    voxels.indices = indices_.data();
    voxels.side = 4;
    voxels.size[0] = voxels.size[1] = voxels.size[2] = 16;
    EXPECT_EQ(scarp_voxels_copy(&voxels, &voxels_), SCARP_OK) << scarp_last_error();
    scarp_part parts[2] = {};
    parts[0].scene = ground_, parts[1].scene = voxels_;
    parts[1].origin[2] = 20;
    EXPECT_EQ(scarp_scene_combine(parts, 2, &both_), SCARP_OK) << scarp_last_error();
  }
  ~CAllocations() override {
    for (scarp_scene* scene : {ground_, voxels_, both_}) scarp_scene_release(scene);
    scarp_use_threads(nullptr);
  }

  std::vector<float> samples_;
  std::vector<std::uint8_t> indices_ = std::vector<std::uint8_t>(16 * 16 * 16);
  scarp_scene *ground_ = nullptr, *voxels_ = nullptr, *both_ = nullptr;
};

double place(int i) { return 1 + i * 7919 % 600 * 0.1; }

// Single queries; heights_at of one point is a batch of one.
int query(const scarp_scene* scene, int i) {
  const scarp_ray ray{{place(i), place(3 * i + 1), 45}, {std::cos(i), std::sin(i), i % 3 == 0 ? -1.0 : -0.2}, 0, 300};
  scarp_hit hit{};
  scarp_surface surface{};
  surface.struct_size = sizeof surface;
  scarp_contact contact{};
  std::uint8_t yes = 0;
  const double half[3] = {1, 1, 2}, down[3] = {0, 0, -40}, x = place(i), y = place(i + 1);
  double height = 0;
  EXPECT_EQ(scarp_cast(scene, &ray, nullptr, &hit), SCARP_OK);
  EXPECT_EQ(scarp_occluded(scene, &ray, nullptr, &yes), SCARP_OK);
  if (hit.status == SCARP_HIT) {
    const scarp_ray up{{place(i), place(i), 20}, {0.3, 0.1, 1}, 0, 300};
    EXPECT_EQ(scarp_cast(scene, &up, &hit, &hit), SCARP_OK);
    EXPECT_EQ(scarp_cast(scene, &ray, nullptr, &hit), SCARP_OK);
    EXPECT_EQ(scarp_surface_at(scene, &ray, &hit, &surface), SCARP_OK);
  }
  EXPECT_EQ(scarp_sweep(scene, ray.origin, ray.origin, 0.5, down, ~0u, &contact), SCARP_OK);
  const int touched = contact.found ? 1 : 0;
  EXPECT_EQ(scarp_overlaps(scene, ray.origin, half, nullptr, ~0u, &yes), SCARP_OK);
  EXPECT_EQ(scarp_closest_point(scene, ray.origin, 100, ~0u, &contact), SCARP_OK);
  EXPECT_EQ(scarp_heights_at(scene, &x, &y, &height, 1), SCARP_OK);
  return touched + hit.status;
}

TEST_F(CAllocations, SingleQueriesDoNotAllocate) {
  for (const scarp_scene* scene : {ground_, voxels_, both_}) {
    int answers = 0;
    const auto all = [&] {
      for (int i = 0; i < 200; ++i) answers += query(scene, i);
    };
    all();
    EXPECT_EQ(scarp::test::allocations_of(all), 0) << (scene == ground_ ? "heights" : "voxels");
    EXPECT_GT(answers, 50);
  }
}

TEST_F(CAllocations, MemoryComesFromTheProgram) {
  scarp_heights heights{};
  heights.struct_size = sizeof heights;
  heights.samples = samples_.data();
  heights.cols = heights.rows = kSide;
  scarp_scene* scene = nullptr;
  const std::size_t before = bytes_of_new;
  ASSERT_EQ(scarp_heights_copy(&heights, &scene), SCARP_OK);
  EXPECT_GT(bytes_of_new - before, samples_.size() * sizeof(float));
  scarp_scene_release(scene);
}

}  // namespace
