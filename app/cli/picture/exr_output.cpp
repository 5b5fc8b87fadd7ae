// SPDX-License-Identifier: MIT
#include "app/cli/picture/exr_output.h"

#ifdef SCARP_OPENEXR
#include <array>
#include <vector>

#include "scarp/output/exr.h"
#include "scarp/render/surface/ramp.h"
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

std::vector<ExrMatrix> matrices_of(const Camera& camera) {
  return {matrix("worldToCamera", camera.camera_from_world()), matrix("worldToNDC", camera.ndc_from_world())};
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
  picture.matrices = matrices_of(camera);
  write_exr(file, path, picture);
}

void write_error_layers(ReplaceFile& file, const std::string& path, const Picture& picture, const Camera& camera) {
  constexpr std::array kErrors = {Verdict::early, Verdict::late, Verdict::lost, Verdict::false_hit};
  const Image& image = picture.image;
  std::vector<float> colours;
  colours.reserve(image.rgb.size());
  for (const std::uint8_t byte : image.rgb) colours.push_back(linear_from_srgb(vec3(static_cast<float>(byte) / 255)).x);
  std::array<std::vector<float>, kErrors.size()> metres;
  ExrView layers{image.width, image.height};
  for (const int i : {0, 1, 2}) layers.channels.push_back({std::string(1, "RGB"[i]), &colours[i], 3, ExrStorage::half});
  for (std::size_t i = 0; i < kErrors.size(); ++i) {
    metres[i] = picture.error_map->metres_of(kErrors[i]);
    layers.channels.push_back({std::string(name_of(kErrors[i])), metres[i].data()});
  }
  layers.matrices = matrices_of(camera);
  write_exr(file, path, layers);
}

#else

void write_layers(ReplaceFile&, const std::string&, const PictureLayers&, const Camera&, const std::vector<float>&) {}
void write_error_layers(ReplaceFile&, const std::string&, const Picture&, const Camera&) {}

#endif

}  // namespace scarp::cli
