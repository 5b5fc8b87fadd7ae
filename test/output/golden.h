// SPDX-License-Identifier: MIT
// Compares a picture with an approved one. After an intended change, run the tests with SCARP_NEW_GOLDEN=1, which
// replaces the old pictures with the new ones, and review these.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "output/read_png.h"
#include "scarp/output/png.h"

namespace scarp::test {

/// A byte may round the other way where the mathematical library's pow, exp, sin or cos differs in its last bit.
inline constexpr int kByteRounding = 2;
/// A ray may also pass a crest or a shadow's edge on the other side: that changes one of a pixel's four samples, at
/// most from white to black, and only in few pixels. With one sample per pixel it changes the whole pixel.
inline constexpr int kMaxDifference = 140, kAnyDifference = 255;
inline constexpr double kMaxShare = 0.001;

/// Expects that no byte of the PNG `picture` differs by more than `most` from the PNG `golden`, and that few differ by
/// more than kByteRounding. If this fails, `failed` + "_now.png" and "_difference.png" show it.
inline void expect_golden(const std::string& picture, const std::filesystem::path& golden_path, int most,
                          const std::string& failed) {
  namespace fs = std::filesystem;
  if (std::getenv("SCARP_NEW_GOLDEN")) fs::copy_file(picture, golden_path, fs::copy_options::overwrite_existing);
  const Rgb now = read_png(picture);
  const std::string kept = failed + "_now.png";
  fs::copy_file(picture, kept, fs::copy_options::overwrite_existing);
  ASSERT_TRUE(fs::exists(golden_path)) << "the picture is " << kept;
  const Rgb golden = read_png(golden_path.string());
  ASSERT_EQ(now.width, golden.width);
  ASSERT_EQ(now.height, golden.height);

  int largest = 0;
  std::int64_t differing = 0;
  std::vector<std::uint8_t> difference(now.bytes.size());
  for (std::size_t pixel = 0; pixel < now.bytes.size(); pixel += 3) {
    int here = 0;
    for (std::size_t i = pixel; i < pixel + 3; ++i) here = std::max(here, std::abs(now.bytes[i] - golden.bytes[i]));
    largest = std::max(largest, here);
    differing += here > kByteRounding;
    // Amplified for visibility.
    std::fill_n(difference.begin() + static_cast<std::ptrdiff_t>(pixel), 3,
                static_cast<std::uint8_t>(std::min(255, 8 * here)));
  }
  const double share = static_cast<double>(differing) / (static_cast<double>(now.width) * now.height);
  EXPECT_LE(largest, most);
  EXPECT_LE(share, kMaxShare);
  if (largest > most || share > kMaxShare) {
    const std::string shown = failed + "_difference.png";
    write_png(shown, {difference.data(), now.width, now.height});
    ADD_FAILURE() << "differences, 8 times as bright: " << shown << "; the picture itself: " << kept;
  } else {
    fs::remove(kept);
  }
}

}  // namespace scarp::test
