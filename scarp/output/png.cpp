// SPDX-License-Identifier: MIT
#include "scarp/output/png.h"

#include <fmt/format.h>
#include <png.h>

#include "scarp/base/error.h"

namespace scarp {

void write_png(ReplaceFile& file, const std::string& path, const RgbView& picture) {
  if (picture.data == nullptr || picture.width < 1 || picture.height < 1) {
    throw Error(
        fmt::format("{}: image of {} x {} pixels (at least 1 x 1 required)", path, picture.width, picture.height));
  }
  // libpng's simplified interface returns errors instead of calling longjmp across C++ frames.
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  constexpr int kNoConversionTo8Bit = 0, kTightRows = 0;
  if (!png_image_write_to_file(&image, file.temporary_path().c_str(), kNoConversionTo8Bit, picture.data, kTightRows,
                               nullptr)) {
    throw Error(fmt::format("{}: cannot be written: {} (is the disk full?)", path, image.message));
  }
  file.commit();
}

void write_png(const std::string& path, const RgbView& picture) {
  ReplaceFile file(path);
  write_png(file, path, picture);
}

}  // namespace scarp
