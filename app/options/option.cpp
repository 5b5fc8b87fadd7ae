// SPDX-License-Identifier: MIT
#include "app/options/option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <utility>

namespace scarp::cli {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, kTopics> kTopicNames = {{
    {"general", "General"},
    {"picture", "Picture"},
    {"camera", "Camera"},
    {"light", "Light and air"},
    {"surface", "Surface"},
    {"ground", "Ground colours"},
    {"water", "Water"},
    {"fog", "Fog"},
    {"comanche", "Look comanche"},
    {"figure", "Figure"},
    {"flight", "Flights"},
    {"depth", "Depth buffer"},
    {"mesh", "Mesh"},
    {"voxels", "Voxels"},
    {"functions", "Terrain functions"},
    {"input", "Input interpretation"},
    {"march", "March settings"},
    {"window", "Window"},
    {"report", "Report"},
}};

std::string kinds_text(unsigned kinds) {
  constexpr std::pair<unsigned, std::string_view> kNames[] = {
      {kTerrain, "terrain"}, {kVoxels, "voxels"}, {kScene, "scenes"}, {kFunction, "functions"}, {kMesh, "meshes"}};
  std::vector<std::string_view> names;
  for (const auto& [kind, name] : kNames) {
    if ((kinds & kind) != 0) names.push_back(name);
  }
  return listed(names);
}

std::string looks_text(std::string_view looks) {
  const auto words = words_of(looks);
  return (words.size() == 1 ? "the look " : "the looks ") + listed(words);
}

std::string in_brackets(std::string_view why) { return why.empty() ? "" : fmt::format(" ({})", why); }

bool has_word(std::string_view text, std::string_view word) {
  const auto words = words_of(text);
  return std::find(words.begin(), words.end(), word) != words.end();
}

// "1 to 150", "F > 0"; empty: any number.
std::string range_text(const NumberRange& range, const std::string& value) {
  // kMostOfGround only catches typing errors.
  const bool least = range.least > -kMostOfGround, most = range.most < kMostOfGround;
  if (least && most && range.above_least) return fmt::format("{} < {} <= {}", range.least, value, range.most);
  if (least && most) return fmt::format("{} to {}", range.least, range.most);
  if (least) return fmt::format("{} {} {}", value, range.above_least ? ">" : ">=", range.least);
  return {};
}

std::string placeholder(const Option& option, const Binding& to) {
  if (!option.value.empty()) return option.value;
  if (std::holds_alternative<bool*>(to) || std::holds_alternative<Off>(to)) return {};
  if (option.unit == "metres") return "M";
  if (option.unit == "degrees") return "DEG";
  if (std::holds_alternative<List<std::string>>(to)) return "WORD,...";
  if (std::holds_alternative<List<int>>(to)) return "N,...";
  if (std::holds_alternative<List<double>>(to)) return "F,...";
  return std::holds_alternative<double*>(to) || std::holds_alternative<std::optional<double>*>(to) ? "F" : "N";
}

// "from 1 to 8", "1 or more".
template <class Whole>
std::string whole_numbers_text(const NumberRange& range) {
  const std::string least = std::isfinite(range.least) ? fmt::format("{}", range.least)
                                                       : fmt::format("{}", std::numeric_limits<Whole>::min());
  if (!std::isfinite(range.most) && std::is_signed_v<Whole>) return least + " or more";
  const std::string most =
      std::isfinite(range.most) ? fmt::format("{}", range.most) : fmt::format("{}", std::numeric_limits<Whole>::max());
  return fmt::format("from {} to {}", least, most);
}

template <class Whole>
std::optional<Whole> whole_from(const std::string& text) {
  Whole number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && rest == text.data() + text.size()) return number;
  if constexpr (sizeof(Whole) == 8) {
    constexpr double kExact = 0x1p53;  // up to this, doubles represent all whole numbers
    if (double large = 0; text.find('e') != std::string::npos && number_in(kZeroOrMore)(text).empty() &&
                          (large = std::strtod(text.c_str(), nullptr)) < kExact && std::floor(large) == large)
      return static_cast<Whole>(large);
  }
  return {};
}

// "N" of "N,...".
std::string one_of(const std::string& values) { return values.substr(0, values.find(",...")); }

// Sets the variable of a binding. Returns the error, empty if the text is valid.
struct Assignment {
  const Declared& declared;
  const std::string& text;

