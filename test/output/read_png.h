// SPDX-License-Identifier: MIT
// Reads PNG pictures back, for tests.
#pragma once

#include <png.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace scarp::test {

/// Rows from the top, 3 bytes per pixel.
struct Rgb {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;

  const std::uint8_t* pixel(int x, int y) const { return bytes.data() + 3 * (std::ptrdiff_t{y} * width + x); }
};

/// Throws std::runtime_error with libpng's message.
inline Rgb read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&image, path.c_str())) throw std::runtime_error(path + ": " + image.message);
  image.format = PNG_FORMAT_RGB;
  Rgb rgb{static_cast<int>(image.width), static_cast<int>(image.height),
          std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  if (!png_image_finish_read(&image, nullptr, rgb.bytes.data(), 0, nullptr))
    throw std::runtime_error(path + ": " + image.message);
  return rgb;
}

}  // namespace scarp::test
