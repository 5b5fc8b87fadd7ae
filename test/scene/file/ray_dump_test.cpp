// SPDX-License-Identifier: MIT
#include "scarp/scene/file/ray_dump.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class RayDumps : public testing::Test {
 protected:
  ~RayDumps() override { std::filesystem::remove(path_); }

  std::vector<RayDump> through_a_file(const std::vector<RayDump>& dumps) const {
    write_ray_dumps(path_, dumps);
    return read_ray_dumps(path_);
  }
  std::string refusal(const std::string& text) const {
    std::ofstream(path_) << text;
    try {
      read_ray_dumps(path_);
    } catch (const Error& error) {
      const std::string what = error.what(), head = "'" + path_ + "', ";
      EXPECT_EQ(what.substr(0, head.size()), head) << what;
      return what.substr(head.size());
    }
    return "accepted";
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / ("scarp-ray-dump-" + std::to_string(::getpid()))).string();
};

template <class T>
std::vector<T> samples_of(const HeightField& field) {
  std::vector<T> samples;
  field.visit([&](const auto& grid) {
    for (int row = 0; row < grid.rows; ++row) {
      for (int col = 0; col < grid.cols; ++col) samples.push_back(static_cast<T>(grid.at(col, row)));
    }
  });
  return samples;
}

TEST_F(RayDumps, RoundTripExactly) {
  const HeightFieldSettings settings{.cell_x = 0.1,
                                     .cell_y = 1.0 / 3,
                                     .scale = 0.7,
                                     .offset = -1e6 / 3,
                                     .exaggeration = 2.5,
                                     .nodata = -32768,
                                     .surface = Surface::triangles,
                                     .wrap = Wrap::periodic,
                                     .solid = true};
  const std::vector<std::int16_t> samples{1, -2, -32768, 4, 5, 32767};
  RayDump dump{HeightField::own(samples, 3, 2, settings), {}, {}, "a hit: 'there'", "miss"};
  dump.ray.origin = {0.1, -1e7 / 3, 5e-324};
  dump.ray.direction = {-0.0, 0x1p-1000, 1.0 / 7};
  dump.ray.t_min = -0.3;
  dump.ray.t_max = 1e300;
  dump.ray.start = RayStart::on_surface;
  dump.ray.start_cell = {0, 1};
  dump.ray.start_cell.col = 0;
  // Cell (0, 1) wraps around and has the corners 4, 5, 1, -2.
  const auto read = through_a_file({dump});
  ASSERT_EQ(read.size(), 1u);
  const HeightFieldSettings& to = read[0].field.settings();
  EXPECT_EQ(to.cell_x, settings.cell_x);
  EXPECT_EQ(to.cell_y, settings.cell_y);
  EXPECT_EQ(to.scale, settings.scale);
  EXPECT_EQ(to.offset, settings.offset);
  EXPECT_EQ(to.exaggeration, settings.exaggeration);
  EXPECT_EQ(to.nodata, settings.nodata);
  EXPECT_EQ(to.surface, settings.surface);
  EXPECT_EQ(to.wrap, settings.wrap);
  EXPECT_EQ(to.solid, settings.solid);
  EXPECT_EQ(read[0].field.sample_type(), SampleType::int16);
  EXPECT_EQ(read[0].field.cols(), 3);
  EXPECT_EQ(samples_of<std::int16_t>(read[0].field), samples);
  EXPECT_EQ(read[0].ray.origin, dump.ray.origin);
  EXPECT_EQ(read[0].ray.direction, dump.ray.direction);
  EXPECT_TRUE(std::signbit(read[0].ray.direction.x));
  EXPECT_EQ(read[0].ray.t_min, dump.ray.t_min);
  EXPECT_EQ(read[0].ray.t_max, dump.ray.t_max);
  EXPECT_EQ(read[0].ray.start, RayStart::on_surface);
  EXPECT_EQ(read[0].ray.start_cell, dump.ray.start_cell);
  EXPECT_EQ(read[0].expected, dump.expected);
  EXPECT_EQ(read[0].answered, dump.answered);
}

TEST_F(RayDumps, StoreFloatsWithHoles) {
  const std::vector<float> samples{0.1f, kNaN, -3e-30f, 1e30f};
  const RayDump dump{HeightField::own(samples, 2, 2), {}, {}, "", ""};
  const auto read = through_a_file({dump});
  const auto back = samples_of<float>(read.at(0).field);
  EXPECT_EQ(back[0], samples[0]);
  EXPECT_TRUE(std::isnan(back[1]));
  EXPECT_EQ(back[2], samples[2]);
  EXPECT_EQ(back[3], samples[3]);
  EXPECT_TRUE(std::isinf(read[0].ray.t_max));
}

TEST_F(RayDumps, ShareTheirField) {
  RayDump first{HeightField::own<float>({1, 2, 3, 4}, 2, 2), {}, {}, "", ""}, second = first;
  second.ray.origin.x = 7;
  const RayDump third{HeightField::own<float>({5, 6, 7, 8}, 2, 2), {}, {}, "", ""};
  const auto read = through_a_file({first, second, third});
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[1].ray.origin.x, 7);
  EXPECT_EQ(read[1].field.max_sample(), 4);
  EXPECT_EQ(read[2].field.max_sample(), 8);
  std::ifstream in(path_);
  int fields = 0;
  for (std::string line; std::getline(in, line);) fields += line.starts_with("field");
  EXPECT_EQ(fields, 2);
}

