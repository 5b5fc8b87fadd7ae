// SPDX-License-Identifier: MIT
#include "app/viewer/controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "app/options/numbers.h"

namespace scarp::viewer {
namespace {

// Sliders without declared limits range from a fraction to a multiple of the default.
constexpr double kSpan = 64;
// Sliders of lengths start at this fraction of the picture's extent; sliders of heights extend this far beyond the
// ground.
constexpr double kLeastLength = 1e-3, kBeyond = 0.25;
constexpr double kMostCount = 100;  // of integers without a limit
// Larger ranges have no slider.
constexpr double kWidest = 1e5;
// Options without a control: the window has its own way to set them, or they choose the input or a preset.
constexpr std::array<std::string_view, 5> kNone = {"--size", "--preset", "--function", "--lowres", "--no-water"};
constexpr std::array<cli::Topic, 9> kShown = {cli::Topic::picture, cli::Topic::light,     cli::Topic::surface,
                                              cli::Topic::ground,  cli::Topic::water,     cli::Topic::fog,
                                              cli::Topic::voxels,  cli::Topic::functions, cli::Topic::march};

template <class List, class Item>
bool has(const List& list, const Item& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

// "12.5" as 12.5; nullopt for other texts.
std::optional<double> number_from(const std::string& text) {
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || rest != text.data() + text.size()) return {};
  return number;
}

constexpr const char* kDegrees = "\u00b0";
std::string unit_of(const cli::Option& option) {
  if (option.unit == "metres") return "m";
  if (option.unit == "degrees") return kDegrees;
  return option.unit;
}

// As short as the slider shows it: mouse input is no more precise.
std::string short_text(double number) {
  constexpr double kNoDecimals = 1000;
  return std::abs(number) < kNoDecimals ? fmt::format("{:.4g}", number) : fmt::format("{:.0f}", number);
}

// The default of an option, in words: "0.1; functions 0.2", "unlimited".
std::string first_default(const cli::Declared& declared) {
  return declared.default_text.substr(0, declared.default_text.find(';'));
}

class Maker {
 public:
  Maker(const Opening& opening, const ControlScales& scales) : opening_(opening), scales_(scales) {}

  // Nullopt for options without a control: files, texts.
  std::optional<Control> of(const cli::Declared& declared) const {
    const cli::Option& option = declared.option;
    Control control;
    control.option = declared.name;
    control.label = declared.name.substr(2);
    control.help = declared.meaning();
    control.topic = option.topic, control.common = option.common;
    control.unit = unit_of(option);
    if (declared.name == "--march") {
      if (scales_.marches.size() < 2) return {};
      control.kind = ControlKind::choice;
      control.choices = scales_.marches, control.choice = scales_.march;
    } else if (const auto* flag = std::get_if<bool*>(&declared.to)) {
      make_flag(declared, **flag, control);
    } else if (const auto* off = std::get_if<cli::Off>(&declared.to)) {
      make_flag(declared, !off->what->value_or(true), control);
    } else if (option.value == "LOW,HIGH") {
      make_pair(declared, control);
    } else if (option.value == "AZ,ALT") {
      control.kind = ControlKind::angles, control.unit = kDegrees;
      const std::vector<double> angles = cli::numbers_from(now(declared), ',', 2, 2, declared.name, option.value);
      control.numbers = {angles[0], angles[1]};
    } else if (option.value == "RRGGBB") {
      make_colour(declared, control);
    } else if (!option.choices.empty()) {
      make_choice(declared, control);
    } else if (!make_number(declared, control)) {
      return {};
    }
    std::replace(control.label.begin(), control.label.end(), '-', ' ');
    return control;
  }

