// SPDX-License-Identifier: MIT
// The options of pictures for ground colours, water, fog and large pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "scarp/base/georeference.h"
#include "scarp/render/frame/picture_request.h"

namespace scarp::cli {

/// Files that a picture needs in addition to its input; empty: none.
struct PictureFileNames {
  std::string ramp{};  ///< .cpt, .txt, .clr or .png
  std::string detail_texture{};
  std::string overlay{};
  bool overlay_fit = false;  ///< stretches the overlay over the scene, whatever its georeference

  bool operator==(const PictureFileNames&) const = default;
};

/// Declares the options. Both structures must outlive the command.
void add_look_options(Command& command, PictureRequest& request, PictureFileNames& files);

/// Reads the ramp and the detail texture. Throws Error naming the file, also if both the ramp file and the request
/// define heights.
PictureFiles read_picture_files(const PictureFileNames& files, const PictureRequest& request);

/// The image of --overlay; null without the option.
struct OverlayFiles {
  std::shared_ptr<const Drape> drape;
  std::vector<std::string> files;  ///< all files that were opened
};
/// Reads the image of `names`, if any, for a raster of `cols` x `rows` samples, or for any scene if there is no
/// georeference. An image with more than `most_pixels` over the raster is averaged. Throws Error naming the file.
OverlayFiles read_overlay_files(const PictureFileNames& names, const Georeference& georeference, int cols, int rows,
                                bool mirror, std::int64_t most_pixels);

}  // namespace scarp::cli
