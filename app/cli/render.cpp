// SPDX-License-Identifier: MIT
// `scarp render`: renders an elevation model, a voxel model or a scene to a picture.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/render_input.h"
#include "app/cli/render_options.h"
#include "app/cli/render_run.h"
#include "app/cli/render_settle.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {
namespace {

// Settings that depend on the output.
void settle_output(RenderOptions& options) {
  PictureSettings& picture = options.picture;
  settle_frames(options.frames, options.output);
  options.format = &picture_format_of(options.output);
  if (const auto range = depth_range_of(options.depth); range && !options.format->layers) {
    throw Error("--depth-range needs an EXR picture, of which it is a channel (name the output *.exr)");
  }
  settle_figure(options.figure, picture, *options.format);
  if (options.format->layers && picture.look != Look::shaded) {
    throw Error(
        fmt::format("--look {}: EXR pictures hold the look 'shaded', with depth, position and steps as channels "
                    "(leave --look out, or name the output *.png)",
                    options.look));
  }
  if (options.format->map && options.frames.several())
    throw Error(fmt::format("output '{}': frames are pictures, not maps (name it frame-####.png)", options.output));
  if (options.format->map && !options.top) {
    throw Error(
        fmt::format("output '{}': a {} is a map (add --top, or name it *.png)", options.output, options.format->name));
  }
  picture.alpha = options.format->map;
}

void run(RenderOptions options, const Command& command) {
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind, options.look, march_of(options, kind)});
  const ViewSettings view = settle_picture(options);
  settle_output(options);
  keep_inputs(options.output, options.typed);
  require_places(options);
  const ThreadLimit limit(options.threads);
  render_input(kind, std::move(options), view);
}

}  // namespace

void add_render(Program& program) {
  const auto options = std::make_shared<RenderOptions>();
  Command& command = declare_render(program, *options);
  command.runs([options, &command] {
    options->given = command.given();
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