TEST_F(RayDumps, RegenerateProceduralFields) {
  const ProceduralDem dem{.cols = 40, .rows = 30, .seed = 9, .kind = TerrainKind::ridged, .cell_m = 1};
  const RayDump dump{HeightField::own(generate_dem(dem), 40, 30), dem, {}, "", ""};
  EXPECT_EQ(samples_of<float>(through_a_file({dump}).at(0).field), samples_of<float>(dump.field));
  EXPECT_LT(std::filesystem::file_size(path_), 1000u);
}

TEST_F(RayDumps, ErrorNamesTheLine) {
  const std::string head = "scarp-rays 1\n", field = "field float32 2 2\nrow 1 2\nrow 3 4\n";
  EXPECT_EQ(refusal(head + field + "ray\ndirection 0 0 -1\n"), "accepted");
  EXPECT_EQ(refusal(""), "line 1: the first line must be 'scarp-rays 1'");
  EXPECT_EQ(refusal("P6\n"), "line 1: the first line must be 'scarp-rays 1'");
  EXPECT_EQ(refusal(head), "line 1: there is no ray in it");
  EXPECT_EQ(refusal(head + "ray\n"), "line 2: a ray without a field; a line 'field TYPE COLUMNS ROWS' must come first");
  EXPECT_EQ(refusal(head + "row 1\n"), "line 2: 'row': a line 'field TYPE COLUMNS ROWS' must come first");
  EXPECT_EQ(refusal(head + "field float64 2 2\n"),
            "line 2: type 'float64': unknown (available: int16, uint16, float32)");
  EXPECT_EQ(refusal(head + "field int16 0 2\n"), "line 2: 0 x 2 samples; at least 1 x 1 are needed");
  EXPECT_EQ(refusal(head + "field int16 99999999999 2\n"), "line 2: columns '99999999999' is no whole number in range");
  EXPECT_EQ(refusal(head + "field int16 2 2 2\n"), "line 2: '2' is too much");
  EXPECT_EQ(refusal(head + "field int16 2 2\nrow 1 2 3\n"), "line 3: 3 samples; the field has 2 columns");
  EXPECT_EQ(refusal(head + field + "row 5 6\n"), "line 5: more than 2 rows");
  EXPECT_EQ(refusal(head + "field int16 2 2\nrow 1 2\nray\n"), "line 4: 1 of 2 rows of samples before the ray");
  EXPECT_EQ(refusal(head + "field int16 1 1\nrow 70000\nray\n"), "line 4: the sample 70000 is no int16");
  EXPECT_EQ(refusal(head + "field int16 1 1\nrow 0x\n"), "line 3: sample '0x' is no number");
  EXPECT_EQ(refusal(head + "field int16 1 1\nrow --1\n"), "line 3: sample '--1' is no number");
  EXPECT_EQ(refusal(head + "field int16 1 1\ncell_x 0\nrow 1\nray\n"),
            "line 5: height field: cell_x is 0 (must be finite and above 0)");
  EXPECT_EQ(refusal(head + "field float32 1 1\nrow inf\nray\n").substr(0, 6), "line 4");
  EXPECT_EQ(refusal(head + "field int16 1 1\nwrap round\n"),
            "line 3: wrap 'round': unknown (available: none, periodic, shared_border)");
  EXPECT_EQ(refusal(head + "field int16 1 1\ncolour red\n"), "line 3: 'colour' is no line of a field");
  EXPECT_EQ(refusal(head + field + "ray\norigin 1 2\n"), "line 6: origin '' is no number");
  EXPECT_EQ(refusal(head + field + "ray\ncell_x 1\n"), "line 6: 'cell_x' is no line of a ray");
  EXPECT_EQ(refusal(head + field + "ray\ndirection 0 0 0\n"), "line 6: ray: its direction is zero");
  EXPECT_EQ(refusal(head + field + "ray\nstart on_surface 5 0\n"),
            "line 6: ray: it starts on the surface of cell (5, 0), which does not exist");
  EXPECT_EQ(refusal(head + "field float32 2 2\ngenerate hills 1 1 0\n"),
            "line 3: kind 'hills': unknown (available: fbm, ridged)");
  EXPECT_EQ(refusal(head + "field float32 2 2\ngenerate fbm 1 1 0\nrow 1 2\n"),
            "line 4: the samples are generated; there can be no rows");
  EXPECT_EQ(refusal(head + "field float32 65536 65536\ngenerate ridged 1 1 0\n"),
            "line 3: 65536 x 65536 samples; dumps generate 1073741824 at most");
  EXPECT_THROW(read_ray_dumps("/nowhere/rays.txt"), Error);
  EXPECT_THROW(write_ray_dumps("/nowhere/rays.txt", {}), Error);
}

}  // namespace
}  // namespace scarp
