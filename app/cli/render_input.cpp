// SPDX-License-Identifier: MIT
#include "app/cli/render_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/cli/kept_inputs.h"
#include "app/cli/progress.h"
#include "app/cli/scene_input.h"
#include "scarp/base/error.h"
#include "scarp/render/camera/compass.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp::cli {
namespace {

constexpr double kFaintest = 64;   // rays end where haze hides all except 1 / 64 of a colour
constexpr double kLongReach = 64;  // extents, where there is less haze

// Samples, or pixels of an overlay, for a picture of everything: 4 x 4 per pixel. In the near ground of a slanted view,
// pixels are about four times as dense as on average.
constexpr std::int64_t kSamplesPerPixel = 16;

// Number of samples for a picture. A small picture uses as many as one of 1000 x 1000 pixels, which read equally fast;
// views of a part use as many as rasters that are read completely.
std::int64_t samples_shown(const RenderOptions& options, const ViewSettings& view) {
  constexpr std::int64_t kLeast = kSamplesPerPixel * 1000 * 1000, kMost = Decimation{}.above;
  const PictureSettings& picture = options.picture;
  if (options.moves || !options.eye.empty() || !options.area.empty() || !options.frames.path.empty() ||
      view.distance < 1 || options.is_given("--fov") || picture.look == Look::comanche)
    return kMost;
  // The longer side is the width; the other one follows from the raster.
  const int height = options.top && options.size.empty() ? picture.width : picture.height;
  return std::clamp(kSamplesPerPixel * picture.width * height, kLeast, kMost);
}

std::optional<Decimation> decimation_for(const RenderOptions& options, const ViewSettings& view) {
  if (reads_all_samples(options)) return {};
  Decimation decimation;
  decimation.samples = samples_shown(options, view);
  return decimation;
}

// Framed by its box.
void frame_by_box(RenderInput& input, const RenderOptions& options) {
  input.framed = [&picture = options.picture](const Scene& scene, const ViewSettings& view) {
    return FieldView{
        Camera::framed(picture_box(scene), view, picture.grid_north_azimuth, picture.width, picture.height)};
  };
}

void measure(RenderInput& input) {
  if (input.scene.box().empty()) return;
  const dvec3 size = input.scene.box().high - input.scene.box().low;
  input.across = std::max(size.x, size.y);
  input.heights = {input.scene.box().low.z, input.scene.box().high.z};
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

// Meadows, dry grass and snow by height, rock on steep ground; or one of the ramps. The last one is the function's.
std::vector<Material> materials_of(const ReliefRange& range, const std::string& ramp) {
  if (!ramp.empty()) return {HeightRamp{ramp, range.low, range.high}};
  const auto at = [&](double share) { return range.low + share * (range.high - range.low); };
  return {HeightStops{{{at(0.0), {0.40f, 0.47f, 0.30f}},
                       {at(0.35), {0.50f, 0.53f, 0.33f}},
                       {at(0.6), {0.62f, 0.57f, 0.42f}},
                       {at(0.8), {0.66f, 0.62f, 0.57f}},
                       {at(0.88), {0.93f, 0.94f, 0.96f}}}},
          PlainColour{{0.47f, 0.43f, 0.40f}}, Blend{Blend::By::slope, 30, 45, 0, 1}};
}

// Limits rays over functions to the distance at which haze hides everything.
void settle_function(RenderOptions& options) {
  const double extent = options.function.extent;
  PictureSettings& picture = options.picture;
  const double haze = options.is_given("--haze") ? picture.haze : kFunctionHaze;
  picture.haze = haze;
  picture.haze_distance = haze > 0 ? -extent / std::log1p(-haze) : kUnlimited;
  double& reach = options.march_settings.function.reach;
  if (std::isinf(reach)) reach = std::min(picture.haze_distance * std::log(kFaintest), kLongReach * extent);
  if (std::isinf(picture.ao_distance)) picture.ao_distance = extent / 8;
}

void paint_function(const ReliefRange& heights, RenderOptions& options) {
  const double extent = options.function.extent;
  PictureSettings& picture = options.picture;
  picture.ground_box =
      WorldBox{{-0.5 * extent, -0.5 * extent, heights.low}, {0.5 * extent, 0.5 * extent, heights.high}};
  // The renderer paints ramps from files and natural ground.
  if (!picture.ground.natural && !picture.ramp_stops)
    picture.materials = materials_of(picture.ramp_range.value_or(heights), picture.ramp);
}

// The input's own settings apply where no option was given.
void take_defaults(InputKind kind, const RenderInput& input, RenderOptions& options) {
  PictureSettings& picture = options.picture;
  switch (kind) {
    case InputKind::terrain:
      picture.grid_north_azimuth = input.raster.georeference.grid_north_azimuth;
      return;
    case InputKind::scene:
      if (!options.is_given("--haze")) picture.haze = 0;
      take_environment(*input.document, options.given, options.look_options);
      settle_environment(options.look_options, picture);
      picture = picture_of(*input.document, picture, options.given);
      return;
    case InputKind::function:
      paint_function(input.heights, options);
      return;
    case InputKind::voxels:
    case InputKind::mesh:
      if (!options.is_given("--sun")) picture.sun.azimuth_deg = kModelSunAzimuth;
      if (!options.is_given("--haze")) picture.haze = 0;
  }
}

RenderInput terrain(OpenedInput opened, RenderOptions& options, const ViewSettings& view) {
  const HeightField& field = *opened.scene.only_heights();
  require_ground(field, opened.path);
  RenderInput input{options.no_plinth ? opened.scene : with_plinth(opened.scene)};
  input.view = view;
  input.across = default_reach(field), input.heights = {field.min_height(), field.max_height()};
  input.exaggeration = field.settings().exaggeration;
  input.raster = {opened.path, opened.georeference, opened.cols, opened.rows};
  take_defaults(InputKind::terrain, input, options);
  input.framed = [&picture = options.picture](const Scene& seen, const ViewSettings& of) {
    return view_of_field(*seen.terrain(), picture_box(seen), of, picture.grid_north_azimuth, picture.width,
                         picture.height);
  };
  return input;
}

// Voxels and meshes.
RenderInput model(OpenedInput opened, RenderOptions& options, const ViewSettings& view) {
  RenderInput input{std::move(opened.scene)};
  input.view = view;
  input.coarse_voxels = options.vox_look.coarse;
  take_defaults(InputKind::voxels, input, options);
  frame_by_box(input, options);
  measure(input);
  return input;
}

RenderInput scene_file(OpenedInput opened, RenderOptions& options, const ViewSettings& view) {
  RenderInput input{std::move(opened.scene)};
  input.document = std::make_shared<const SceneFile>(std::move(*opened.document));
  take_defaults(InputKind::scene, input, options);
  const SceneFile& document = *input.document;
  input.view = view_of(document, view, options.given);
  input.coarse_voxels = document.picture.coarse_voxels || options.vox_look.coarse;
  input.viewed = document.camera.azimuth_deg || document.camera.elevation_deg || document.camera.distance;
  input.eye = document.camera.eye, input.target = document.camera.target;
  frame_by_box(input, options);
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

RenderInput function(OpenedInput opened, RenderOptions& options, const ViewSettings& view) {
  const double extent = options.function.extent;
  PictureSettings& picture = options.picture;
  const HeightFunction function = std::move(*opened.function);
  const ReliefRange heights = heights_around(function, extent);
  paint_function(heights, options);
  const auto material = static_cast<std::uint32_t>(std::max<std::size_t>(picture.materials.size(), 1) - 1);
  RenderInput input{Scene(opened.scene.fields(), {{.material = material}})};
  input.march = opened.scene.marches() +
                (options.function.preset.empty() ? "" : fmt::format(" as in {}", options.function.preset));
  input.view = kFunctionView;
  if (options.is_given("--view")) input.view = view;
  if (options.is_given("--fov")) input.view.fov_deg = view.fov_deg;
  input.across = extent, input.heights = heights;
  input.target = dvec3(0, 0, function.value(0, 0));
  input.framed = [function, extent, target = *input.target, &picture](const Scene&, const ViewSettings& of) {
    constexpr double kDegree = 3.14159265358979323846 / 180;
    validate(of);
    dvec3 eye = target + of.distance * extent * towards(of.azimuth_deg * kDegree, of.elevation_deg * kDegree, 0);
    const double least = function.value(eye.x, eye.y) + 0.01 * extent, raised = std::max(0.0, least - eye.z);
    eye.z = std::max(eye.z, least);
    return FieldView{Camera::look_at(eye, target, of.fov_deg, picture.width, picture.height), raised};
  };
  return input;
}

RenderInput with_defaults(InputKind kind, OpenedInput opened, RenderOptions& options, const ViewSettings& view) {
  switch (kind) {
    case InputKind::terrain:
      return terrain(std::move(opened), options, view);
    case InputKind::scene:
      return scene_file(std::move(opened), options, view);
    case InputKind::function:
      return function(std::move(opened), options, view);
    case InputKind::voxels:
    case InputKind::mesh:
      break;
  }
  return model(std::move(opened), options, view);
}

}  // namespace

bool RenderOptions::is_given(std::string_view option) const { return cli::is_given(given, option); }

// Measuring looks do.
bool reads_all_samples(const RenderOptions& options) {
  const Look look = options.picture.look;
  const bool measures = look == Look::steps || look == Look::error || look == Look::level;
  // The shared border would be averaged with its neighbours.
  return options.full || measures || options.field.wrap == Wrap::shared_border;
}

RenderInput open_render_input(InputKind kind, RenderOptions& options, const ViewSettings& view) {
  if (kind == InputKind::function) settle_function(options);
  if (kind == InputKind::terrain) options.raster.decimation = decimation_for(options, view);
  OpenedInput opened = open_input(kind, options, options.picture.ramp);
  stop_if_interrupted();
  std::vector<std::string> notes = opened.notes, files = opened.files;
  const std::vector<std::string> overlay =
      read_overlay_files(options.look_options, opened.georeference, opened.cols, opened.rows, options.field.mirror,
                         samples_shown(options, view), options.picture);
  files.insert(files.end(), overlay.begin(), overlay.end());
  keep_inputs(options.output, files);
  const std::optional<SolidRange> numbers = opened.numbers;
  RenderInput input = with_defaults(kind, std::move(opened), options, view);
  input.numbers = numbers;
  const bool in_perspective =
      !options.top && (options.picture.look == Look::shaded || options.picture.look == Look::comanche);
  if (kind == InputKind::terrain && in_perspective && !options.is_given("--exaggeration")) {
    const double side = default_reach(*input.scene.terrain());
    if (const std::string note = flatness_note(input.heights.high - input.heights.low, side); !note.empty())
      notes.push_back(note);
  }
  input.notes = std::move(notes), input.files = std::move(files);
  return input;
}

void settle_again(InputKind kind, const RenderInput& input, const RenderOptions& before, RenderOptions& options) {
  if (kind == InputKind::function) settle_function(options);
  options.picture.ground.drape = before.picture.ground.drape;
  take_defaults(kind, input, options);
}

}  // namespace scarp::cli