 private:
  // The last value that was typed; empty: none.
  std::string typed(const cli::Declared& declared) const { return opening_.command().value(declared.name); }
  // The current value, as text.
  std::string now(const cli::Declared& declared) const {
    std::string text = declared.option.now ? declared.option.now() : typed(declared);
    return text.empty() ? unset(declared) : text;
  }
  // The value of an option that was not given, as text.
  std::string unset(const cli::Declared& declared) const {
    const auto found = scales_.in_force.find(declared.name);
    return found == scales_.in_force.end() ? first_default(declared) : found->second;
  }

  static void make_flag(const cli::Declared& declared, bool value, Control& control) {
    control.kind = ControlKind::flag;
    control.worded = !declared.flag();
    control.inverted = control.label.starts_with("no-");
    if (control.inverted) control.label.erase(0, 3);
    control.on = value != control.inverted;
  }

  void make_choice(const cli::Declared& declared, Control& control) const {
    control.kind = ControlKind::choice;
    for (const std::string& choice : declared.option.choices) {
      // Large pixels need another size and camera than the window has.
      if (declared.name != "--look" || !entry_of(find_look(choice)).large_pixels) control.choices.push_back(choice);
    }
    const auto* text = std::get_if<std::string*>(&declared.to);
    control.choice = text ? **text : now(declared);
    if (control.choice.empty()) control.choice = unset(declared);
  }

  void make_pair(const cli::Declared& declared, Control& control) const {
    control.kind = ControlKind::pair;
    control.may_rest = true;
    const bool heights = declared.option.unit == "metres";
    control.numbers =
        heights ? std::array{scales_.low, scales_.high, 0.0} : std::array{scales_.steps_low, scales_.steps_high, 0.0};
    const std::string text = typed(declared);
    control.rests = text.empty();
    const auto low = number_from(text.substr(0, text.find(','))),
               high = number_from(text.substr(std::min(text.find(',') + 1, text.size())));
    if (low && high) control.numbers = {*low, *high};
    control.least = heights ? -cli::kMostOfGround : 0, control.most = cli::kMostOfGround;
  }

  void make_colour(const cli::Declared& declared, Control& control) const {
    control.kind = ControlKind::colour;
    const std::string text = now(declared);
    unsigned rgb = 0;
    std::from_chars(text.data(), text.data() + text.size(), rgb, 16);
    for (int i = 0; i < 3; ++i) control.numbers[static_cast<std::size_t>(i)] = (rgb >> (16 - 8 * i) & 255) / 255.0;
  }

  bool make_number(const cli::Declared& declared, Control& control) const {
    control.kind = ControlKind::number;
    const std::optional<double> usual = number_from(unset(declared));
    double& value = control.numbers[0];
    if (const auto* whole = std::get_if<int*>(&declared.to)) {
      control.whole = true;
      value = **whole;
    } else if (const auto* perhaps_whole = std::get_if<std::optional<int>*>(&declared.to)) {
      control.whole = true;
      value = (*perhaps_whole)->value_or(static_cast<int>(usual.value_or(0)));
    } else if (const auto* perhaps_small = std::get_if<std::optional<std::uint32_t>*>(&declared.to)) {
      control.whole = true;
      value = (*perhaps_small)->value_or(static_cast<std::uint32_t>(usual.value_or(0)));
    } else if (const auto* small = std::get_if<std::uint32_t*>(&declared.to)) {
      control.whole = true;
      value = **small;
    } else if (const auto* number = std::get_if<double*>(&declared.to)) {
      value = **number;
      control.may_rest = !std::isfinite(value) || !usual;
    } else if (const auto* perhaps = std::get_if<std::optional<double>*>(&declared.to)) {
      value = (*perhaps)->value_or(usual.value_or(NAN));
      control.may_rest = !usual;
    } else if (declared.name == "--exaggeration") {
      value = scales_.exaggeration;
    } else {
      return false;
    }
    set_ends(declared.option, usual, control);
    const bool given = opening_.command().given(declared.name);
    // An optional number without a default has a value only if it was given, or by the input itself.
    const bool optional = std::holds_alternative<std::optional<double>*>(declared.to);
    control.rests = control.may_rest && !given && !(optional && std::isfinite(value));
    if (declared.name == "--water" && scales_.own_water) control.rest_change = {"--no-water", "true"};
    if (!std::isfinite(value))
      value = control.logarithmic ? std::sqrt(control.least * control.most)
                                  : control.least + (control.most - control.least) / 4;
    // Typed values may be outside.
    control.least = std::min(control.least, value), control.most = std::max(control.most, value);
    return true;
  }

