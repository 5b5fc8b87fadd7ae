// SPDX-License-Identifier: MIT
#include "app/options/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace scarp::cli {
namespace {

constexpr std::size_t kWidth = 100, kLargestIndent = 30;
// Lines of help that fit on a screen: subcommands with more options show the common ones.
constexpr std::ptrdiff_t kScreen = 60;

struct HelpRow {
  std::string left, right;
};

// Two columns; the right one wraps at words.
std::string table_of(const std::vector<HelpRow>& rows) {
  std::size_t indent = 0;
  for (const HelpRow& row : rows) {
    if (const std::size_t wide = row.left.size() + 4; wide <= kLargestIndent) indent = std::max(indent, wide);
  }
  std::string out;
  for (const HelpRow& row : rows) {
    std::string line = "  " + row.left;
    if (line.size() + 2 > indent) {
      out += line + "\n";
      line.clear();
    }
    line.resize(indent, ' ');
    bool empty = true;
    for (const std::string_view word : words_of(row.right)) {
      if (!empty && line.size() + 1 + word.size() > kWidth) {
        out += line + "\n";
        line.assign(indent, ' ');
        empty = true;
      }
      if (!empty) line += ' ';
      line += word;
      empty = false;
    }
    out += line + "\n";
  }
  return out;
}

std::string table_of(const std::vector<const Declared*>& options) {
  std::vector<HelpRow> rows;
  for (const Declared* one : options) rows.push_back({one->synopsis(), one->description()});
  return table_of(rows);
}

std::string topics_of(const Command& command) {
  std::vector<std::string_view> names{"all"};
  for (const auto& [topic, options] : options_by_topic(command)) names.push_back(name_of(topic));
  return listed(names, "or");
}

std::string wrapped(const std::string& text) {
  std::string out, line;
  for (const std::string_view word : words_of(text)) {
    if (!line.empty() && line.size() + 1 + word.size() > kWidth) out += std::exchange(line, {}) + "\n";
    if (!line.empty()) line += ' ';
    line += word;
  }
  return out + line + "\n";
}

std::string examples_of(const Command& command) {
  if (command.examples().empty()) return {};
  std::string out = "\nExamples:\n";
  for (const std::string& line : command.examples()) out += "  " + line + "\n";
  return out;
}

}  // namespace

std::vector<TopicOptions> options_by_topic(const Command& command) {
  std::vector<TopicOptions> topics;
  for (int i = 0; i < kTopics; ++i) {
    std::vector<const Declared*> options;
    for (const Declared& one : command.options()) {
      if (one.option.topic == static_cast<Topic>(i)) options.push_back(&one);
    }
    if (!options.empty()) topics.emplace_back(static_cast<Topic>(i), std::move(options));
  }
  return topics;
}

std::string usage_of(const Command& command) {
  std::string usage = command.program() + " " + command.name();
  bool more = false;
  for (const Declared& one : command.options()) {
    if (!one.positional() && !one.option.required) {
      more = true;
      continue;
    }
    std::string name = one.synopsis();
    if (const auto comma = name.find(", "); comma != std::string::npos)
      name = name.substr(0, comma) + name.substr(name.find(' ', comma + 2));
    if (std::holds_alternative<std::vector<std::string>*>(one.to)) name += "...";
    usage += one.option.required ? " " + name : fmt::format(" [{}]", name);
  }
  return more ? usage + " [OPTIONS]" : usage;
}

std::string help_text(const Program& program) {
  std::vector<HelpRow> rows;
  for (const Command* command : program.commands()) rows.push_back({command->name(), command->summary()});
  const ProgramAbout& about = program.about();
  return fmt::format(
      "{0}\nUsage: {1} SUBCOMMAND [OPTIONS]\n\nSubcommands:\n{2}\nOptions:\n"
      "  -h, --help   this text; '{1} SUBCOMMAND --help' lists the options of a subcommand\n"
      "  --version    version\n\n"
      "Example:\n  {3}\n",
      about.summary, about.name, table_of(rows), about.example);
}

std::string help_text(const Command& command, const std::string& topic) {
  const std::vector<TopicOptions> topics = options_by_topic(command);
  const std::string head = fmt::format("{}\nUsage: {}\n", command.summary(), usage_of(command));
  const std::string tail = examples_of(command) + (command.footer().empty() ? "" : "\n" + command.footer() + "\n");
  std::string listed;
  bool found = false;
  for (const auto& [of, options] : topics) {
    if (!topic.empty() && topic != "all" && topic != name_of(of)) continue;
    found = true;
    listed += fmt::format("\n{}:\n{}", heading_of(of), table_of(options));
  }
  if (!found && !topics.empty()) {
    throw WrongUsage(fmt::format("--help '{}': unknown topic of '{} {}' (topics: {})", topic, command.program(),
                                 command.name(), topics_of(command)));
  }
  if (!topic.empty() && topic != "all") return head + listed;
  const std::string all = head + listed + tail;
  if (topic == "all" || std::count(all.begin(), all.end(), '\n') <= kScreen) return all;
  std::vector<const Declared*> common;
  for (const auto& [of, options] : topics) {
    for (const Declared* one : options) {
      if (one->option.common || one->option.required) common.push_back(one);
    }
  }
  const std::string more = fmt::format("More options: '{} {} --help TOPIC'; topics: {}.", command.program(),
                                       command.name(), topics_of(command));
  return head + "\nCommon options:\n" + table_of(common) + "\n" + wrapped(more) + tail;
}

}  // namespace scarp::cli
