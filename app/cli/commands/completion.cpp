// SPDX-License-Identifier: MIT
// Completion scripts. Descriptions come from the declarations: single quotes are the only characters that the shells
// need escaped in them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/commands/documents.h"
#include "app/options/help.h"

namespace scarp::cli {
namespace {

std::vector<std::string> subcommands_of(const Program& program) {
  std::vector<std::string> names;
  for (const Command* command : program.commands()) names.push_back(command->name());
  return names;
}

// Every name of every option: "-o", "--output".
std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names{"--help"};
  for (const Declared& one : command.options()) {
    if (one.positional()) continue;
    if (const auto comma = one.option.names.find(','); comma != std::string::npos)
      names.push_back(one.option.names.substr(0, comma));
    names.push_back(one.name);
  }
  return names;
}

// The arguments of --help: "all water fog".
std::string topics_of_help(const Command& command) {
  std::string names = "all";
  for (const auto& [topic, options] : options_by_topic(command)) names += fmt::format(" {}", name_of(topic));
  return names;
}

// "-o|--output".
std::string pattern_of(const Declared& one) { return replaced(one.option.names, ",", "|"); }

std::string with_bars(const std::string& words) { return replaced(words, " ", "|"); }

}  // namespace

std::string bash_completion(const Program& program) {
  std::string out = R"bash(# bash completion for scarp, generated from its options

_scarp_files() {  # CURRENT [EXTENSIONS, with | between them]
  compopt -o filenames 2> /dev/null
  local pattern=
  if [[ -n $2 ]]; then pattern="!*.@($2)"; fi
  shopt -q extglob; local extglob=$?
  shopt -s extglob
  mapfile -t COMPREPLY < <(compgen -d -- "$1"; compgen -f -X "$pattern" -- "$1")
  if (( extglob )); then shopt -u extglob; fi
}

_scarp() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}
  COMPREPLY=()
  # --look=shaded is three words.
  if [[ $cur == = ]]; then cur=; elif [[ $prev == = ]]; then prev=${COMP_WORDS[COMP_CWORD-2]}; fi
  if (( COMP_CWORD == 1 )); then
)bash";
  out += fmt::format("    mapfile -t COMPREPLY < <(compgen -W '{} --help --version' -- \"$cur\")\n    return\n  fi\n",
                     fmt::join(subcommands_of(program), " "));
  out += "  case $command in\n";
  for (const Command* command : program.commands()) {
    out += fmt::format(
        "  {})\n    case $prev in\n    -h|--help) mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$cur\"); return ;;\n",
        command->name(), topics_of_help(*command));
    std::string files;
    for (const Declared& one : command->options()) {
      const Option& option = one.option;
      if (one.positional()) {
        files = option.files;
        continue;
      }
      if (one.flag()) continue;
      out += fmt::format("    {})", pattern_of(one));
      if (!option.files.empty())
        out += fmt::format(" _scarp_files \"$cur\" '{}';", option.files == "*" ? "" : with_bars(option.files));
      if (!option.choices.empty())
        out += fmt::format(" mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -W '{}' -- \"$cur\");",
                           fmt::join(option.choices, " "));
      out += " return ;;\n";
    }
    out += fmt::format(
        "    esac\n    if [[ $cur == -* ]]; then\n      mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$cur\")\n",
        fmt::join(option_names(*command), " "));
    if (!files.empty())
      out += fmt::format("    else\n      _scarp_files \"$cur\" '{}'\n", files == "*" ? "" : with_bars(files));
    out += "    fi ;;\n";
  }
  return out + "  esac\n}\n\ncomplete -F _scarp scarp\n";
}

std::string zsh_completion(const Program& program) {
  // Escapes help for a specification of _arguments: 'NAMES[HELP]:VALUE:ACTION'.
  const auto text = [](std::string help) {
    for (const auto& [from, to] : {std::pair("\\", "\\\\"), {"'", "'\\''"}, {"[", "\\["}, {"]", "\\]"}, {":", "\\:"}})
      help = replaced(std::move(help), from, to);
    return help;
  };
  const auto action = [](const Option& option) -> std::string {
    const std::string words = option.choices.empty() ? "" : fmt::format("({})", fmt::join(option.choices, " "));
    if (option.files.empty()) return words.empty() ? " " : words;
    const std::string glob =
        option.files == "*" ? "_files" : fmt::format("_files -g \"*.({})\"", with_bars(option.files));
    return words.empty() ? glob : fmt::format("{{compadd {}; {}}}", fmt::join(option.choices, " "), glob);
  };
  std::string out = "#compdef scarp\n# generated from the options of scarp\n\n_scarp() {\n  local -a commands=(\n";
  for (const Command* command : program.commands())
    out += fmt::format("    '{}:{}'\n", command->name(), text(command->summary()));
  out +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe subcommand commands\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n";
  for (const Command* command : program.commands()) {
    out += fmt::format("  {})\n    _arguments \\\n", command->name());
    for (const Declared& one : command->options()) {
      const Option& option = one.option;
      if (one.positional()) {
        const bool many = std::holds_alternative<std::vector<std::string>*>(one.to);
        out += fmt::format("      '{}:{}:{}' \\\n", many ? "*" : "", text(one.name), action(option));
        continue;
      }
      const std::string value = one.flag() ? "" : fmt::format(":{}:{}", text(one.synopsis()), action(option));
      const std::string shown = fmt::format("[{}]{}", text(one.meaning()), value);
      if (const auto comma = option.names.find(','); comma != std::string::npos) {
        out += fmt::format("      '({0} {1})'{{{0},{1}}}'{2}' \\\n", option.names.substr(0, comma), one.name, shown);
      } else {
        out += fmt::format("      '{}{}' \\\n", one.name, shown);
      }
    }
    out += fmt::format("      '(-h --help)'{{-h,--help}}'[help]::topic:({})' ;;\n", topics_of_help(*command));
  }
  return out + "  esac\n}\n\n_scarp \"$@\"\n";
}

std::string fish_completion(const Program& program) {
  const auto text = [](const std::string& help) { return replaced(replaced(help, "\\", "\\\\"), "'", "\\'"); };
  std::string out = "# fish completion for scarp, generated from its options\ncomplete -c scarp -f\n";
  for (const Command* command : program.commands())
    out += fmt::format("complete -c scarp -n __fish_use_subcommand -a {} -d '{}'\n", command->name(),
                       text(command->summary()));
  for (const Command* command : program.commands()) {
    const std::string when = fmt::format("complete -c scarp -n '__fish_seen_subcommand_from {}'", command->name());
    out += fmt::format("{} -s h -l help -x -a '{}' -d help\n", when, topics_of_help(*command));
    for (const Declared& one : command->options()) {
      const Option& option = one.option;
      if (one.positional()) {
        if (!option.files.empty()) out += fmt::format("{} -F\n", when);
        continue;
      }
      out += when;
      if (const auto comma = option.names.find(','); comma != std::string::npos)
        out += fmt::format(" -s {}", option.names.substr(1, comma - 1));
      out += fmt::format(" -l {}", one.name.substr(2));
      if (!one.flag()) out += option.files.empty() ? " -x" : " -r -F";
      if (!option.choices.empty()) out += fmt::format(" -a '{}'", fmt::join(option.choices, " "));
      out += fmt::format(" -d '{}'\n", text(one.meaning()));
    }
  }
  return out;
}

}  // namespace scarp::cli
