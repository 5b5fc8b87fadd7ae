// SPDX-License-Identifier: MIT
// Any bytes as pixels of three and of four bands: every sample is a whole number of 24 bits, or NaN where alpha is 0.
#include "scarp/source/raster/terrain_rgb.h"

#include <cmath>
#include <cstdlib>
#include <vector>

#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const int bands : {3, 4}) {
    const auto pixel_bytes = static_cast<std::size_t>(bands);
    // Copies of the exact sizes, so that reading a byte or writing a sample too many is found.
    const std::vector<std::uint8_t> pixels(data, data + size / pixel_bytes * pixel_bytes);
    std::vector<float> samples(pixels.size() / pixel_bytes);
    scarp::decode_rgb(pixels.data(), samples.size(), bands, samples.data());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::uint8_t* pixel = pixels.data() + i * pixel_bytes;
      const bool hole = bands == 4 && pixel[3] == 0;
      if (hole != std::isnan(samples[i])) std::abort();
      if (hole) continue;
      const auto n = static_cast<std::uint32_t>(samples[i]);
      if (n >> 24 != 0 || n >> 16 != pixel[0] || (n >> 8 & 255) != pixel[1] || (n & 255) != pixel[2]) std::abort();
    }
  }
  return 0;
}
