// SPDX-License-Identifier: MIT
// Formats of pictures, by the extension of the output. Checks, help and completion read this table.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace scarp::cli {

enum class PictureKind : std::uint8_t { png, jpeg, tiff, pdf, exr };

struct PictureFormat {
  PictureKind kind;
  std::string_view name;        ///< "JPEG"
  std::string_view extensions;  ///< without dots: "jpg jpeg"; the first is shown
  std::string_view holds;       ///< contents, for help, after the extension; empty: a picture
  bool layers = false;          ///< linear light and geometry, instead of display colours
  bool map = false;             ///< georeferenced: needs --top
  bool margins = true;          ///< may have margins around the picture
};

/// Throws Error listing the extensions if the format is unknown, or if this build lacks its library. `with_margins`:
/// lists only formats with margins.
const PictureFormat& picture_format_of(const std::string& output, bool with_margins = false);

/// "png jpg jpeg tif tiff pdf exr".
std::string picture_extensions();
/// "picture: .png, .jpg, .tif (GeoTIFF, with --top), ...".
std::string picture_help();

}  // namespace scarp::cli
