// SPDX-License-Identifier: MIT
#include "app/viewer/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/options/kept_inputs.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::viewer {
namespace {

cli::Use use_of(cli::InputKind kind, const cli::ViewOptions& options) {
  return {kind, name_of(options.picture.look), cli::march_of(options, kind)};
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool excludes(const cli::Declared& one, const cli::Declared& other) {
  return contains(one.option.excludes, other.name) || contains(other.option.excludes, one.name);
}

// Omits options that cannot be combined with newer ones.
std::vector<GivenOption> combinable(const cli::Command& command, const std::vector<GivenOption>& given) {
  std::vector<GivenOption> used;
  for (auto one = given.rbegin(); one != given.rend(); ++one) {
    const cli::Declared& declared = *command.find(one->name);
    if (std::none_of(used.begin(), used.end(),
                     [&](const GivenOption& newer) { return excludes(declared, *command.find(newer.name)); }))
      used.push_back(*one);
  }
  std::reverse(used.begin(), used.end());
  return used;
}

struct Parsed {
  std::shared_ptr<cli::Program> program = std::make_shared<cli::Program>(cli::about_scarp());
  std::shared_ptr<cli::ViewOptions> options = std::make_shared<cli::ViewOptions>();
  cli::Command& command = declare_view(*program, *options);

  explicit Parsed(const std::vector<GivenOption>& given) {
    command.runs([] {});
    std::vector<cli::Command::Typed> typed;
    for (const GivenOption& one : given) typed.push_back({command.find(one.name), one.values});
    command.run(std::move(typed));
  }
};

// The window never writes to its inputs.
void keep_inputs(const cli::ViewOptions& options) {
  for (const std::string& output : {options.record, options.screenshot, options.timings}) {
    std::vector<std::string> others = options.typed;
    if (const auto own = std::find(others.begin(), others.end(), output); own != others.end()) others.erase(own);
    if (!output.empty()) cli::keep_inputs(output, others);
  }
}

void require_png(const std::string& screenshot) {
  if (!screenshot.empty() && extension_of(screenshot) != ".png")
    throw Error(fmt::format("--screenshot '{}': is written as PNG (let the name end in .png)", screenshot));
}

}  // namespace

Opening settle_opening(std::shared_ptr<cli::Program> program, std::shared_ptr<cli::ViewOptions> options,
                       const cli::Command& command) {
  cli::ViewOptions& o = *options;
  o.moves = true;
  o.typed = command.typed_values();
  const cli::InputKind kind = cli::kind_of_input(command, o);
  command.require_effect(use_of(kind, o));
  cli::check_picture(o);
  require_png(o.screenshot);
  keep_inputs(o);
  std::vector<GivenOption> given;
  for (const cli::Command::Typed& one : command.all_typed()) given.push_back({one.option->name, one.values});
  return {std::move(program), std::move(options), kind, std::move(given)};
}

Opening opening_of(const std::vector<std::string>& files) {
  const Parsed parsed({{"IN", files}});
  return settle_opening(parsed.program, parsed.options, parsed.command);
}

namespace {

// `set` may not be suspended; empty: all may be.
Opening opened_with(const Opening& before, std::vector<GivenOption> given, const std::string& set) {
  std::vector<GivenOption> used = combinable(before.command(), given);
  for (;;) {
    const Parsed parsed(used);
    const cli::Use use = use_of(cli::kind_of_input(parsed.command, *parsed.options), *parsed.options);
    const std::vector<std::string> idle = parsed.command.without_effect(use);
    if (contains(idle, set)) cli::require_effect(*parsed.command.find(set), use);  // throws
    if (idle.empty()) {
      Opening opening = settle_opening(parsed.program, parsed.options, parsed.command);
      opening.given = std::move(given);
      return opening;
    }
    std::erase_if(used, [&](const GivenOption& one) { return contains(idle, one.name); });
  }
}

}  // namespace

Opening changed(const Opening& before, const OptionChange& change) {
  if (!before.command().find(change.option)) throw cli::WrongUsage(fmt::format("unknown option '{}'", change.option));
  std::vector<GivenOption> given = before.given;
  std::erase_if(given, [&](const GivenOption& one) { return one.name == change.option; });
  if (change.text) given.push_back({change.option, {*change.text}});
  return opened_with(before, std::move(given), change.text ? change.option : std::string());
}

Opening with_options(const Opening& before, std::vector<GivenOption> given) {
  return opened_with(before, std::move(given), {});
}

}  // namespace scarp::viewer
