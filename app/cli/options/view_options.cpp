// SPDX-License-Identifier: MIT
#include "app/cli/options/view_options.h"

namespace scarp::cli {

const std::vector<std::string_view> kWindowOptions = {
    "--size", "--view",          "--eye",        "--eye-above", "--target",  "--fov",  "--top",
    "--area", "--window-device", "--validation", "--record",    "--timings", "--play", "--screenshot"};

Command& declare_view(Program& program, ViewOptions& o) {
  Command& command = program.add("view", "Open a window on an elevation model, voxels, a mesh, a scene or a function");
  declare_picture(command, o, false);
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::window;
    command.add(std::move(to), std::move(option));
  };
  add(&o.record,
      {.names = "--record", .value = "FILE", .help = "file to record input events in", .files = "*", .writes = true});
  add(&o.play, {.names = "--play",
                .value = "FILE",
                .help = "recording to play at 60 steps per recorded second; then the window closes",
                .files = "*",
                .excludes = {"--record"}});
  add(&o.screenshot, {.names = "--screenshot",
                      .value = "FILE",
                      .help = "PNG screenshot, taken when the last view of --play is complete",
                      .files = "png",
                      .writes = true,
                      .rules = {needs("--play FILE", [&o] { return !o.play.empty(); })}});
  add(&o.timings, {.names = "--timings",
                   .value = "FILE",
                   .help = "table of event and picture-presentation times",
                   .files = "csv",
                   .writes = true});
  add(&o.window_device, {.names = "--window-device",
                         .value = "NAME",
                         .help = "Vulkan device that shows the window: auto or part of a name",
                         .fallback = o.window_device});
  add(&o.validation, {.names = "--validation", .help = "fail if Vulkan's validation layer reports a problem"});
  command.example("scarp view dem.tif");
  command.example("scarp view city.vox --samples 16");
  command.example("scarp view dem.tif --march naive --look steps");
  command.footer("Press F1 in the window for a list of mouse and keyboard controls.");
  return command;
}

}  // namespace scarp::cli
