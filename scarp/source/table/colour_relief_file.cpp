// SPDX-License-Identifier: MIT
#include "scarp/source/table/colour_relief_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/source/text_lines.h"

namespace scarp {
namespace {

struct NamedColour {
  std::string_view name;
  int r, g, b;
};
constexpr std::array kNamed = {
    NamedColour{"white", 255, 255, 255}, NamedColour{"black", 0, 0, 0},      NamedColour{"red", 255, 0, 0},
    NamedColour{"green", 0, 255, 0},     NamedColour{"blue", 0, 0, 255},     NamedColour{"yellow", 255, 255, 0},
    NamedColour{"magenta", 255, 0, 255}, NamedColour{"cyan", 0, 255, 255},   NamedColour{"aqua", 0, 191, 191},
    NamedColour{"grey", 191, 191, 191},  NamedColour{"gray", 191, 191, 191}, NamedColour{"orange", 255, 127, 0},
    NamedColour{"brown", 191, 127, 63},  NamedColour{"purple", 127, 0, 255}, NamedColour{"violet", 127, 0, 255},
    NamedColour{"indigo", 0, 127, 255}};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  constexpr std::string_view kSeparators = " ,\t:";
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; (begin = line.find_first_not_of(kSeparators, begin)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return fields;
}

// A value with its colour.
struct Entry {
  double value;
  vec3 srgb;
};

class ColourReliefReader {
 public:
  explicit ColourReliefReader(const std::string& path) : path_(path) {}

  RampStops read() {
    for_lines(path_, [&](const std::string& text, int number) {
      line_ = number;
      take(text);
    });
    if (entries_.empty()) throw Error(fmt::format("{}: no line 'value R G B'", path_));
    return stops();
  }

 private:
  [[noreturn]] void refuse(std::string_view what) const {
    throw Error(fmt::format("{}: line {}: {}", path_, line_, what));
  }

  void take(std::string_view text) {
    const std::vector<std::string_view> fields = fields_of(text);
    if (fields.empty() || fields[0].starts_with('#')) return;
    const std::string first = lower_case(fields[0]);
    if (first == "nv" || first == "default") return;
    if (first == "interpolation") {
      if (fields.size() > 1 && lower_case(fields[1]) != "interpolated")
        refuse(fmt::format("unsupported interpolation '{}' (must be INTERPOLATED)", fields[1]));
      return;
    }
    if (fields.size() < 2) refuse(fmt::format("'{}' has no colour (expected 'value R G B')", fields[0]));
    std::string_view value = fields[0];
    const bool percent = value.ends_with('%');
    if (percent) value.remove_suffix(1);
    if (percent_ && *percent_ != percent) refuse("percent beside metres (use one of them on all lines)");
    percent_ = percent;
    entries_.push_back({number(value) / (percent ? 100 : 1), colour(fields)});
  }

  double number(std::string_view text) const {
    double value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(value))
      refuse(fmt::format("'{}' is not a number", text));
    return value;
  }

  vec3 colour(const std::vector<std::string_view>& fields) const {
    // A number here is the start of R G B: colour names contain no digits.
    if (fields[1].find_first_of("0123456789") == std::string_view::npos) {
      const std::string name = lower_case(fields[1]);
      const auto found = std::find_if(kNamed.begin(), kNamed.end(), [&](const auto& c) { return c.name == name; });
      if (found == kNamed.end()) refuse(fmt::format("unknown colour '{}' (expected R G B or a name)", fields[1]));
      return vec3(found->r, found->g, found->b) / 255.0f;
    }
    if (fields.size() < 4) refuse("too short (expected 'value R G B')");
    vec3 rgb;
    for (int i = 0; i < 3; ++i) {
      const double component = number(fields[static_cast<std::size_t>(i) + 1]);
      if (!(component >= 0 && component <= 255))
        refuse(fmt::format("{} is not a colour component (expected 0 to 255)", component));
      rgb[i] = static_cast<float>(component);
    }
    return rgb / 255.0f;
  }

  RampStops stops() {
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.value < b.value; });
    RampStops stops;
    stops.stretched = *percent_;
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      const Entry &low = entries_[i - 1], &high = entries_[i];
      if (low.value < high.value) stops.slices.push_back({low.value, high.value, low.srgb, high.srgb});
    }
    // The same colour everywhere.
    const Entry& last = entries_.back();
    if (stops.slices.empty()) stops.slices.push_back({last.value, last.value + 1, last.srgb, last.srgb});
    return stops;
  }

  std::string path_;
  int line_ = 0;
  std::optional<bool> percent_;
  std::vector<Entry> entries_;
};

}  // namespace

RampStops read_colour_relief(const std::string& path) { return ColourReliefReader(path).read(); }

}  // namespace scarp
