// SPDX-License-Identifier: MIT
#include "app/options/command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <system_error>
#include <utility>

#include "app/options/help.h"

namespace scarp::cli {
namespace {

constexpr const char* kHelp = "-h,--help";

std::string long_name(const std::string& names) { return names.substr(names.find(',') + 1); }

// The value of a variable as text.
struct ValueText {
  template <class Value>
  requires std::is_arithmetic_v<Value> std::string operator()(Value* value) const { return fmt::format("{}", *value); }
  std::string operator()(std::string* value) const { return *value; }
  template <class Value>
  std::string operator()(const List<Value>& list) const {
    return fmt::format("{}", fmt::join(*list.to, ","));
  }
  template <class Other>
  std::string operator()(const Other&) const {
    return {};
  }
};

// The value of the variable before anything is parsed.
std::string default_of(const Declared& declared) {
  const Option& option = declared.option;
  if (!option.fallback.empty() || option.required) return option.fallback;
  return declared.flag() ? std::string() : std::visit(ValueText{}, declared.to);
}

// Number of insertions, deletions and replacements of letters between two words.
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

// "did you mean '--water'? " if up to a third of the letters are wrong.
std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  std::size_t least = word.size() / 3 + 1;
  std::string nearest;
  for (const std::string& name : names) {
    if (const std::size_t edits = edits_between(word, name); edits < least) {
      least = edits;
      nearest = name;
    }
  }
  return nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest);
}

std::string see_help(const CLI::App& app, const CLI::App* called) {
  return fmt::format("see '{}{} --help'", app.get_name(), called == nullptr ? "" : " " + called->get_name());
}

std::string unknown_word(const CLI::App& app, const CLI::App* called, const std::vector<std::string>& words,
                         const ProgramAbout& about) {
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  // After a word that is not a subcommand, every option is unknown.
  const auto option =
      called != nullptr || is_option(words.front()) ? std::find_if(words.begin(), words.end(), is_option) : words.end();
  if (option != words.end()) {
    std::vector<std::string> names;
    for (const CLI::Option* one : (called == nullptr ? app : *called).get_options()) names.push_back(one->get_name());
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("unknown option '{}' ({}{})", name, suggestion(name, names), see_help(app, called));
  }
  const std::string& word = words.front();
  if (called != nullptr) return fmt::format("'{}': unexpected argument ({})", word, see_help(app, called));
  std::error_code no_file;
  if (about.with_file && std::filesystem::exists(word, no_file))
    return fmt::format("'{}' is a file, not a subcommand (did you mean '{}'?)", word, about.with_file(word));
  std::vector<std::string> names;
  for (const CLI::App* one : app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); }))
    names.push_back(one->get_name());
  const std::vector<std::string_view> views(names.begin(), names.end());
  return fmt::format("unknown subcommand '{}' ({}available: {}; {})", word, suggestion(word, names), listed(views),
                     see_help(app, nullptr));
}

std::string what_is_wrong(const CLI::ParseError& error, const CLI::App& app, const CLI::App* called,
                          const ProgramAbout& about) {
  if (const std::vector<std::string> words = app.remaining(true); !words.empty())
    return unknown_word(app, called, words, about);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && called != nullptr) {
    for (const CLI::Option* option : called->get_options()) {
      const std::string name = option->get_name(), text = error.what();
      if (!text.starts_with(name + ":")) continue;
      if (option->count() > 1) return fmt::format("{} was given {} times; expected once", name, option->count());
      return option->get_items_expected_max() == 0 ? name + " takes no value"
                                                   : fmt::format("{} needs a value ({})", name, see_help(app, called));
    }
  }
  return fmt::format("{} ({})", error.what(), see_help(app, called));
}

}  // namespace

Command::Command(std::string program, std::string name, std::string summary, bool hidden)
    : program_(std::move(program)), name_(std::move(name)), summary_(std::move(summary)), hidden_(hidden) {}

void Command::add(Binding to, Option option) {
  Declared declared{std::move(option), std::move(to), {}, {}};
  declared.name = long_name(declared.option.names);
  declared.default_text = default_of(declared);
  options_.push_back(std::move(declared));
}

