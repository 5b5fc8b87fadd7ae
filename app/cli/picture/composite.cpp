// SPDX-License-Identifier: MIT
// `scarp composite`: combines another renderer's picture with ours by depth, pixel by pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/depth_options.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/picture_format.h"
#include "app/cli/options/shared_options.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/output/png.h"
#include "scarp/render/film/film.h"
#include "scarp/source/raster/exr_raster.h"
#ifdef SCARP_OPENEXR
#include "scarp/output/exr.h"
#endif

namespace scarp::cli {
namespace {

struct CompositeOptions {
  std::string ours, theirs, output, alpha, depth_channel = "Z";
  bool no_tone_curve = false;
  DepthOptions depth;
};

// Depths of a picture; NaN and infinity mean nothing was hit.
ExrSamples read_depth(const std::string& path, const std::string& channel) {
  if (!std::filesystem::exists(path))
    throw Error(fmt::format("picture '{}': does not exist (name an EXR picture)", path));
  ExrSamples depth = read_exr_channel(path, channel);
  std::replace_if(
      depth.values.begin(), depth.values.end(), [](float z) { return std::isnan(z); },
      std::numeric_limits<float>::infinity());
  return depth;
}

// Surfaces within a metre of the camera are rarer than a depth buffer read without its planes.
bool like_a_buffer(const std::vector<float>& depths) {
  return std::none_of(depths.begin(), depths.end(), [](float z) { return std::isfinite(z) && (z < 0 || z > 1); }) &&
         std::any_of(depths.begin(), depths.end(), [](float z) { return std::isfinite(z); });
}

std::vector<vec3> read_colour(const std::string& path) {
  std::vector<vec3> colour;
  int axis = 0;
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float> values = read_exr_channel(path, name).values;
    colour.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) colour[i][axis] = std::isnan(values[i]) ? 0.0f : values[i];
    ++axis;
  }
  return colour;
}

void write(const std::string& path, int width, int height, const std::vector<vec3>& colour,
           const std::vector<float>& depth, bool tone_curve) {
  ReplaceFile file(path);
  if (extension_of(path) == ".png") {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const vec3& linear = colour[static_cast<std::size_t>(y * width + x)];
        set_pixel(image, x, y, tone_curve ? toned(linear) : linear);
      }
    }
    return write_png(file, path, {image.rgb.data(), width, height});
  }
#ifdef SCARP_OPENEXR
  ExrView view{width, height};
  view.channels = {{"R", &colour.data()->x, 3, ExrStorage::half},
                   {"G", &colour.data()->x + 1, 3, ExrStorage::half},
                   {"B", &colour.data()->x + 2, 3, ExrStorage::half},
                   {"Z", depth.data()}};
  write_exr(file, path, view);
#else
  throw Error(fmt::format("output '{}': this scarp was built without OpenEXR (name it *.png)", path));
#endif
}

void run(const CompositeOptions& options) {
  const PictureKind format = picture_format_of(options.output).kind;
  if (format != PictureKind::png && format != PictureKind::exr)
    throw Error(fmt::format("output '{}': composites are PNG or EXR (name it *.png or *.exr)", options.output));
  const auto range = depth_range_of(options.depth);
  ExrSamples ours = read_depth(options.ours, "Z");
  const ExrSamples theirs = read_depth(options.theirs, options.depth_channel);
  if (theirs.width != ours.width || theirs.height != ours.height) {
    throw Error(fmt::format("picture '{}': {} x {} pixels, where '{}' has {} x {}; render both in one size",
                            options.theirs, theirs.width, theirs.height, options.ours, ours.width, ours.height));
  }
  if (!range && like_a_buffer(theirs.values)) {
    fmt::print(stderr,
               "note: {}: all depths in channel {} are 0 to 1 m (if they are those of a depth buffer, add "
               "--depth-range NEAR,FAR)\n",
               options.theirs, options.depth_channel);
  }
  std::vector<float>& depth = ours.values;
  std::vector<vec3> colour = read_colour(options.ours);
  const std::vector<vec3> their_colour = read_colour(options.theirs);
  std::vector<float> alpha(depth.size(), 1.0f);
  if (!options.alpha.empty()) alpha = read_exr_channel(options.theirs, options.alpha).values;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    double z = theirs.values[i];
    if (range) {
      // Pixels on the far plane were never drawn.
      const bool cleared = range->reversed ? z <= 0 : z >= 1;
      z = cleared ? std::numeric_limits<double>::infinity() : view_depth_from_device(z, *range);
    }
    if (!(z < depth[i]) || alpha[i] <= 0) continue;
    ++taken;
    // EXR colours are premultiplied with alpha.
    colour[i] = their_colour[i] + colour[i] * (1 - alpha[i]);
    depth[i] = static_cast<float>(z);
  }
  write(options.output, ours.width, ours.height, colour, depth, !options.no_tone_curve);
  fmt::print("{}: {} x {} pixels, {} of them from {}\n", options.output, ours.width, ours.height, taken,
             options.theirs);
}

}  // namespace

void add_composite(Program& program) {
  Command& command = program.add("composite", "Combine a picture of another renderer with one of scarp by depth");
  const auto options = std::make_shared<CompositeOptions>();
  CompositeOptions& o = *options;
  command.add(
      &o.ours,
      {.names = "OURS", .help = "EXR picture of 'scarp render': R, G, B and Z", .files = "exr", .required = true});
  command.add(&o.theirs, {.names = "THEIRS",
                          .help = "EXR picture of the same camera and size: R, G, B and a depth",
                          .files = "exr",
                          .required = true});
  add_output_option(command, o.output, "picture: .png, or .exr with Z", "png exr");
  command.add(&o.depth_channel,
              {.names = "--depth-channel",
               .value = "NAME",
               .help = "their depth: metres along the view axis, or device depth with --depth-range"});
  command.add(&o.alpha, {.names = "--alpha",
                         .value = "NAME",
                         .help = "their opacity channel, by which their colours are multiplied",
                         .fallback = "none"});
  add_tone_option(command, &o.no_tone_curve, o.output, Topic::general);
  add_read_depth_options(command, o.depth);
  command.example("scarp composite terrain.exr ship.exr -o both.png");
  command.runs([options, &command] {
    command.require_effect({});
    keep_inputs(options->output, command.typed_values());
    run(*options);
  });
}

}  // namespace scarp::cli
