// SPDX-License-Identifier: MIT
// Writes layered pictures to OpenEXR files, with the channel names that compositing programs expect.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/replace_file.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// R, G, B (half), Z, N.X, N.Y, N.Z, P.X, P.Y, P.Z (float) and steps (uint), worldToCamera and worldToNDC in the
/// header. Does nothing without OpenEXR: picture_format_of() rejects such outputs. Writes to the temporary file of
/// `file` and commits it; throws Error as write_exr() does. Unless `device_depths` is empty, also writes `depth`
/// (float).
void write_layers(ReplaceFile& file, const std::string& path, const PictureLayers& layers, const Camera& camera,
                  const std::vector<float>& device_depths);

/// Writes a picture of the look `error` likewise: R, G, B (half, linear light of the picture's colours), and early,
/// late, lost and false (float), error_metres() of the pixels with this verdict, 0 for all others.
void write_error_layers(ReplaceFile& file, const std::string& path, const Picture& picture, const Camera& camera);

}  // namespace scarp::cli
