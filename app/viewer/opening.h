// SPDX-License-Identifier: MIT
// An input as `scarp view` is asked for it: options, and the declarations that set them.
//
// Whatever the window sets is a change of an option's text, which is then read as if it had been typed. So the window
// cannot show a picture that no command makes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/view_options.h"

namespace scarp::viewer {

/// An option with its values, as typed.
struct GivenOption {
  std::string name;
  std::vector<std::string> values;
};

struct Opening {
  std::shared_ptr<cli::Program> program;  ///< its declarations are bound to `options`
  std::shared_ptr<cli::ViewOptions> options;
  cli::InputKind kind;
  /// Everything that was typed or set in the window, the newest last; those that have no effect now are not in
  /// `options`.
  std::vector<GivenOption> given{};

  const cli::Command& command() const { return *program->find("view"); }
};

/// Checks the options that were typed for `command` of `program`, and takes them over. Throws Error and WrongUsage.
Opening settle_opening(std::shared_ptr<cli::Program> program, std::shared_ptr<cli::ViewOptions> options,
                       const cli::Command& command);

/// The opening of a file without any option. Throws Error and WrongUsage.
Opening opening_of(const std::string& file);

/// Another value of an option; nullopt: it is not given. Flags have the value "true".
struct OptionChange {
  std::string option;
  std::optional<std::string> text;
};

/// The same input with a change. Other options that have no effect beside it, or cannot be combined with it, rest until
/// they have again. Throws Error and WrongUsage: no such option, a wrong value, one without effect.
Opening changed(const Opening& before, const OptionChange& change);

/// The names of the options of which one has another value than the other.
std::vector<std::string> differences(const Opening& a, const Opening& b);

}  // namespace scarp::viewer
