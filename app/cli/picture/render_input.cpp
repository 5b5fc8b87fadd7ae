// SPDX-License-Identifier: MIT
#include "app/cli/picture/render_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/scene_input.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/render/camera/compass.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp::cli {
namespace {

// Samples, or pixels of an overlay, for a picture of everything: 4 x 4 to a pixel. The near ground of a slanted view
// has pixels about four times as close as the mean, and other views have enough.
constexpr std::int64_t kSamplesPerPixel = 16;

// The samples that a picture shows. A small picture has as many as one of 1000 x 1000 pixels, which reads equally fast;
// views of a part have as many as rasters that are read completely.
std::int64_t samples_shown(const RenderOptions& options, ImageSize size) {
  constexpr std::int64_t kLeast = kSamplesPerPixel * 1000 * 1000, kMost = Decimation{}.above;
  const CameraOptions& camera = options.camera;
  const PictureSettings picture = resolve(options.picture, {.size = size});
  if (options.moves || camera.eye || camera.area || !options.frames.path.empty() ||
      view_of(camera, picture.look).distance < 1 || camera.fov_deg || entry_of(picture.look).large_pixels)
    return kMost;
  // The longer side is the width; the other one follows from the raster.
  const int height = camera.top && !options.picture.width ? picture.width : picture.height;
  return std::clamp(kSamplesPerPixel * picture.width * height, kLeast, kMost);
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

RenderInput terrain(OpenedInput opened, const RenderOptions& options) {
  const HeightField& field = *opened.scene.only_heights();
  require_ground(field, opened.path);
  RenderInput input{options.no_plinth ? opened.scene : with_plinth(opened.scene)};
  input.view = view_of(options.camera, look_of(options.picture));
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
RenderInput model(OpenedInput opened, const RenderOptions& options) {
  RenderInput input{std::move(opened.scene)};
  input.view = view_of(options.camera, look_of(options.picture));
  input.coarse_voxels = options.vox_look.coarse;
  input.subject.own.sun_azimuth_deg = kModelSunAzimuth;
  input.subject.own.haze = 0;
  input.framed = framed_by_box;
  measure(input);
  return input;
}

RenderInput scene_file(OpenedInput opened, const RenderOptions& options) {
  RenderInput input{std::move(opened.scene)};
  const SceneFile& document = *opened.document;
  check_effect(options.picture, document);
  input.subject.own = request_of(document);
  input.view = view_of(document, options.camera, look_of(options.picture));
  input.coarse_voxels = document.picture.coarse_voxels || options.vox_look.coarse;
  input.viewed = document.camera.azimuth_deg || document.camera.elevation_deg || document.camera.distance;
  input.eye = document.camera.eye, input.target = document.camera.target;
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

RenderInput function(OpenedInput opened, const RenderOptions& options) {
  const double extent = options.function.extent;
  const HeightFunction function = std::move(*opened.function);
  PictureSubject subject;
  subject.across = extent, subject.function_extent = extent;
  subject.own.haze = kFunctionHaze, subject.own.ao_distance = extent / 8;
  subject.heights = heights_around(function, extent);
  RenderInput input{Scene(opened.scene.fields(), {{.material = kFunctionMaterial}}), std::move(subject)};
  input.march = opened.scene.marches() +
                (options.function.preset.empty() ? "" : fmt::format(" as in {}", options.function.preset));
  const ViewSettings typed = view_of(options.camera, look_of(options.picture));
  input.view = options.camera.view ? typed : kFunctionView;
  if (options.camera.fov_deg) input.view.fov_deg = typed.fov_deg;
  input.target = dvec3(0, 0, function.value(0, 0));
  input.framed = [function, extent, target = *input.target](const Scene&, const ViewSettings& of,
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

RenderInput with_defaults(InputKind kind, OpenedInput opened, const RenderOptions& options) {
  switch (kind) {
    case InputKind::terrain:
      return terrain(std::move(opened), options);
    case InputKind::scene:
      return scene_file(std::move(opened), options);
    case InputKind::function:
      return function(std::move(opened), options);
    case InputKind::voxels:
    case InputKind::mesh:
      break;
  }
  return model(std::move(opened), options);
}

// The input of rays: large rasters in the detail of the picture, functions up to the view distance.
InputOptions input_of(InputKind kind, const RenderOptions& options, ImageSize size) {
  InputOptions input = options;
  if (kind == InputKind::terrain && !reads_all_samples(options)) {
    input.raster.decimation.emplace();
    input.raster.decimation->samples = samples_shown(options, size);
  }
  double& reach = input.march_settings.function.reach;
  if (kind == InputKind::function && std::isinf(reach))
    reach = function_reach(options.picture, options.function.extent);
  return input;
}

}  // namespace

// Applies to looks that measure.
bool reads_all_samples(const RenderOptions& options) {
  const Look look = look_of(options.picture);
  const bool measures = entry_of(look).measures;
  // The shared border would be averaged with its neighbours.
  return options.full || measures || options.field.wrap == Wrap::shared_border;
}

RenderInput open_render_input(InputKind kind, const RenderOptions& options, ImageSize size) {
  const InputOptions input_options = input_of(kind, options, size);
  OpenedInput opened = open_input(kind, input_options, options.picture.ramp);
  stop_if_interrupted();
  std::vector<std::string> notes = opened.notes, read = opened.files;
  OverlayFiles overlay = read_overlay_files(options.picture_files, opened.georeference, opened.cols, opened.rows,
                                            options.field.mirror, samples_shown(options, size));
  read.insert(read.end(), overlay.files.begin(), overlay.files.end());
  keep_inputs(options.output, read);
  const std::optional<SolidRange> numbers = opened.numbers;
  RenderInput input = with_defaults(kind, std::move(opened), options);
  input.numbers = numbers;
  input.subject.files.drape = std::move(overlay.drape);
  input.subject.interpolate = options.march_settings.fixed_step.interpolate;
  input.all_samples = reads_all_samples(options);
  if (kind == InputKind::function) input.function_reach = input_options.march_settings.function.reach;
  const Look look = look_of(options.picture);
  const bool in_perspective = !options.camera.top && entry_of(look).lit;
  if (kind == InputKind::terrain && in_perspective && !options.exaggeration.given) {
    const double side = default_reach(*input.scene.terrain());
    const ReliefRange& heights = input.subject.heights;
    if (const std::string note = flatness_note(heights.high - heights.low, side); !note.empty()) notes.push_back(note);
  }
  input.notes = std::move(notes), input.files = std::move(read);
  return input;
}

}  // namespace scarp::cli
