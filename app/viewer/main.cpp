// SPDX-License-Identifier: MIT
// scarp-view: the program of `scarp view`.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/cli/options/view_options.h"
#include "app/viewer/opening.h"
#include "app/viewer/viewer.h"
#include "scarp/base/parallel.h"

int main(int argc, char** argv) {
  using namespace scarp;
  const auto program = std::make_shared<cli::Program>(cli::about_scarp());
  const auto options = std::make_shared<cli::ViewOptions>();
  cli::Command& command = declare_view(*program, *options);
  command.runs([&] {
    viewer::Opening opening = viewer::settle_opening(program, options, command);
    const ThreadLimit limit(options->threads);
    viewer::run_viewer(std::move(opening));
  });
  // Its name implies the subcommand: "scarp-view dem.tif" is "scarp view dem.tif".
  std::string view = "view";
  std::vector<char*> words(argv, argv + argc);
  if (argc < 2 || view != argv[1]) words.insert(words.begin() + 1, view.data());
  return cli::run_program(*program, static_cast<int>(words.size()), words.data());
}
