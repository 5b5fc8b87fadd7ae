// SPDX-License-Identifier: MIT
#include "app/cli/picture/render_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/cli/options/scene_input.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/render/camera/compass.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp::cli {
namespace {

// Samples, or pixels of an overlay, for a picture of everything: 4 x 4 to a pixel. In a slanted view, pixels on near
// ground are about four times as dense as on average; other views need fewer samples.
constexpr std::int64_t kSamplesPerPixel = 16;

// The number of samples to read for a picture. Small pictures get as many as one of 1000 x 1000 pixels, which is read
// equally fast; views of a part get as many as rasters that are read completely.
std::int64_t samples_shown(const RenderOptions& options) {
  constexpr std::int64_t kLeast = kSamplesPerPixel * 1000 * 1000, kMost = Decimation{}.above;
  const CameraOptions& camera = options.camera;
  const PictureSettings picture = resolve(options.picture, {});
  if (options.moves || camera.eye || camera.area || !options.frames.path.empty() ||
      view_of(camera, picture.look).distance < 1 || camera.fov_deg || entry_of(picture.look).large_pixels)
    return kMost;
  // The longer side is the width; the other one follows from the raster.
  const int height = camera.top && !options.picture.width ? picture.width : picture.height;
  return std::clamp(kSamplesPerPixel * picture.width * height, kLeast, kMost);
}

// Returns whether rasters of any size are read completely; otherwise large ones are averaged.
bool reads_all_samples(const RenderOptions& options) {
  const bool measures = entry_of(look_of(options.picture)).measures;
  // Averaging would mix the shared border with its neighbours.
  return options.full || measures || options.field.wrap == Wrap::shared_border;
}

FieldView framed_by_box(const Scene& scene, const ViewSettings& view, const PictureSettings& picture) {
  return {Camera::framed(picture_box(scene), view, picture.grid_north_azimuth, picture.width, picture.height)};
}

void measure(RenderInput& input) {
  if (input.scene.box().empty()) return;
  const dvec3 size = input.scene.box().high - input.scene.box().low;
  input.subject.across = std::max(size.x, size.y);
  input.subject.heights = {input.scene.box().low.z, input.scene.box().high.z};
}

void require_ground(const HeightField& field, const std::string& path) {
  if (!field.has_cells()) {
    throw Error(fmt::format("{}: {} x {} samples have no cells between them (at least 2 x 2 are needed)", path,
                            field.cols(), field.rows()));
  }
  if (field.all_nodata())
    throw Error(fmt::format("{}: all samples are nodata (is the nodata value right? --nodata)", path));
  if (!field.has_ground())
    throw Error(
        fmt::format("{}: every cell has a nodata sample at a corner, so there is no ground to show (is the "
                    "nodata value right? --nodata)",
                    path));
}

RenderInput terrain(OpenedInput opened, bool plinth) {
  const HeightField& field = *opened.scene.only_heights();
  require_ground(field, opened.path);
  RenderInput input{plinth ? with_plinth(opened.scene) : opened.scene};
  input.subject.across = default_reach(field);
  input.subject.heights = {field.min_height(), field.max_height()};
  input.subject.exaggeration = field.settings().exaggeration;
  input.subject.grid_north_azimuth = opened.georeference.grid_north_azimuth;
  input.raster = {opened.path, opened.georeference, opened.cols, opened.rows};
  input.framed = [](const Scene& seen, const ViewSettings& of, const PictureSettings& picture) {
    return view_of_field(*seen.terrain(), picture_box(seen), of, picture.grid_north_azimuth, picture.width,
                         picture.height);
  };
  return input;
}

// Voxels and meshes.
RenderInput model(OpenedInput opened, const InputOptions& options) {
  RenderInput input{std::move(opened.scene)};
  input.coarse_voxels = options.vox_look.coarse;
  input.subject.own.sun_azimuth_deg = kModelSunAzimuth;
  input.subject.own.haze = 0;
  input.framed = framed_by_box;
  measure(input);
  return input;
}

RenderInput scene_file(OpenedInput opened, const InputOptions& options) {
  RenderInput input{std::move(opened.scene)};
  const SceneFile& document = *opened.document;
  input.subject.own = request_of(document);
  input.camera = document.camera;
  input.coarse_voxels = document.picture.coarse_voxels || options.vox_look.coarse;
  input.framed = framed_by_box;
  measure(input);
  return input;
}

// The range of heights at the points of a lattice over the square of interest.
ReliefRange heights_around(const HeightFunction& function, double extent) {
  constexpr int kSide = 129;
  ReliefRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double h = function.value(extent * (col / (kSide - 1.0) - 0.5), extent * (row / (kSide - 1.0) - 0.5));
      range = {std::min(range.low, h), std::max(range.high, h)};
    }
  }
  return range;
}

