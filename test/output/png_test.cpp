// SPDX-License-Identifier: MIT
#include "scarp/output/png.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

#include "full_disk.h"
#include "output/read_png.h"
#include "scarp/base/error.h"
#include "scratch.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

class Png : public testing::Test, protected test::Scratch {
 protected:
};

// Incompressible bytes.
std::vector<std::uint8_t> noise(int width, int height) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> bytes(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST_F(Png, RoundTrips) {
  for (const auto& [width, height] : {std::pair(1, 1), {17, 3}, {3, 17}, {64, 64}}) {
    const auto bytes = noise(width, height);
    write_png(path("a.png"), {bytes.data(), width, height});
    const test::Rgb read = test::read_png(path("a.png"));
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, height);
    EXPECT_EQ(read.bytes, bytes) << width << " x " << height;
  }
  EXPECT_EQ(files().size(), 1u) << "temporary files were left behind";
}

TEST_F(Png, FullDiskKeepsTheOldPicture) {
  const auto small = noise(2, 2), large = noise(200, 200);
  write_png(path("a.png"), {small.data(), 2, 2});
  std::string message;
  try {
    const test::FullDisk disk(10000);
    write_png(path("a.png"), {large.data(), 200, 200});
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("a.png"), std::string::npos) << "message: '" << message << "'";
  EXPECT_EQ(test::read_png(path("a.png")).width, 2);
  EXPECT_EQ(files().size(), 1u) << "temporary files were left behind";
}

TEST_F(Png, RejectsPicturesWithoutPixels) {
  const std::uint8_t byte = 0;
  EXPECT_THROW(write_png(path("a.png"), {&byte, 0, 1}), Error);
  EXPECT_THROW(write_png(path("a.png"), {nullptr, 1, 1}), Error);
  EXPECT_EQ(files().size(), 0u);
}

}  // namespace
}  // namespace scarp
