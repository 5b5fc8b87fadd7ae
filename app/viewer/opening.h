// SPDX-License-Identifier: MIT
// An input of `scarp view`: options, and the declarations that set them.
//
// Every setting of the window is a change of an option's text, which is then parsed as if it had been typed. The window
// therefore cannot show a picture that no command produces.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/view_options.h"

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
  /// All options that were typed or set in the window, the newest last. Those without a current effect are not in
  /// `options`.
  std::vector<GivenOption> given{};

  const cli::Command& command() const { return *program->find("view"); }
};

/// Checks the options that were typed for `command` of `program`, and takes them over. Throws Error and WrongUsage.
Opening settle_opening(std::shared_ptr<cli::Program> program, std::shared_ptr<cli::ViewOptions> options,
                       const cli::Command& command);

/// Opens files without any options, as the arguments of a command. Throws Error and WrongUsage.
Opening opening_of(const std::vector<std::string>& files);

/// Changes the value of an option; nullopt removes it. Flags have the value "true".
struct OptionChange {
  std::string option;
  std::optional<std::string> text;
};

/// The same input with a change. Other options that lose their effect, or cannot be combined with it, are suspended
/// until they apply again. Throws Error and WrongUsage for an unknown option, a wrong value, or an option without
/// effect.
Opening changed(const Opening& before, const OptionChange& change);
/// The same input with these options, some of which may be suspended. Throws Error and WrongUsage.
Opening with_options(const Opening& before, std::vector<GivenOption> given);

}  // namespace scarp::viewer
