// SPDX-License-Identifier: MIT
// The pyramid built by a device is the CPU's, bit for bit, and shaders read the samples of the field.
#include "scarp/accel/device_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "scarp/accel/code_tables.h"
#include "scarp/accel/height_encode.h"
#include "scarp/accel/max_pyramid.glsl.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/march/height/queries_vk.h"
#include "test/march/height/rounding_judge.h"
#include "test/vk/device_under_test.h"

namespace scarp {
namespace {

constexpr std::uint32_t kProbe[] = {
#include "test/accel/ground_probe.comp.inc"
};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Interleaved as on the device.
std::vector<std::uint32_t> entries_of(const MaxPyramid& pyramid) {
  std::vector<std::uint32_t> entries(pyramid.entries());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i] = pyramid.maximum_code(static_cast<std::ptrdiff_t>(i)) | std::uint32_t{pyramid.minima()[i]} << 16;
  }
  return entries;
}

template <class T>
std::vector<T> noise(int cols, int rows, double scale = 1, double base = 0, unsigned seed = 7) {
  std::mt19937 random(seed);
  std::vector<T> samples(static_cast<std::size_t>(cols) * rows);
  for (T& s : samples) s = static_cast<T>(base + scale * static_cast<double>(random() % 60000));
  return samples;
}

template <class T>
void share_border(std::vector<T>& samples, int cols, int rows) {
  const auto at = [&](int col, int row) -> T& { return samples[static_cast<std::size_t>(row) * cols + col]; };
  for (int row = 0; row < rows; ++row) at(cols - 1, row) = at(0, row);
  for (int col = 0; col < cols; ++col) at(col, rows - 1) = at(col, 0);
}

template <class T>
void dig_holes(std::vector<T>& samples, T nodata) {
  std::mt19937 random(11);
  for (std::size_t i = 0; i < samples.size() / 9 + 1; ++i) {
    T& sample = samples[random() % samples.size()];
    sample = std::is_floating_point_v<T> && i % 2 ? static_cast<T>(kNan) : nodata;
  }
}

const std::vector<std::pair<int, int>> kSizes{
    {2, 2},   {1, 1},  {3, 3},   {1, 7},  {9, 1},    {2, 9},     {4, 4},    {5, 17},   {16, 16},  {17, 17},  {64, 64},
    {65, 65}, {64, 3}, {13, 29}, {3, 64}, {101, 97}, {127, 131}, {257, 33}, {2, 1031}, {1031, 2}, {311, 256}};

class DeviceGrounds : public test::OnDevice {
 protected:
  void expect_same(const HeightField& field) { expect_same(field, DeviceGround(device(), field)); }
  void expect_same(const HeightField& field, const DeviceGround& ground) {
    const MaxPyramid pyramid(field);
    ASSERT_EQ(ground.levels().size(), static_cast<std::size_t>(pyramid.top_level()));
    if (!field.has_cells()) return;
    EXPECT_EQ(ground.code().base, pyramid.code().base);
    EXPECT_EQ(ground.code().step, pyramid.code().step);
    ASSERT_EQ(ground.read_pyramid(), entries_of(pyramid));
  }
  template <class T>
  void expect_same_with_and_without_holes(std::vector<T> samples, int cols, int rows, T nodata) {
    for (const Wrap wrap : {Wrap::none, Wrap::periodic, Wrap::shared_border}) {
      if (wrap == Wrap::shared_border) share_border(samples, cols, rows);
      auto holed = samples;
      dig_holes(holed, nodata);
      if (wrap == Wrap::shared_border) share_border(holed, cols, rows);
      SCOPED_TRACE(testing::Message() << cols << " x " << rows << ", wrap " << static_cast<int>(wrap));
      expect_same(HeightField::own(samples, cols, rows, {.wrap = wrap}));
      expect_same(HeightField::own(holed, cols, rows, {.nodata = static_cast<double>(nodata), .wrap = wrap}));
    }
  }
};

TEST_F(DeviceGrounds, PyramidsMatchTheCpuAtAnySize) {
  for (const auto& [cols, rows] : kSizes) {
    expect_same_with_and_without_holes<std::int16_t>(noise<std::int16_t>(cols, rows, 1, -30000), cols, rows, -32768);
    expect_same_with_and_without_holes<std::uint16_t>(noise<std::uint16_t>(cols, rows), cols, rows, 9);
    expect_same_with_and_without_holes<float>(noise<float>(cols, rows, 0.0371, -700), cols, rows, -9999.f);
  }
}

