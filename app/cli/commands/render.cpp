// SPDX-License-Identifier: MIT
// `scarp render`: renders an elevation model, a voxel model or a scene to a picture.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/picture_format.h"
#include "app/cli/options/render_options.h"
#include "app/cli/picture/figure.h"
#include "app/cli/picture/render_run.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/frame/picture_request.h"

namespace scarp::cli {
namespace {

// Whether the output can hold the requested content.
void check_output(const RenderOptions& options) {
  const PictureFormat& format = picture_format_of(options.output);
  const PictureSettings picture = resolve(options.picture, {});
  check_frames(options.frames, options.output);
  if ((options.depth.range || options.depth.fitted) && !format.layers) {
    throw Error("--depth-range needs an EXR picture, of which it is a channel (name the output *.exr)");
  }
  if (options.depth.fitted && options.frames.several())
    throw Error("--depth-range auto: frames share their planes (name NEAR,FAR)");
  check_figure(options.figure, picture, format);
  if (format.layers && !entry_of(options.picture.look).lit) {
    throw Error(
        fmt::format("--look {}: EXR pictures hold the look 'shaded' or 'comanche', with depth, position and steps as "
                    "channels (leave --look out, or name the output *.png)",
                    name_of(options.picture.look)));
  }
  if (format.map && options.frames.several())
    throw Error(fmt::format("output '{}': frames are pictures, not maps (name it frame-####.png)", options.output));
  if (format.map && !options.camera.top) {
    throw Error(fmt::format("output '{}': a {} is a map (add --top, or name it *.png)", options.output, format.name));
  }
}

void run(RenderOptions options, const Command& command) {
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind, name_of(options.picture.look), march_of(options, kind)});
  check_picture(options);
  check_output(options);
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  render_input(kind, std::move(options));
}

}  // namespace

void add_render(Program& program) {
  const auto options = std::make_shared<RenderOptions>();
  Command& command = declare_render(program, *options);
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
