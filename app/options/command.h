// SPDX-License-Identifier: MIT
// The program and its subcommands: their declarations, and the typed options.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/options/option.h"

namespace scarp::cli {

/// A subcommand. Variables that options are bound to must live until it has run.
class Command {
 public:
  Command(std::string program, std::string name, std::string summary, bool hidden);

  /// Declares an option or a positional argument.
  void add(Binding to, Option option);
  /// A command line for the help, "scarp render dem.tif -o dem.png".
  void example(std::string line) { examples_.push_back(std::move(line)); }
  /// Text below the options in the help.
  void footer(std::string text) { footer_ = std::move(text); }
  /// The function that the subcommand runs.
  void runs(std::function<void()> work) { work_ = std::move(work); }

  const std::string& program() const { return program_; }
  const std::string& name() const { return name_; }
  const std::string& summary() const { return summary_; }
  bool hidden() const { return hidden_; }
  const std::deque<Declared>& options() const { return options_; }
  const std::vector<std::string>& examples() const { return examples_; }
  const std::string& footer() const { return footer_; }
  /// Null if there is no such option.
  const Declared* find(std::string_view name) const;

  /// The names of the options that were typed, in the order typed.
  std::vector<std::string> given() const;
  bool given(std::string_view name) const { return typed(name) != nullptr; }
  /// The last value typed for an option; empty: not typed.
  std::string value(std::string_view name) const;
  /// Every value except that of --output. Values that name files count as inputs, so new options are covered.
  std::vector<std::string> typed_values() const;
  /// The typed words, without the options in `left_out`, quoted for a shell where necessary.
  std::string typed_words(const std::vector<std::string_view>& left_out) const;
  /// Throws Error for the first option, in the order typed, that has no effect in any of the uses, with its reason in
  /// the first one. An option is checked before others that need it.
  void require_effect_of_any(std::span<const Use> uses) const;
  void require_effect(const Use& use) const { require_effect_of_any(std::span(&use, 1)); }

  /// The values typed for one option.
  struct Typed {
    const Declared* option;
    std::vector<std::string> values;
  };
  /// In the order typed, each option once.
  const std::vector<Typed>& all_typed() const { return typed_; }
  /// Sets an option as if it had been typed with this value, in place of what was typed. Throws what its binding
  /// throws; then the variable and the typed value may have changed.
  void retype(const Declared& option, const std::string& text);
  /// The names of the options that were typed and have no effect.
  std::vector<std::string> without_effect(const Use& use) const;
  /// Sets the variables and runs. Throws WrongUsage and the exceptions of the subcommand.
  void run(std::vector<Typed> typed);

 private:
  const Typed* typed(std::string_view name) const;
  void set_values();
  void require_compatible() const;

  std::string program_, name_, summary_, footer_;
  bool hidden_;
  std::deque<Declared> options_;  // a deque does not move elements: Typed points to them
  std::vector<std::string> examples_;
  std::function<void()> work_;
  std::vector<Typed> typed_;
};

/// Whether `option` is in given().
bool is_given(const std::vector<std::string>& given, std::string_view option);

/// The name and texts of a program.
struct ProgramAbout {
  std::string name{};     ///< "scarp"
  std::string version{};  //
  std::string summary{};  ///< one line
  std::string example{};  ///< a command line
  /// The command line that was probably meant if a file is typed instead of a subcommand; null: none.
  std::function<std::string(const std::string& file)> with_file{};
  /// Returns words that replace those typed; null: no change. May throw WrongUsage.
  std::function<std::vector<std::string>(const std::vector<std::string>& words)> reworded{};
};

class Program {
 public:
  explicit Program(ProgramAbout about) : about_(std::move(about)) {}
  const ProgramAbout& about() const { return about_; }

  /// A hidden subcommand is not listed in the help.
  Command& add(const std::string& name, const std::string& summary, bool hidden = false);
  /// The visible subcommands.
  std::vector<const Command*> commands() const;
  const Command* find(std::string_view name) const;

  /// Parses and runs. Throws WrongUsage and the exceptions of the subcommand.
  void run(int argc, char** argv);
  /// The words of the command line after the program's name.
  const std::vector<std::string>& words() const { return words_; }

 private:
  ProgramAbout about_;
  std::vector<std::string> words_;
  std::deque<Command> commands_;
};

}  // namespace scarp::cli
