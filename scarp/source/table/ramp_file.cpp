// SPDX-License-Identifier: MIT
#include "scarp/source/table/ramp_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/source/text_lines.h"

namespace scarp {
namespace {

class CptReader {
 public:
  explicit CptReader(const std::string& path) : path_(path) {}

  RampStops read() {
    for_lines(path_, [&](const std::string& text, int number) {
      line_ = number;
      take(text);
    });
    if (stops_.slices.empty()) throw Error(fmt::format("{}: no line 'low R G B high R G B'", path_));
    const double low = stops_.slices.front().low, high = stops_.slices.back().high;
    stops_.hinged = hinge_ && low == -1 && high == 1;
    stops_.stretched = stops_.hinged || (low == 0 && high == 1);
    return std::move(stops_);
  }

 private:
  [[noreturn]] void refuse(std::string_view what) const {
    throw Error(fmt::format("{}: line {}: {}", path_, line_, what));
  }

  void take(std::string text) {
    if (text.find("HINGE") != std::string::npos && text.starts_with('#')) hinge_ = true;
    if (text.find("COLOR_MODEL") != std::string::npos && text.find("RGB") == std::string::npos) {
      refuse("unsupported colour model (must be RGB)");
    }
    text = text.substr(0, text.find_first_of("#;"));
    std::istringstream words(text);
    std::vector<std::string> parts;
    for (std::string word; words >> word;) parts.push_back(word);
    // Label marks (L, U, B) may follow the colours; lines that start with B, F or N are not slices.
    while (!parts.empty() && (parts.back() == "L" || parts.back() == "U" || parts.back() == "B")) parts.pop_back();
    if (parts.empty() || parts[0] == "B" || parts[0] == "F" || parts[0] == "N") return;
    std::size_t at = 0;
    RampSlice slice;
    slice.low = number(parts, at);
    slice.srgb_low = colour(parts, at, parts.size() >= 8);
    slice.high = number(parts, at);
    slice.srgb_high = colour(parts, at, parts.size() >= 8);
    if (at != parts.size()) refuse(fmt::format("unexpected '{}' (expected 'low R G B high R G B')", parts[at]));
    if (!(slice.low < slice.high)) refuse(fmt::format("{} to {} does not ascend", slice.low, slice.high));
    if (!stops_.slices.empty() && slice.low != stops_.slices.back().high) {
      refuse(fmt::format("begins at {}, but the previous line ends at {} (values must ascend without gaps)", slice.low,
                         stops_.slices.back().high));
    }
    stops_.slices.push_back(slice);
  }

  double number(const std::vector<std::string>& parts, std::size_t& at) const {
    if (at >= parts.size()) refuse("too short (expected 'low R G B high R G B')");
    return number(parts[at++]);
  }
  double number(const std::string& word) const {
    std::size_t used = 0;
    double value = NAN;
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
    }
    if (used != word.size() || !std::isfinite(value)) refuse(fmt::format("'{}' is not a number", word));
    return value;
  }

  vec3 colour(const std::vector<std::string>& parts, std::size_t& at, bool apart) const {
    vec3 rgb;
    if (apart) {
      for (int i = 0; i < 3; ++i) rgb[i] = static_cast<float>(number(parts, at));
    } else {
      if (at >= parts.size()) refuse("too short (expected 'low R G B high R G B')");
      const std::string& word = parts[at++];
      const std::size_t first = word.find('/');
      if (first == std::string::npos) {
        rgb = vec3(static_cast<float>(number(word)));
      } else {
        const std::size_t second = word.find('/', first + 1);
        if (second == std::string::npos) refuse(fmt::format("'{}' is not a colour (expected R/G/B)", word));
        rgb = vec3(number(word.substr(0, first)), number(word.substr(first + 1, second - first - 1)),
                   number(word.substr(second + 1)));
      }
    }
    for (int i = 0; i < 3; ++i) {
      if (!(rgb[i] >= 0 && rgb[i] <= 255))
        refuse(fmt::format("{} is not a colour component (expected 0 to 255)", rgb[i]));
    }
    return rgb / 255.0f;
  }

  std::string path_;
  int line_ = 0;
  bool hinge_ = false;
  RampStops stops_;
};

}  // namespace

RampStops read_cpt(const std::string& path) { return CptReader(path).read(); }

RampStops ramp_of_row(std::span<const std::uint8_t> rgb) {
  const auto colour = [&](std::size_t i) { return vec3(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]) / 255.0f; };
  const std::size_t colours = rgb.size() / 3, slices = std::max<std::size_t>(1, colours - 1);
  RampStops stops;
  stops.stretched = true;
  for (std::size_t i = 0; i < slices; ++i) {
    const double step = 1.0 / static_cast<double>(slices);
    stops.slices.push_back({step * static_cast<double>(i), i + 1 == slices ? 1.0 : step * static_cast<double>(i + 1),
                            colour(i), colour(std::min(i + 1, colours - 1))});
  }
  return stops;
}

}  // namespace scarp