RenderInput function(OpenedInput opened, const FunctionInput& options) {
  const double extent = options.extent;
  const HeightFunction function = std::move(*opened.function);
  PictureSubject subject;
  subject.across = extent, subject.function_extent = extent;
  subject.own.haze = kFunctionHaze, subject.own.ao_distance = extent / 8;
  subject.heights = heights_around(function, extent);
  subject.sea = options.function == "sea";
  RenderInput input{Scene(opened.scene.fields(), {{.material = kFunctionMaterial}}), std::move(subject)};
  input.march = opened.scene.marches() + (options.preset.empty() ? "" : fmt::format(" as in {}", options.preset));
  input.camera.target = dvec3(0, 0, function.value(0, 0));
  input.framed = [function, extent, target = *input.camera.target](const Scene&, const ViewSettings& of,
                                                                   const PictureSettings& picture) {
    constexpr double kDegree = 3.14159265358979323846 / 180;
    validate(of);
    dvec3 eye = target + of.distance * extent * towards(of.azimuth_deg * kDegree, of.elevation_deg * kDegree, 0);
    const double least = function.value(eye.x, eye.y) + 0.01 * extent, raised = std::max(0.0, least - eye.z);
    eye.z = std::max(eye.z, least);
    return FieldView{Camera::look_at(eye, target, of.fov_deg, picture.width, picture.height), raised};
  };
  return input;
}

RenderInput with_defaults(const InputRequest& request, OpenedInput opened) {
  switch (request.kind) {
    case InputKind::terrain:
      return terrain(std::move(opened), request.plinth);
    case InputKind::scene:
      return scene_file(std::move(opened), request.input);
    case InputKind::function:
      return function(std::move(opened), request.input.function);
    case InputKind::voxels:
    case InputKind::mesh:
      break;
  }
  return model(std::move(opened), request.input);
}

}  // namespace

InputRequest input_request(InputKind kind, const RenderOptions& options) {
  InputRequest request{
      .kind = kind,
      .input = options,
      .overlay = {.overlay = options.picture_files.overlay, .overlay_fit = options.picture_files.overlay_fit},
      .plinth = !options.no_plinth,
      .voxel_drawing = options.voxel_drawing,
      .camera = options.camera};
  if (kind == InputKind::terrain && !reads_all_samples(options))
    request.input.raster.decimation.emplace().samples = samples_shown(options);
  double& reach = request.input.march_settings.function.reach;
  if (kind == InputKind::function && std::isinf(reach))
    reach = function_reach(options.picture, options.function.extent);
  if (!options.vox.volume.empty()) request.ramp = options.picture.ramp;
  if (!request.overlay.overlay.empty()) request.overlay_pixels = samples_shown(options);
  return request;
}

RenderInput open_render_input(const InputRequest& request) {
  const InputOptions& options = request.input;
  OpenedInput opened = open_input(request.kind, options, request.ramp);
  stop_if_interrupted();
  OverlayFiles overlay = read_overlay_files(request.overlay, opened.georeference, opened.cols, opened.rows,
                                            options.field.mirror, request.overlay_pixels);
  std::vector<std::string> notes = opened.notes, files = opened.files;
  files.insert(files.end(), overlay.files.begin(), overlay.files.end());
  const std::optional<SolidRange> numbers = opened.numbers;
  RenderInput input = with_defaults(request, std::move(opened));
  input.notes = std::move(notes), input.files = std::move(files), input.numbers = numbers;
  input.subject.files.drape = std::move(overlay.drape);
  if (request.kind == InputKind::function) input.function_reach = options.march_settings.function.reach;
  return input;
}

}  // namespace scarp::cli