  void set_ends(const cli::Option& option, const std::optional<double>& usual, Control& control) const {
    const cli::NumberRange& range = option.range;
    const bool no_least = range.least <= -cli::kMostOfGround;
    if (!no_least && range.most - range.least <= kWidest) {
      control.least = range.least, control.most = range.most;
      // Small and large counts need the same relative precision.
      if (control.whole && range.most - range.least > kMostCount) control.logarithmic = true;
      if (range.above_least) control.least = range.most / (kSpan * kSpan), control.logarithmic = true;
    } else if (option.unit == "metres" && no_least) {
      control.least = scales_.low, control.most = scales_.high + kBeyond * (scales_.high - scales_.low);
    } else if (option.unit == "metres") {
      control.least = kLeastLength * scales_.across, control.most = scales_.across;
      control.logarithmic = true;
    } else if (usual && *usual > 0) {
      control.least = std::max(*usual / kSpan, range.least), control.most = std::min(kSpan * *usual, range.most);
      if (control.whole) control.least = std::max(std::floor(*usual / kSpan), range.least);
      control.logarithmic = true;
    } else {
      control.least = std::max(range.least, 0.0), control.most = control.whole ? kMostCount : 1;
    }
  }

  const Opening& opening_;
  const ControlScales& scales_;
};

}  // namespace

std::vector<Control> controls_of(const Opening& opening, const ControlScales& scales) {
  const cli::Use use{opening.kind, name_of(opening.options->picture.look),
                     cli::march_of(*opening.options, opening.kind)};
  const Maker maker(opening, scales);
  std::vector<Control> controls;
  for (const cli::Declared& declared : opening.command().options()) {
    if (declared.positional() || !has(kShown, declared.option.topic) || has(kNone, declared.name)) continue;
    if (!cli::has_effect(declared, use)) continue;
    if (std::optional<Control> control = maker.of(declared)) controls.push_back(std::move(*control));
  }
  return controls;
}

std::optional<double> typed_number(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  std::string number(text);
  if (const std::size_t comma = number.find(','); comma != std::string::npos) {
    // "1.234,5" and "1,234,5" may mean anything.
    if (number.find_first_of(".,", comma + 1) != std::string::npos || number.find('.') < comma) return {};
    number[comma] = '.';
  }
  const std::optional<double> value = number_from(number);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

OptionChange change_of(const Control& control) {
  const auto& n = control.numbers;
  if (control.rests) return control.rest_change.value_or(OptionChange{control.option, {}});
  switch (control.kind) {
    case ControlKind::flag:
      if (control.worded) return {control.option, control.on ? "true" : "false"};
      return {control.option, control.on != control.inverted ? std::optional<std::string>("true") : std::nullopt};
    case ControlKind::choice:
      return {control.option, control.choice};
    case ControlKind::number:
      return {control.option, control.whole ? fmt::format("{:.0f}", n[0]) : short_text(n[0])};
    case ControlKind::pair:
      return {control.option, short_text(n[0]) + "," + short_text(n[1])};
    case ControlKind::angles:
      return {control.option, fmt::format("{:.2f},{:.2f}", n[0], n[1])};
    case ControlKind::colour:
      break;
  }
  const auto byte = [](double share) { return std::lround(255 * std::clamp(share, 0.0, 1.0)); };
  return {control.option, fmt::format("{:02x}{:02x}{:02x}", byte(n[0]), byte(n[1]), byte(n[2]))};
}

}  // namespace scarp::viewer
