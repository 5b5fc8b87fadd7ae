// SPDX-License-Identifier: MIT
#include "bench/wrong_usage.h"

#include <cstddef>
#include <vector>

namespace scarp::bench {
namespace {

// "--fov 'x': expected a number" for a value that CLI11 could not convert.
std::string unconverted(const CLI::ConversionError& error, const CLI::App& called) {
  for (const CLI::Option* option : called.get_options()) {
    const std::string name = option->get_name();
    const std::string before = "Could not convert: " + name + " = ", text = error.what();
    if (!text.starts_with(before)) continue;
    return name + " '" + text.substr(before.size()) + "': expected " +
           (option->get_type_name() == "FLOAT" ? "a number" : "a whole number");
  }
  return error.what();
}

std::string what_is_wrong(const CLI::ParseError& error, const CLI::App& called) {
  if (const auto* conversion = dynamic_cast<const CLI::ConversionError*>(&error)) {
    return unconverted(*conversion, called);
  }
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) {
    // "--fov: 'x': expected ...", as for other errors.
    std::string text = error.what();
    const std::size_t end = text.find(": '");
    if (end != std::string::npos && text.find("expected", end) != std::string::npos) text.erase(end, 1);
    return text;
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    // The missing option may have been given under a wrong name.
    for (const std::string& argument : called.remaining()) {
      if (argument.starts_with('-')) return "The following argument was not expected: " + argument;
    }
  }
  return error.what();
}

// "render, cast or info".
std::string subcommands_of(const CLI::App& program) {
  const auto all = program.get_subcommands([](const CLI::App*) { return true; });
  std::string names;
  for (std::size_t i = 0; i < all.size(); ++i)
    names += (i == 0 ? "" : i + 1 == all.size() ? " or " : ", ") + all[i]->get_name();
  return names;
}

}  // namespace

std::string unknown_subcommand(const CLI::App& program) {
  if (!program.get_subcommands().empty()) return {};
  // A wrong option is reported as such.
  const std::vector<std::string> words = program.remaining();
  return words.empty() || words.front().starts_with('-') ? std::string() : words.front();
}

std::string wrong_usage(const CLI::ParseError& error, const CLI::App& program) {
  const auto subcommands = program.get_subcommands();
  const std::string word = unknown_subcommand(program);
  const CLI::App& called = subcommands.empty() ? program : *subcommands.front();
  const std::string what = word.empty() ? what_is_wrong(error, called)
                                        : "'" + word + "': is no subcommand; expected " + subcommands_of(program);
  const std::string help = program.get_name() + (subcommands.empty() ? "" : " " + called.get_name());
  return what + "; '" + help + " --help' tells what there is";
}

}  // namespace scarp::bench
