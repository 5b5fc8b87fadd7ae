// SPDX-License-Identifier: MIT
// `scarp render`: renders an elevation model, a voxel model or a scene to a picture.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/animation.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/picture_format.h"
#include "app/cli/options/render_options.h"
#include "app/cli/picture/comparison.h"
#include "app/cli/picture/figure.h"
#include "app/cli/picture/film.h"
#include "app/cli/picture/render_run.h"
#include "app/cli/progress.h"
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
  if (options.depth.buffer() && !format.layers) {
    throw Error(fmt::format("{} needs an EXR picture, of which it is a channel (name the output *.exr)",
                            options.depth.range || options.depth.fitted ? "--depth-range" : "--depth-reversed"));
  }
  if (options.depth.buffer() && !options.depth.range && options.frames.several())
    throw Error("all frames need the same planes of depth (give --depth-range NEAR,FAR)");
  check_figure(options.figure, picture, format);
  check_comparison(options, format);
  if (format.layers && !entry_of(picture.look).lit && picture.look != Look::error) {
    throw Error(
        fmt::format("--look {}: EXR pictures hold the looks 'shaded' and 'comanche', with depth, position and steps as "
                    "channels, or 'error', with its metres (leave --look out, or name the output *.png)",
                    name_of(options.picture.look)));
  }
  if (format.map && options.frames.several())
    throw Error(fmt::format("output '{}': frames are pictures, not maps (name it frame-####.png)", options.output));
  if (writes_numbers(options) && !options.figure.any().empty())
    throw Error(
        fmt::format("{}: '{}' holds numbers, not a picture (name it *.png)", options.figure.any(), options.output));
  if (format.map && !options.camera.top) {
    throw Error(fmt::format("output '{}': a {} is a map (add --top, or name it *.png)", options.output, format.name));
  }
}

void require_effect(const RenderOptions& options, InputKind kind, const Command& command) {
  std::vector<Use> uses;
  const std::string_view look = name_of(options.picture.look);
  for (const std::string& march : options.compared) uses.push_back({kind, look, march});
  if (uses.empty()) return command.require_effect({kind, look, march_of(options, kind)});
  command.require_effect_of_any(uses);
}

// Everything that is known before a file is read.
InputKind checked(const RenderOptions& options, const Command& command) {
  const InputKind kind = kind_of_input(command, options);
  require_effect(options, kind, command);
  check_picture(options);
  check_output(options);
  keep_inputs(options.output, options.typed);
  return kind;
}

// Sets the options of a frame.
void set_frame(const std::vector<Animation>& animations, int frame, int frames, Command& command) {
  for (const Animation& animation : animations) animation.set(command, frames > 1 ? frame / (frames - 1.0) : 0.0);
}

void run_animation(RenderOptions& options, Command& command) {
  std::vector<Animation> animations;
  for (const std::string& text : options.frames.animated) animations.emplace_back(command, text);
  const int frames = options.frames.chosen();
  InputKind kind{};
  for (int i = 0; i < frames; ++i) {
    set_frame(animations, i, frames, command);
    kind = checked(options, command);
  }
  render_animation(kind, options, [&](int i) {
    set_frame(animations, i, frames, command);
    return options;
  });
}

void run_frames(RenderOptions& options, Command& command) {
  if (!options.frames.animated.empty()) return run_animation(options, command);
  const InputKind kind = checked(options, command);
  render_input(kind, options);
}

void run(RenderOptions& options, Command& command) {
  const ThreadLimit limit(options.threads);
  const auto silence = options.quiet ? std::make_optional<SilentProgress>() : std::nullopt;
  options.frames.quiet = options.quiet;
  if (!is_film(options.output)) return run_frames(options, command);
  if (!options.frames.several()) {
    throw Error(fmt::format("output '{}': a film needs frames (add --animate, --turntable or --path, or name it *.png)",
                            options.output));
  }
  keep_inputs(options.output, options.typed);
  Film film(options.output);
  options.frames.film = std::exchange(options.output, film.frame());
  options.frames.add_to_film = [&] { film.add_frame(options.frames.per_second); };
  options.frames.end_film = [&] { film.finish(); };
  run_frames(options, command);
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
