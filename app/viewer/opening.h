// SPDX-License-Identifier: MIT
// An input as `scarp view` is asked for it: options, and the declarations that set them.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "app/cli/view_options.h"

namespace scarp::viewer {

struct Opening {
  std::shared_ptr<cli::Program> program;  ///< its declarations are bound to `options`
  std::shared_ptr<cli::ViewOptions> options;
  cli::InputKind kind;
  ViewSettings view;
};

/// Checks the options that were typed for `command` of `program`, and settles them. Throws Error and WrongUsage.
Opening settle_opening(std::shared_ptr<cli::Program> program, std::shared_ptr<cli::ViewOptions> options,
                       const cli::Command& command);

/// The opening of a file without any option. Throws Error and WrongUsage.
Opening opening_of(const std::string& file);

/// A number of a march that can be set while the window is open, by its declaration.
struct MarchParameter {
  std::string name, help;  ///< "naive-max-steps"
  std::variant<int*, double*> to;
  double least, most;  ///< of a slider
};

/// The numbers that `march` reads.
std::vector<MarchParameter> parameters_of(const Opening& opening, std::string_view march);

/// " --naive-max-steps 300": the march's numbers that differ from the declared defaults, for a command.
std::string parameter_words(const Opening& opening, std::string_view march);

}  // namespace scarp::viewer
