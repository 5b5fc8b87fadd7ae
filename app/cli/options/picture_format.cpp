// SPDX-License-Identifier: MIT
#include "app/cli/options/picture_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/options/option.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {
namespace {

constexpr std::array<PictureFormat, 5> kFormats = {{
    {PictureKind::png, "PNG", "png", ""},
    {PictureKind::jpeg, "JPEG", "jpg jpeg", ""},
    {PictureKind::pdf, "PDF", "pdf", ""},
    {PictureKind::tiff, "GeoTIFF", "tif tiff", "map", false, true, false},
    {PictureKind::exr, "EXR", "exr", "layers", true, false, false},
}};

void require_library([[maybe_unused]] const PictureFormat& format, [[maybe_unused]] const std::string& output) {
  [[maybe_unused]] const auto require = [&](PictureKind kind, std::string_view library, std::string_view option) {
    if (format.kind != kind) return;
    throw Error(fmt::format("output '{}': this scarp was built without {} ({}=OFF); let the name end in .png", output,
                            library, option));
  };
#ifndef SCARP_OPENEXR
  require(PictureKind::exr, "OpenEXR", "SCARP_OPENEXR");
#endif
#ifndef SCARP_CAIRO
  require(PictureKind::pdf, "Cairo", "SCARP_CAIRO");
#endif
}

}  // namespace

const PictureFormat& picture_format_of(const std::string& output, bool with_margins) {
  const std::string extension = extension_of(output);
  std::string all;
  for (const PictureFormat& format : kFormats) {
    for (const std::string_view word : words_of(format.extensions)) {
      if (extension == fmt::format(".{}", word)) {
        require_library(format, output);
        return format;
      }
    }
    if (format.margins || !with_margins)
      all += fmt::format("{}*.{} ({})", all.empty() ? "" : ", ", words_of(format.extensions)[0], format.name);
  }
  throw Error(fmt::format("output '{}': unknown picture format (name it {})", output, all));
}

std::string picture_extensions() {
  std::string all;
  for (const PictureFormat& format : kFormats) all += fmt::format("{}{}", all.empty() ? "" : " ", format.extensions);
  return all;
}

std::string picture_help() {
  std::string all;
  for (const PictureFormat& format : kFormats) {
    all += fmt::format("{}.{}", all.empty() ? "" : ", ", words_of(format.extensions)[0]);
    if (!format.holds.empty()) all += fmt::format(" ({})", format.holds);
  }
  return "picture: " + all;
}

}  // namespace scarp::cli
