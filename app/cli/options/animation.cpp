// SPDX-License-Identifier: MIT
#include "app/cli/options/animation.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <variant>

namespace scarp::cli {
namespace {

// The whole text as a number.
std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(number)) return {};
  return number;
}

constexpr std::string_view kDigits = "0123456789.eE+-";

// Start of the longest number at the end of a text; its size: none.
std::size_t number_at_end(std::string_view text) {
  std::size_t first = text.size();
  for (std::size_t i = text.size(); i-- > 0 && kDigits.find(text[i]) != std::string_view::npos;) {
    if (number_of(text.substr(i))) first = i;
  }
  return first;
}

// End of the longest number at the start of a text; 0: none.
std::size_t number_at_start(std::string_view text) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < text.size() && kDigits.find(text[i]) != std::string_view::npos; ++i) {
    if (number_of(text.substr(0, i + 1))) end = i + 1;
  }
  return end;
}

// Whether an option may take numbers. Setters check their texts themselves.
bool takes_numbers(const Declared& declared) {
  return std::visit(
      [](const auto& to) {
        using To = std::decay_t<decltype(to)>;
        return !std::is_same_v<To, bool*> && !std::is_same_v<To, Off> && !std::is_same_v<To, std::string*> &&
               !std::is_same_v<To, std::vector<std::string>*> && !std::is_same_v<To, List<std::string>>;
      },
      declared.to);
}

}  // namespace

Animation::Animation(const Command& command, const std::string& text) {
  const auto wrong = [&](const std::string& why) { return WrongUsage(fmt::format("--animate '{}': {}", text, why)); };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw wrong("expected NAME=VALUE with a range FROM..TO, for example shrink=1..0.2 or sun=90..270,30");
  const std::string name =
      "--" + text.substr(text.starts_with("--") ? 2 : 0, equals - (text.starts_with("--") ? 2 : 0));
  option_ = command.find(name);
  if (!option_) {
    throw wrong(fmt::format("there is no option {} (see '{} {} --help all')", name, command.program(), command.name()));
  }
  // Options of flights are those of all frames together.
  if (!takes_numbers(*option_) || !option_->option.files.empty() || option_->option.topic == Topic::flight)
    throw wrong(fmt::format("{} takes no numbers for a picture", name));
  std::string rest = text.substr(equals + 1);
  for (std::size_t dots = rest.find(".."); dots != std::string::npos; dots = rest.find("..")) {
    const std::size_t first = number_at_end(std::string_view(rest).substr(0, dots));
    const std::size_t length = number_at_start(std::string_view(rest).substr(dots + 2));
    if (first == dots || length == 0) throw wrong("expected a number before and after '..'");
    (ranges_.empty() ? before_ : ranges_.back().after) = rest.substr(0, first);
    ranges_.push_back(
        {*number_of(rest.substr(first, dots - first)), *number_of(rest.substr(dots + 2, length)), std::string()});
    rest = rest.substr(dots + 2 + length);
  }
  if (ranges_.empty()) throw wrong("has no range FROM..TO (type the option itself)");
  ranges_.back().after = rest;
}

std::string Animation::text_at(double share, bool whole) const {
  std::string text = before_;
  for (const Range& range : ranges_) {
    const double number = share < 1 ? range.from + share * (range.to - range.from) : range.to;
    text += fmt::format("{}{}", whole ? std::round(number) + 0.0 : number, range.after);
  }
  return text;
}

void Animation::set(Command& command, double share) const {
  const std::string exact = text_at(share, false), whole = text_at(share, true);
  try {
    command.retype(*option_, exact);
  } catch (const Error&) {
    if (whole == exact) throw;
    try {
      command.retype(*option_, whole);
      return;
    } catch (const Error&) {
    }
    throw;  // the exact number is what was asked for
  }
}

}  // namespace scarp::cli
