// SPDX-License-Identifier: MIT
#include "app/cli/picture/exr_output.h"

#ifdef SCARP_OPENEXR
#include "scarp/output/exr.h"
#endif

namespace scarp::cli {

#ifdef SCARP_OPENEXR

namespace {

// GLM's matrices are column-major for column vectors: the memory layout of row-major matrices for row vectors.
ExrMatrix matrix(const char* name, const glm::dmat4& m) {
  ExrMatrix stored{name, {}};
  for (int i = 0; i < 16; ++i) stored.elements[static_cast<std::size_t>(i)] = static_cast<float>(m[i / 4][i % 4]);
  return stored;
}

}  // namespace

void write_layers(ReplaceFile& file, const std::string& path, const PictureLayers& layers, const Camera& camera,
                  const std::vector<float>& device_depths) {
  const auto axis = [](const char* name, const std::vector<vec3>& layer, int i, ExrStorage storage) {
    return ExrChannel{name, &layer.data()->x + i, 3, storage};
  };
  ExrView picture{layers.width, layers.height};
  picture.channels = {axis("R", layers.colour, 0, ExrStorage::half),
                      axis("G", layers.colour, 1, ExrStorage::half),
                      axis("B", layers.colour, 2, ExrStorage::half),
                      {"Z", layers.depth.data()},
                      axis("N.X", layers.normal, 0, ExrStorage::full),
                      axis("N.Y", layers.normal, 1, ExrStorage::full),
                      axis("N.Z", layers.normal, 2, ExrStorage::full),
                      axis("P.X", layers.position, 0, ExrStorage::full),
                      axis("P.Y", layers.position, 1, ExrStorage::full),
                      axis("P.Z", layers.position, 2, ExrStorage::full),
                      {"steps", layers.steps.data()}};
  if (!device_depths.empty()) picture.channels.push_back({"depth", device_depths.data()});
  picture.matrices = {matrix("worldToCamera", camera.camera_from_world()),
                      matrix("worldToNDC", camera.ndc_from_world())};
  write_exr(file, path, picture);
}

#else

void write_layers(ReplaceFile&, const std::string&, const PictureLayers&, const Camera&, const std::vector<float>&) {}

#endif

}  // namespace scarp::cli
