// SPDX-License-Identifier: MIT
#include "app/cli/picture/picture_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/cli/picture/exr_output.h"
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

void require_library(const PictureFormat& format, const std::string& output) {
  if (format.kind == PictureKind::exr) require_exr(output);
#ifndef SCARP_CAIRO
  if (format.kind == PictureKind::pdf) {
    throw Error(fmt::format(
        "output '{}': this scarp was built without Cairo (SCARP_CAIRO=OFF); let the name end in .png", output));
  }
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