TEST_F(DeviceGrounds, PyramidsMatchTheCpuAtAnyHeight) {
  // Both extremes of 16 bits; floats that are tiny, huge, far from 0, all equal, zeros of both signs, all nodata.
  expect_same(HeightField::own(std::vector<std::int16_t>{-32768, 32767, 0, -1, 1, 7}, 3, 2));
  expect_same(HeightField::own(std::vector<std::uint16_t>{0, 65535, 1, 32768, 32767, 7}, 3, 2));
  for (const double base : {0.0, 1e6, -1e6, 4e38 / 3, -3e38}) {
    for (const double scale : {0.0, 1e-44, 1e-7, 1.0 / 3, 1e33}) {
      expect_same(HeightField::own(noise<float>(33, 18, scale, base), 33, 18));
    }
  }
  expect_same(HeightField::own(std::vector<float>{-3.4e38f, 3.4e38f, 0.f, 1.f}, 2, 2));
  expect_same(HeightField::own(std::vector<float>{-0.f, 0.f, 1e-40f, -1e-40f, 1.f, -1.f}, 3, 2));
  expect_same(HeightField::own(std::vector<float>(20, kNan), 5, 4));
  expect_same(HeightField::own(std::vector<float>{-0.f, 5.f, 0.f, 6.f, 7.f, 8.f}, 3, 2, {.nodata = 0.0}));
}

TEST(CodeTables, MatchTheFormulaForAnyFloat) {
  std::mt19937 random(5);
  for (const SampleRange& range : {SampleRange{-1000, 4000}, SampleRange{0, 0}, SampleRange{1e6, 1e6 + 0.25},
                                   SampleRange{-3e38, 3e38}, SampleRange{1e-42, 1e-41}}) {
    const HeightCode code = height_code(SampleType::float32, range);
    const auto tables = code_tables(code);
    const auto begin = tables.begin(), middle = begin + glsl::kPyramidCodes, end = tables.end();
    ASSERT_TRUE(std::is_sorted(begin, middle) && std::is_sorted(middle, end));
    for (int i = 0; i < 20000; ++i) {
      // Any sample of the range, and the neighbours of decoded values.
      float sample =
          static_cast<float>(range.low + (range.high - range.low) * static_cast<double>(random()) / 4294967295.0);
      if (i % 2) sample = static_cast<float>(code.height(static_cast<std::uint16_t>(random() % 65536)));
      if (i % 4 == 1) sample = std::nextafter(sample, std::numeric_limits<float>::infinity());
      if (!std::isfinite(sample)) continue;
      std::uint16_t above, below;
      encode_above(code, &sample, 1, &above);
      encode_below(code, &sample, 1, &below);
      const std::uint32_t key = glsl::float_key(std::bit_cast<std::uint32_t>(sample));
      ASSERT_EQ(std::lower_bound(begin, middle, key) - begin, above) << sample;
      ASSERT_EQ(std::upper_bound(middle, end, key) - middle - 1, below) << sample;
    }
  }
}

TEST_F(DeviceGrounds, UpdateMatchesARebuild) {
  std::mt19937 random(9);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto run = [&]<class T>(T nodata, const HeightFieldSettings& settings) {
    const int cols = 37, rows = 29;
    std::vector<T> samples = noise<T>(cols, rows, 0.5);
    if (settings.wrap == Wrap::shared_border) share_border(samples, cols, rows);
    HeightField field = HeightField::own(samples, cols, rows, settings);
    SampleRange seen{field.min_sample(), field.max_sample()};
    DeviceGround ground(device(), field);
    for (int i = 0; i < 40; ++i) {
      SampleRect rect{below(cols), below(rows), 1, 1};
      rect.cols = 1 + below(cols - rect.col);
      rect.rows = 1 + below(rows - rect.row);
      if (settings.wrap == Wrap::shared_border) rect = {1, 1, 1 + below(cols - 2), 1 + below(rows - 2)};
      std::vector<T> edit(static_cast<std::size_t>(rect.cols) * rect.rows);
      // The last edits are outside the range of the float codes.
      for (T& sample : edit) sample = below(12) == 0 ? nodata : static_cast<T>(below(i < 35 ? 30000 : 60000));
      const CellBox changed = field.set_samples(rect, edit.data(), rect.cols);
      seen = {std::min(seen.low, field.min_sample()), std::max(seen.high, field.max_sample())};
      ground.update(field, changed);
      ASSERT_EQ(ground.read_pyramid(), entries_of(MaxPyramid(field, seen))) << "edit " << i;
    }
  };
  for (const Wrap wrap : {Wrap::none, Wrap::periodic, Wrap::shared_border}) {
    run(std::int16_t{500}, {.nodata = 500, .wrap = wrap});
    run(std::uint16_t{500}, {.wrap = wrap});
    run(500.f, {.nodata = 500, .wrap = wrap});
  }
}

