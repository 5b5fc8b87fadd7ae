// SPDX-License-Identifier: MIT
#include "scarp/output/exr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <vector>

#include "full_disk.h"
#include "output/read_exr.h"
#include "scarp/base/error.h"
#include "scratch.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

class ExrFile : public testing::Test, protected test::Scratch {
 protected:
};

// Incompressible numbers.
std::vector<float> noise(std::size_t count) {
  std::mt19937 random(1);
  std::vector<float> numbers(count);
  for (float& number : numbers) number = std::ldexp(static_cast<float>(random()), -20);
  return numbers;
}

TEST_F(ExrFile, RoundTrips) {
  // More rows than are passed at once, and rows that do not fill the last block.
  for (const auto& [width, height] : {std::pair(1, 1), {17, 3}, {3, 17}, {5, 600}}) {
    const std::size_t pixels = static_cast<std::size_t>(width * height);
    std::vector<float> depth = noise(pixels), triples = noise(3 * pixels);
    depth[0] = std::numeric_limits<float>::infinity();
    std::vector<std::uint32_t> steps(pixels);
    for (std::size_t i = 0; i < pixels; ++i) steps[i] = 4000000000u + static_cast<std::uint32_t>(i);
    ExrView picture{width, height};
    picture.channels = {{"G", triples.data() + 1, 3, ExrStorage::half},
                        {"Z", depth.data()},
                        {"N.Y", triples.data() + 1, 3},
                        {"steps", steps.data()}};
    picture.matrices = {{"worldToNDC", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}}};
    write_exr(path("a.exr"), picture);
    const test::Exr read = test::read_exr(path("a.exr"));
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, height);
    EXPECT_EQ(read.compression, Imf::ZIP_COMPRESSION);
    ASSERT_EQ(read.channels.size(), 4u);
    EXPECT_EQ(read.channels.at("G").type, Imf::HALF);
    EXPECT_EQ(read.channels.at("Z").type, Imf::FLOAT);
    EXPECT_EQ(read.channels.at("N.Y").type, Imf::FLOAT);
    EXPECT_EQ(read.channels.at("steps").type, Imf::UINT);
    for (std::size_t i = 0; i < pixels; ++i) {
      ASSERT_EQ(read.channels.at("G").values[i], float{half(triples[3 * i + 1])});
      ASSERT_EQ(read.channels.at("Z").values[i], depth[i]);
      ASSERT_EQ(read.channels.at("N.Y").values[i], triples[3 * i + 1]);
      ASSERT_EQ(read.channels.at("steps").values[i], steps[i]);
    }
    const Imath::M44f& matrix = read.matrices.at("worldToNDC");
    EXPECT_EQ(matrix[3][1], 13) << "row by row";
  }
  EXPECT_EQ(files().size(), 1u) << "temporary files were left behind";
}

TEST_F(ExrFile, FullDiskKeepsTheOldPicture) {
  const std::vector<float> depth = noise(200 * 200);
  write_exr(path("whole.exr"), {200, 200, {{"Z", depth.data()}}});
  const auto size = static_cast<std::uint64_t>(fs::file_size(path("whole.exr")));
  write_exr(path("a.exr"), {2, 2, {{"Z", depth.data()}}});
  // The disk becomes full within the header, between lines, or before the last byte; and for a picture so small that
  // nothing reaches the disk before the file is closed.
  for (const auto& [side, limit_of_size] :
       {std::pair(200, std::uint64_t{100}), {200, size / 2}, {200, size - 1}, {3, std::uint64_t{100}}}) {
    std::string message;
    try {
      const test::FullDisk disk(limit_of_size);
      write_exr(path("a.exr"), {side, side, {{"Z", depth.data()}}});
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_NE(message.find("a.exr"), std::string::npos) << limit_of_size << ": '" << message << "'";
    EXPECT_EQ(test::read_exr(path("a.exr")).width, 2);
    EXPECT_EQ(files().size(), 2u) << "temporary files were left behind";
  }
}

TEST_F(ExrFile, RejectsInvalidPictures) {
  const float number = 1;
  const ExrChannel good{"Z", &number};
  for (const ExrView& bad : {ExrView{0, 1, {good}},
                             {1, -1, {good}},
                             {1, 1, {}},
                             {1, 1, {good, good}},
                             {1, 1, {{"", &number}}},
                             {1, 1, {{"Z", static_cast<const float*>(nullptr)}}},
                             {1, 1, {{"Z", &number, 0}}}}) {
    EXPECT_THROW(write_exr(path("a.exr"), bad), Error);
  }
  EXPECT_THROW(write_exr(path("no/folder/a.exr"), {1, 1, {good}}), Error);
  EXPECT_EQ(files().size(), 0u);
}

}  // namespace
}  // namespace scarp