  std::string operator()(bool* value) const {
    if (text != "true" && text != "false")
      return fmt::format("'{}': {}", text, declared.flag() ? "takes no value" : "expected true or false");
    *value = text == "true";
    return {};
  }
  std::string operator()(const Off& off) const {
    bool on = false;
    const std::string wrong = (*this)(&on);
    if (wrong.empty()) *off.what = !on;
    return wrong;
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> std::string operator()(Number* value) const {
    const NumberRange& range = declared.option.range;
    if constexpr (std::is_floating_point_v<Number>) {
      const std::string wrong = number_in(range)(text);
      if (wrong.empty()) *value = std::strtod(text.c_str(), nullptr);
      return wrong;
    } else {
      const auto number = whole_from<Number>(text);
      if (!number || static_cast<double>(*number) < range.least || static_cast<double>(*number) > range.most)
        return fmt::format("'{}': expected a whole number{} {}", text,
                           std::isfinite(range.most) || !std::is_signed_v<Number> ? "" : ",",
                           whole_numbers_text<Number>(range));
      *value = *number;
      return {};
    }
  }
  template <class Value>
  std::string operator()(std::optional<Value>* value) const {
    Value given{};
    const std::string wrong = (*this)(&given);
    if (wrong.empty()) *value = given;
    return wrong;
  }
  std::string operator()(std::string* value) const {
    const auto& choices = declared.option.choices;
    if (declared.option.closed && std::find(choices.begin(), choices.end(), text) == choices.end()) {
      const std::vector<std::string_view> words(choices.begin(), choices.end());
      return fmt::format("'{}': expected {}", text, listed(words, "or"));
    }
    *value = text;
    return {};
  }
  std::string operator()(std::vector<std::string>* values) const {
    std::string value;
    const std::string wrong = (*this)(&value);
    if (wrong.empty()) values->push_back(value);
    return wrong;
  }
  template <class Value>
  std::string operator()(const List<Value>& list) const {
    std::vector<Value> values;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      Value value{};
      const std::string part = text.substr(begin, end - begin);
      if (std::string wrong = Assignment{declared, part}(&value); !wrong.empty()) return wrong;
      values.push_back(std::move(value));
      begin = end + 1;
    }
    *list.to = std::move(values);
    return {};
  }
  std::string operator()(const Setter& set) const {
    std::string checked;
    if (std::string wrong = (*this)(&checked); !wrong.empty()) return wrong;
    set(text);
    return {};
  }
};

}  // namespace

std::string_view name_of(InputKind kind) {
  switch (kind) {
    case InputKind::terrain:
      return "terrain";
    case InputKind::voxels:
      return "voxels";
    case InputKind::scene:
      return "scene";
    case InputKind::function:
      return "function";
    case InputKind::mesh:
      break;
  }
  return "mesh";
}
std::string_view name_of(Topic topic) { return kTopicNames[static_cast<std::size_t>(topic)].first; }
std::string_view heading_of(Topic topic) { return kTopicNames[static_cast<std::size_t>(topic)].second; }

Rule needs(const std::string& what, std::function<bool()> met, unsigned of) {
  return {"has no effect without " + what, std::move(met), of};
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::string listed(std::span<const std::string_view> words, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? fmt::format(" {} ", last) : ", ";
    text += words[i];
  }
  return text;
}

bool Declared::flag() const {
  return std::holds_alternative<Off>(to) || (std::holds_alternative<bool*>(to) && option.value.empty());
}

std::string Declared::synopsis() const {
  std::string text = option.names;
  if (const auto comma = text.find(','); comma != std::string::npos) text.insert(comma + 1, " ");
  if (positional() || flag()) return text;
  return text + " " + placeholder(option, to);
}

std::string Declared::meaning() const {
  std::string text = option.help;
  if (!option.choices.empty() && !option.unlisted) {
    const std::vector<std::string_view> words(option.choices.begin(), option.choices.end());
    text += ": " + listed(words, "or");
  }
  if (!option.unit.empty()) text += " in " + option.unit;
  if (const std::string range = range_text(option.range, one_of(placeholder(option, to))); !range.empty())
    text += ", " + range;
  if (!option.note.empty()) text += "; " + option.note;
  return text;
}

std::string Declared::description() const {
  return default_text.empty() ? meaning() : fmt::format("{} ({})", meaning(), default_text);
}

std::string Declared::restrictions() const {
  std::vector<std::string> parts;
  if (option.inputs.kinds != kEveryInput) parts.push_back(kinds_text(option.inputs.kinds));
  if (!option.looks.names.empty()) parts.push_back(looks_text(option.looks.names));
  if (!option.marches.empty()) parts.push_back("--march " + listed(words_of(option.marches), "or"));
  for (const Rule& rule : option.rules) parts.push_back(rule.text);
  for (const std::string& other : option.excludes) parts.push_back("not with " + other);
  return fmt::format("{}", fmt::join(parts, "; "));
}

void set_value(const Declared& declared, const std::string& text) {
  const std::string wrong = std::visit(Assignment{declared, text}, declared.to);
  if (!wrong.empty()) throw WrongUsage(declared.name + " " + wrong);
}

void require_effect(const Declared& declared, const Use& use) {
  const Option& option = declared.option;
  const auto kind = static_cast<unsigned>(use.kind);
  if ((option.inputs.kinds & kind) == 0) {
    const std::string_view why = use.kind == InputKind::scene ? option.inputs.why_not_scenes : option.inputs.why;
    throw Error(
        fmt::format("{} applies to {} only{}", declared.name, kinds_text(option.inputs.kinds), in_brackets(why)));
  }
  const Looks& looks = option.looks;
  if (!use.look.empty() && !looks.names.empty() && (looks.of & kind) != 0 && !has_word(looks.names, use.look)) {
    throw Error(fmt::format("{} applies to {}, not to '{}'{}", declared.name, looks_text(looks.names), use.look,
                            in_brackets(looks.why)));
  }
  if (!use.march.empty() && !option.marches.empty() && !has_word(option.marches, use.march)) {
    throw Error(fmt::format("{} needs --march {} (the march is {})", declared.name,
                            listed(words_of(option.marches), "or"), use.march));
  }
  for (const Rule& rule : option.rules) {
    if ((rule.of & kind) != 0 && !rule.holds()) throw Error(declared.name + " " + rule.text);
  }
}

bool has_effect(const Declared& declared, const Use& use) {
  try {
    require_effect(declared, use);
  } catch (const Error&) {
    return false;
  }
  return true;
}

}  // namespace scarp::cli
