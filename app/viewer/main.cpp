// SPDX-License-Identifier: MIT
// scarp-view: the program of `scarp view`.
#include <memory>
#include <string>
#include <vector>

#include "app/cli/command_line.h"
#include "app/cli/open_input.h"
#include "app/cli/render_settle.h"
#include "app/cli/view_options.h"
#include "app/viewer/viewer.h"
#include "scarp/base/parallel.h"

namespace {

using namespace scarp::cli;

void run(ViewOptions options, const Command& command) {
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind, options.look, march_of(options, kind)});
  const scarp::ViewSettings view = settle_picture(options);
  require_places(options);
  const scarp::ThreadLimit limit(options.threads);
  scarp::viewer::run_viewer(kind, std::move(options), view);
}

}  // namespace

int main(int argc, char** argv) {
  Program program;
  const auto options = std::make_shared<ViewOptions>();
  Command& command = declare_view(program, *options);
  command.runs([options, &command] {
    options->given = command.given();
    options->typed = command.typed_values();
    options->words = command.typed_words(kWindowOptions);
    run(*options, command);
  });
  // Its own name says which subcommand: "scarp-view dem.tif" is "scarp view dem.tif".
  std::string view = "view";
  std::vector<char*> words(argv, argv + argc);
  if (argc < 2 || view != argv[1]) words.insert(words.begin() + 1, view.data());
  return run_program(program, static_cast<int>(words.size()), words.data());
}