const Declared* Command::find(std::string_view name) const {
  const auto found = std::find_if(options_.begin(), options_.end(), [&](const Declared& d) { return d.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

const Command::Typed* Command::typed(std::string_view name) const {
  const auto found = std::find_if(typed_.begin(), typed_.end(), [&](const Typed& t) { return t.option->name == name; });
  return found == typed_.end() ? nullptr : &*found;
}

std::vector<std::string> Command::given() const {
  std::vector<std::string> names;
  for (const Typed& one : typed_) names.push_back(one.option->name);
  return names;
}

std::string Command::value(std::string_view name) const {
  const Typed* one = typed(name);
  return one == nullptr || one->values.empty() ? std::string() : one->values.back();
}

std::vector<std::string> Command::typed_values() const {
  std::vector<std::string> values;
  for (const Typed& one : typed_) {
    if (one.option->name == "--output") continue;
    // --rays - reads standard input: scarp cast --rays - < FILE.
    for (const std::string& value : one.values) values.push_back(value == "-" ? "/dev/stdin" : value);
  }
  return values;
}

std::string Command::typed_words(const std::vector<std::string_view>& left_out) const {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%#";
  const auto quoted = [&](const std::string& word) {
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
  };
  std::string text;
  for (const Typed& one : typed_) {
    const Declared& option = *one.option;
    if (std::find(left_out.begin(), left_out.end(), option.name) != left_out.end()) continue;
    if (option.flag()) {
      text += " " + option.name;
    } else if (option.positional()) {
      for (const std::string& value : one.values) text += " " + quoted(value);
    } else if (option.option.repeats || one.values.size() == 1) {
      for (const std::string& value : one.values) text += " " + option.name + "=" + quoted(value);
    } else {
      text += " " + option.name;
      for (const std::string& value : one.values) text += " " + quoted(value);
    }
  }
  return text;
}

void Command::require_effect_of_any(std::span<const Use> uses) const {
  std::vector<const Declared*> seen;
  const std::function<void(const Declared&)> check = [&](const Declared& one) {
    if (std::find(seen.begin(), seen.end(), &one) != seen.end()) return;
    seen.push_back(&one);
    for (const Rule& rule : one.option.rules) {
      for (const std::string_view word : words_of(rule.text)) {
        if (const Typed* other = typed(word.substr(0, word.find(',')))) check(*other->option);
      }
    }
    if (std::none_of(uses.begin(), uses.end(), [&](const Use& use) { return has_effect(one, use); }))
      cli::require_effect(one, uses.front());
  };
  for (const Typed& one : typed_) check(*one.option);
}

std::vector<std::string> Command::without_effect(const Use& use) const {
  std::vector<std::string> names;
  for (const Typed& one : typed_) {
    if (!has_effect(*one.option, use)) names.push_back(one.option->name);
  }
  return names;
}

void Command::set_values() {
  for (const bool first : {true, false}) {
    for (const Typed& one : typed_) {
      if (one.option->option.first != first) continue;
      for (const std::string& value : one.values) set_value(*one.option, value);
    }
  }
  for (const Declared& one : options_) {
    if (one.option.required && !given(one.name))
      throw WrongUsage(fmt::format("{} is required (see '{} {} --help')", one.synopsis(), program_, name_));
  }
  require_compatible();
}

void Command::require_compatible() const {
  for (const Typed& one : typed_) {
    for (const std::string& other : one.option->option.excludes) {
      if (given(other)) throw WrongUsage(fmt::format("{} cannot be combined with {}", one.option->name, other));
    }
  }
}

void Command::retype(const Declared& option, const std::string& text) {
  set_value(option, text);
  const auto before = std::find_if(typed_.begin(), typed_.end(), [&](const Typed& t) { return t.option == &option; });
  if (before == typed_.end()) {
    typed_.push_back({&option, {text}});
  } else {
    before->values = {text};
  }
  require_compatible();
}

void Command::run(std::vector<Typed> typed) {
  typed_ = std::move(typed);
  set_values();
  work_();
}

bool is_given(const std::vector<std::string>& given, std::string_view option) {
  return std::find(given.begin(), given.end(), option) != given.end();
}

Command& Program::add(const std::string& name, const std::string& summary, bool hidden) {
  return commands_.emplace_back(about_.name, name, summary, hidden);
}

std::vector<const Command*> Program::commands() const {
  std::vector<const Command*> shown;
  for (const Command& command : commands_) {
    if (!command.hidden()) shown.push_back(&command);
  }
  return shown;
}

const Command* Program::find(std::string_view name) const {
  const auto found =
      std::find_if(commands_.begin(), commands_.end(), [&](const Command& c) { return c.name() == name; });
  return found == commands_.end() ? nullptr : &*found;
}

void Program::run(int argc, char** argv) {
  static const std::string kNoText;
  words_.assign(argv + 1, argv + argc);
  std::vector<std::string> words = words_;
  if (about_.reworded) words = about_.reworded(words);
  CLI::App app({}, about_.name);
  app.set_help_flag();
  const auto add_help = [](CLI::App& to) { return to.add_option(kHelp, CLI::callback_t())->expected(0, 1); };
  const CLI::Option* help = add_help(app);
  const CLI::Option* version = app.add_flag("--version", kNoText);
  app.require_subcommand(0, 1);
  struct Parsed {
    Command* command;
    CLI::App* app;
    const CLI::Option* help;
    std::vector<std::pair<CLI::Option*, const Declared*>> options;
  };
  std::vector<Parsed> all;
  for (Command& command : commands_) {
    CLI::App* sub = app.add_subcommand(command.name())->group(command.hidden() ? "" : "Subcommands");
    sub->set_help_flag();
    Parsed& parsed = all.emplace_back(Parsed{&command, sub, add_help(*sub), {}});
    // CLI11 compares each option with all before it: declaring those of all subcommands takes longer than parsing.
    if (std::find(words.begin(), words.end(), command.name()) == words.end()) continue;
    for (const Declared& one : command.options()) {
      const std::string& names = one.option.names;
      CLI::Option* option = one.flag() ? sub->add_flag(names, kNoText) : sub->add_option(names, CLI::callback_t());
      if (one.option.repeats)
        option->expected(1)->take_all();
      else if (std::holds_alternative<std::vector<std::string>*>(one.to))
        option->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args();
      parsed.options.emplace_back(option, &one);
    }
  }
  std::string wrong;
  try {
    std::reverse(words.begin(), words.end());  // CLI11 expects them reversed
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    const auto subs = app.get_subcommands();
    wrong = what_is_wrong(error, app, subs.empty() ? nullptr : subs.front(), about_);
  }
  // Help is printed regardless of other arguments.
  const auto topic_of = [](const CLI::Option& option) {
    return option.results().empty() ? std::string() : option.results().front();
  };
  const auto called = std::find_if(all.begin(), all.end(), [](const Parsed& p) { return p.app->parsed(); });
  if (help->count() > 0) {
    const Command* command = called == all.end() ? find(topic_of(*help)) : called->command;
    fmt::print("{}", command != nullptr ? help_text(*command, {}) : help_text(*this));
    return;
  }
  if (called != all.end() && called->help->count() > 0) {
    fmt::print("{}", help_text(*called->command, topic_of(*called->help)));
    return;
  }
  if (!wrong.empty()) throw WrongUsage(wrong);
  if (version->count() > 0) {
    fmt::print("{} {}\n", about_.name, about_.version);
    return;
  }
  if (called == all.end()) throw WrongUsage(fmt::format("no subcommand (see '{} --help')", about_.name));
  std::vector<Command::Typed> typed;
  for (const CLI::Option* option : called->app->parse_order()) {
    const auto one = std::find_if(called->options.begin(), called->options.end(),
                                  [&](const auto& pair) { return pair.first == option; });
    if (one == called->options.end()) continue;
    if (std::any_of(typed.begin(), typed.end(), [&](const auto& t) { return t.option == one->second; })) continue;
    typed.push_back({one->second, option->results()});
  }
  called->command->run(std::move(typed));
}

}  // namespace scarp::cli
