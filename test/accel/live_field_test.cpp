// SPDX-License-Identifier: MIT
// Edits during queries: every batch sees one epoch, and neither side waits for ever. Also run under the thread
// sanitizer.
#include "scarp/accel/live_field.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "cases.h"
#include "scarp/base/error.h"
#include "scarp/march/height/queries.h"

namespace scarp {
namespace {

constexpr int kSide = 65;
constexpr SampleRect kRect{8, 16, 40, 30};
const int kRays = test::cases(1500, 1500, 300);

template <class T>
std::vector<T> ground(int phase, int side) {
  std::vector<T> samples;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) samples.push_back(static_cast<T>((col * 7 + row * 13 + 50 * phase) % 90));
  }
  return samples;
}

template <class T>
std::vector<T> cut(const std::vector<T>& samples, const SampleRect& rect) {
  std::vector<T> part;
  for (int row = 0; row < rect.rows; ++row) {
    for (int col = 0; col < rect.cols; ++col)
      part.push_back(samples[static_cast<std::size_t>((rect.row + row) * kSide + rect.col + col)]);
  }
  return part;
}

std::vector<Ray> rays() {
  std::vector<Ray> all;
  for (int i = 0; i < kRays; ++i) {
    Ray ray;
    ray.origin = {std::fmod(i * 0.37, kSide), std::fmod(i * 0.73, kSide), 100};
    ray.direction = {std::sin(i) * 0.7, std::cos(i) * 0.7, -0.4 - (i % 5)};
    all.push_back(ray);
  }
  return all;
}

bool equal(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].status != b[i].status || a[i].t != b[i].t || !(a[i].cell == b[i].cell)) return false;
  }
  return true;
}

std::vector<Hit> answers(const HeightField& field, const MaxPyramid& pyramid, const std::vector<Ray>& asked) {
  std::vector<Hit> hits(asked.size());
  closest_hits({&field, &pyramid}, asked, hits);
  return hits;
}

template <class T>
void expect_whole_epochs() {
  // Two states that differ in a rectangle; edits alternate between them.
  const auto even = ground<T>(0, kSide);
  auto odd = even;
  const auto other = cut(ground<T>(1, kSide), kRect), one = cut(even, kRect);
  for (int row = 0; row < kRect.rows; ++row) {
    for (int col = 0; col < kRect.cols; ++col) {
      odd[static_cast<std::size_t>((kRect.row + row) * kSide + kRect.col + col)] =
          other[static_cast<std::size_t>(row * kRect.cols + col)];
    }
  }
  const std::vector<Ray> asked = rays();
  std::vector<Hit> expected[2];
  for (int phase = 0; phase < 2; ++phase) {
    const HeightField field = HeightField::own(phase ? odd : even, kSide, kSide);
    expected[phase] = answers(field, MaxPyramid(field), asked);
  }
  ASSERT_FALSE(equal(expected[0], expected[1]));

  LiveField live(HeightField::own(even, kSide, kSide));
  constexpr int kReaders = 2, kBatches = 40, kEdits = 40;
  std::atomic<int> torn{0}, backwards{0};
  std::vector<std::thread> threads;
  for (int reader = 0; reader < kReaders; ++reader) {
    threads.emplace_back([&] {
      std::uint64_t last = 0;
      for (int i = 0; i < kBatches; ++i) {
        const auto reading = live.read();
        backwards += reading.epoch() < last;
        last = reading.epoch();
        torn += !equal(answers(reading.field(), reading.pyramid(), asked), expected[last % 2]);
      }
    });
  }
  // That the test ends proves that nothing starves: readers never pause, and the number of edits is fixed.
  for (int i = 0; i < kEdits; ++i) {
    EXPECT_EQ(live.edit(kRect, (i % 2 ? one : other).data(), kRect.cols), static_cast<std::uint64_t>(i + 1));
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(backwards, 0);
  const auto reading = live.read();
  EXPECT_EQ(reading.epoch(), static_cast<std::uint64_t>(kEdits));
  EXPECT_TRUE(equal(answers(reading.field(), reading.pyramid(), asked), expected[kEdits % 2]));
}

TEST(LiveField, EveryBatchSeesOneEpoch) {
  expect_whole_epochs<float>();
  expect_whole_epochs<std::int16_t>();
}

TEST(LiveField, EditIsNotStarvedByReaders) {
  LiveField live(HeightField::own(ground<float>(0, kSide), kSide, kSide));
  std::atomic<bool> done{false};
  std::vector<std::thread> readers;
  // At any time one of the readers holds a reading: without a turnstile the edit would never get its turn.
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      while (!done) {
        const auto reading = live.read();
        std::this_thread::yield();
      }
    });
  }
  const float sample = 5;
  for (int i = 0; i < 20; ++i) live.edit({3, 4, 1, 1}, &sample, 1);
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(live.read().epoch(), 20u);
}

TEST(LiveField, RejectedEditChangesNothing) {
  LiveField live(HeightField::own(ground<float>(0, kSide), kSide, kSide));
  const double before = live.read().field().cell_heights({3, 4})->h00;
  const float bad = HUGE_VALF;
  const std::int16_t wrong_type = 3;
  EXPECT_THROW(live.edit({3, 4, 1, 1}, &bad, 1), Error);
  EXPECT_THROW(live.edit({3, 4, 1, 1}, &wrong_type, 1), Error);
  EXPECT_THROW(live.edit({kSide, 0, 1, 1}, &bad, 1), Error);
  EXPECT_EQ(live.read().field().cell_heights({3, 4})->h00, before);
  EXPECT_EQ(live.read().epoch(), 0u);
}

}  // namespace
}  // namespace scarp
