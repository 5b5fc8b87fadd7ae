// SPDX-License-Identifier: MIT
// Buffers, copies, passes, barriers and timestamps, on a real device.
#include <cstring>
#include <numeric>
#include <vector>

#include "base/refusal.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"
#include "test/vk/device_under_test.h"
#include "test/vk/twice.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kTwice[] = {
#include "test/vk/twice.comp.inc"
};
constexpr std::uint32_t kThreads = 64;

using Words = std::vector<std::uint32_t>;

Words numbers(std::size_t count, std::uint32_t first = 1) {
  Words words(count);
  std::iota(words.begin(), words.end(), first);
  return words;
}

Words read(const DeviceBuffer& buffer) {
  Words words(buffer.bytes() / 4);
  download(buffer, 0, words.data(), buffer.bytes());
  return words;
}

using test::refusal;

class Compute : public test::OnDevice {
 protected:
  ComputePipeline twice(std::uint32_t bonus = 0) {
    const std::uint32_t constants[] = {kThreads, bonus};
    return {device(), kTwice, "twice", sizeof(glsl::TwicePush), constants};
  }
};

TEST_F(Compute, RunsAPass) {
  const Words words = numbers(1000);
  DeviceBuffer from(device(), 4 * words.size(), "from"), to(device(), 4 * words.size(), "to");
  EXPECT_EQ(from.address() % 16, 0u);
  upload(from, 0, words.data(), from.bytes());
  const ComputePipeline pipeline = twice(7);
  Commands commands(device());
  commands.dispatch(pipeline, glsl::TwicePush{from.address(), to.address(), 1000, 1}, {16, 1, 1});
  commands.run();
  const Words result = read(to);
  for (std::size_t i = 0; i < words.size(); ++i) ASSERT_EQ(result[i], 7 + glsl::twice(words[i])) << i;
  ASSERT_EQ(commands.passes().size(), 1u);
  EXPECT_EQ(commands.passes()[0].name, "twice");
  EXPECT_EQ(commands.passes()[0].nanoseconds.has_value(), device().description().abilities.timestamps);
}

TEST_F(Compute, BarriersOrderPasses) {
  DeviceBuffer a(device(), 4 * 300, "a"), b(device(), 4 * 300, "b");
  const ComputePipeline pipeline = twice();
  Commands commands(device());
  for (int again = 0; again < 3; ++again) {
    commands.fill(a, 0, a.bytes(), 5);
    for (int i = 0; i < 3; ++i) {
      commands.barrier();
      commands.dispatch(pipeline, glsl::TwicePush{a.address(), b.address(), 300, 1}, {5, 1, 1});
      commands.barrier();
      commands.dispatch(pipeline, glsl::TwicePush{b.address(), a.address(), 300, 1}, {5, 1, 1});
    }
    commands.run();
    EXPECT_EQ(read(a), Words(300, 5 << 6));
    ASSERT_EQ(commands.passes().size(), 6u);
  }
}

TEST_F(Compute, RunDeliversItsReads) {
  const Words words = numbers(64);
  DeviceBuffer from(device(), 4 * words.size(), "from"), to(device(), 4 * words.size(), "to");
  upload(from, 0, words.data(), from.bytes());
  const ComputePipeline pipeline = twice();
  Commands commands(device());
  for (const std::uint32_t count : {64u, 32u}) {
    std::uint32_t first = 0, others[2] = {};
    commands.fill(to, 0, to.bytes(), 3);
    commands.barrier();
    commands.dispatch(pipeline, glsl::TwicePush{from.address(), to.address(), count, 1}, {1, 1, 1});
    commands.barrier();
    commands.read(to, 0, 4, &first);
    commands.read(to, 4 * 40, 8, others);
    EXPECT_EQ(first, 0u);
    commands.run();
    EXPECT_EQ(first, glsl::twice(words[0]));
    EXPECT_EQ(others[1], count == 64 ? glsl::twice(words[41]) : 3u);
  }
}