TEST_F(DeviceGrounds, UpdateCreatesNoPasses) {
  HeightField field = HeightField::own(noise<float>(1025, 1025), 1025, 1025);
  DeviceGround ground(device(), field);
  EXPECT_EQ(ground.passes().size(), 20u);  // two passes for each level
  const float sample = 1234.5f;
  ground.update(field, field.set_samples({700, 300, 1, 1}, &sample, 1));
  EXPECT_EQ(ground.passes().size(), 20u);
  EXPECT_EQ(ground.passes()[0].name, "max_pyramid");
}

// More samples than fit in one storage buffer of lavapipe (128 MiB), and a level wider than one dispatch. The checked
// build would take half a minute for that, so it uses only a long row. Rays must hit the ground there.
TEST_F(DeviceGrounds, LongFieldsWork) {
#ifdef NDEBUG
  const int cols = 17'500'000;
#else
  const int cols = 200'000;
#endif
  std::vector<float> samples(2 * std::size_t{cols});
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i * i % 65521);
  const HeightField field = HeightField::own(std::move(samples), cols, 2);
  const DeviceGround ground(device(), field);
  expect_same(field, ground);

  std::mt19937 random(23);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Ray> rays(1000);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Half of them are over the last samples, which are outside the range.
    rays[i].origin = {uniform(i % 2 ? 0.97 * cols : 0, cols - 1), uniform(0, 1), uniform(66000, 70000)};
    rays[i].direction = {i % 4 < 2 ? 1.0 : -1.0, uniform(-1, 1) / 1024, -uniform(5, 500)};
    rays[i].t_max = 1000;
  }
  std::vector<Hit> hits(rays.size());
  DeviceQueries(device(), find_height_march("max-mip"), {}, {.rays_at_once = 1000})
      .closest_hits({&field, &ground}, rays, hits);
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    met += static_cast<bool>(hits[i]);
    ASSERT_EQ(test::RoundingJudge(field, rays[i]).objection(hits[i]), "")
        << rays[i].origin.x << ", cell " << hits[i].cell.col;
  }
  EXPECT_GT(met, 500);
}

// Reads the four heights of each cell through ground_buffers.glsl.h, and whether the cell is a hole.
TEST_F(DeviceGrounds, ShadersReadTheFieldsSamples) {
  struct Push {
    glsl::Address ground, out;
  };
  const auto expect_read = [&](const HeightField& field) {
    const DeviceGround ground(device(), field);
    const std::size_t cells = static_cast<std::size_t>(field.cell_cols()) * field.cell_rows();
    DeviceBuffer out(device(), 5 * 4 * cells, "heights");
    const ComputePipeline pipeline(device(), kProbe, "probe", sizeof(Push));
    Commands commands(device());
    commands.dispatch(
        pipeline, Push{ground.address(), out.address()},
        {static_cast<std::uint32_t>(field.cell_cols()), static_cast<std::uint32_t>(field.cell_rows()), 1});
    commands.run();
    std::vector<float> read(5 * cells);
    download(out, 0, read.data(), out.bytes());
    for (int row = 0; row < field.cell_rows(); ++row) {
      for (int col = 0; col < field.cell_cols(); ++col) {
        const float* at = &read[5 * (static_cast<std::size_t>(row) * field.cell_cols() + col)];
        const auto heights = field.cell_heights({col, row});
        ASSERT_EQ(at[4] != 0.f, heights.has_value()) << col << ", " << row;
        if (!heights) continue;
        ASSERT_EQ(static_cast<double>(at[0]), heights->h00);
        ASSERT_EQ(static_cast<double>(at[1]), heights->h10);
        ASSERT_EQ(static_cast<double>(at[2]), heights->h01);
        ASSERT_EQ(static_cast<double>(at[3]), heights->h11);
      }
    }
  };
  const int cols = 21, rows = 19;
  for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
    auto shorts = noise<std::int16_t>(cols, rows, 1, -30000);
    auto words = noise<std::uint16_t>(cols, rows);
    auto floats = noise<float>(cols, rows, 0.037, -700);
    expect_read(HeightField::own(floats, cols, rows, {.wrap = wrap}));
    dig_holes<std::int16_t>(shorts, -32768);
    dig_holes<std::uint16_t>(words, 65535);
    dig_holes(floats, -9999.f);
    expect_read(HeightField::own(shorts, cols, rows, {.nodata = -32768, .wrap = wrap}));
    expect_read(HeightField::own(words, cols, rows, {.nodata = 65535, .wrap = wrap}));
    expect_read(HeightField::own(floats, cols, rows, {.nodata = -9999, .wrap = wrap}));
  }
}

}  // namespace
}  // namespace scarp
