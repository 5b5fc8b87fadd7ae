// SPDX-License-Identifier: MIT
#include "app/cli/gdal_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/options/option.h"

namespace scarp::cli {
namespace {

constexpr std::pair<std::string_view, std::string_view> kFlags[] = {{"-oz", "--observer-height"},
                                                                    {"-tz", "--target-height"},
                                                                    {"-md", "--max-distance"},
                                                                    {"-cc", "--cc"},
                                                                    {"-vv", "--visible-value"},
                                                                    {"-iv", "--hidden-value"},
                                                                    {"-ov", "--out-of-range-value"},
                                                                    {"-om", "--mode"},
                                                                    {"-a_nodata", "--nodata-value"},
                                                                    {"-b", "--band"},
                                                                    {"-co", "--co"},
                                                                    {"-of", "--of"},
                                                                    {"-f", "--of"}};

}  // namespace

std::vector<std::string> without_gdal_words(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  std::string x, y;
  bool gdal = false, output = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&] {
      if (i + 1 == words.size()) throw WrongUsage(fmt::format("{}: needs a value", word));
      gdal = true;
      return words[++i];
    };
    const auto flag =
        std::find_if(std::begin(kFlags), std::end(kFlags), [&](const auto& one) { return one.first == word; });
    if (word == "-ox") {
      x = value();
    } else if (word == "-oy") {
      y = value();
    } else if (word == "-q") {
      gdal = true;
      out.emplace_back("--quiet");
    } else if (flag != std::end(kFlags)) {
      // Joined by "=", so that negative numbers are read as values.
      out.push_back(fmt::format("{}={}", flag->second, value()));
    } else {
      output = output || word == "-o" || word.starts_with("--output");
      out.push_back(word);
    }
  }
  if (x.empty() != y.empty()) throw WrongUsage("-ox and -oy: give both");
  if (gdal && !output && !out.empty() && !out.back().starts_with('-')) {
    out.back() = "--output=" + out.back();
  }
  if (!x.empty()) out.push_back(fmt::format("--observer={},{}", x, y));
  return out;
}

}  // namespace scarp::cli