TEST_F(Compute, CopiesMoreThanTheRingHolds) {
  // Slightly more than three pieces of the ring, at an offset.
  const Words words = numbers((48 << 18) + 12345);
  DeviceBuffer buffer(device(), 4 * (words.size() + 3), "large");
  upload(buffer, 12, words.data(), 4 * words.size());
  Words back(words.size());
  download(buffer, 12, back.data(), 4 * back.size());
  EXPECT_TRUE(back == words);
}

TEST_F(Compute, CopiesRowsIntoPlace) {
  DeviceBuffer buffer(device(), 4 * 100, "rows");
  const Words nothing(100, 0);
  upload(buffer, 0, nothing.data(), buffer.bytes());
  const Words words = numbers(12);
  upload_rows(buffer, {.offset = 4 * 11, .row_bytes = 4 * 3, .rows = 4, .stride = 4 * 10},
              [&](std::span<std::byte> piece, std::uint64_t first) {
                std::memcpy(piece.data(), reinterpret_cast<const std::byte*>(words.data()) + first, piece.size());
              });
  Words expected(100, 0);
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 3; ++c) expected[11 + 10 * r + c] = words[3 * r + c];
  }
  EXPECT_EQ(read(buffer), expected);
}

TEST_F(Compute, RejectsRangesOutOfBounds) {
  DeviceBuffer buffer(device(), 400, "small");
  std::uint32_t words[200] = {};
  for (const auto& range : std::vector<std::pair<std::uint64_t, std::uint64_t>>{
           {0, 404}, {400, 4}, {2, 4}, {0, 3}, {404, 0}, {~3ull, 8}, {8, ~3ull}}) {
    const std::uint64_t offset = range.first, bytes = range.second;
    // An empty write is valid anywhere.
    EXPECT_EQ(refusal([&] { upload(buffer, offset, words, bytes); }).empty(), bytes == 0);
    EXPECT_NE(refusal([&] { download(buffer, offset, words, bytes); }), "");
  }
  const auto no_fill = [](std::span<std::byte>, std::uint64_t) { FAIL(); };
  EXPECT_NE(refusal([&] { upload_rows(buffer, {.offset = 4, .row_bytes = 100, .rows = 4, .stride = 100}, no_fill); }),
            "");
  EXPECT_NE(refusal([&] {
              upload_rows(buffer, {.offset = 0, .row_bytes = 100, .rows = 1ull << 62, .stride = 100}, no_fill);
            }),
            "");
  EXPECT_NE(refusal([&] { upload_rows(buffer, {.row_bytes = 100, .rows = 2, .stride = 96}, no_fill); }), "");
  const ComputePipeline pipeline = twice();
  Commands commands(device());
  EXPECT_EQ(refusal([&] {
              commands.dispatch(pipeline, std::uint32_t{3}, {1, 1, 1});
            }),
            "shader 'twice': 4 bytes of push constants instead of 24");
  EXPECT_EQ(refusal([&] {
              commands.dispatch(pipeline, glsl::TwicePush{}, {70000, 1, 1});
            }),
            "shader 'twice': 70000 workgroups along one side (1 to 65535 allowed)");
  EXPECT_NE(refusal([&] { commands.read(buffer, 2, 4, words); }), "");
  EXPECT_NE(refusal([&] { commands.read(buffer, 396, 8, words); }), "");
  EXPECT_EQ(refusal([&] {
              commands.read(buffer, 0, 200, words);
              commands.read(buffer, 200, 60, words + 50);
            }),
            "device buffer 'small': reading bytes 200 to 260 of 400 (must be multiples of 4 within the buffer, at most "
            "256 in a run)");
  EXPECT_EQ(refusal([&] { ComputePipeline(device(), kTwice, "twice", 132); }),
            "shader 'twice': 132 bytes of push constants (must be a multiple of 4, at most 128)");
}

}  // namespace
}  // namespace scarp
