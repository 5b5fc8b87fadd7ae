// SPDX-License-Identifier: MIT
// Private to the station: the samples of ESRI ASCII grids as text. GDAL chooses their type by the first of them, and
// reads words that are not numbers as zero.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace scarp {

/// Reads the words of an ASCII grid one piece of text after another, at about a nanosecond per byte.
class TextSamples {
 public:
  /// `count`: samples of the grid; what follows them is ignored, as by GDAL.
  explicit TextSamples(double count) : left_(count) {}

  /// Takes the next bytes of the file. Throws Error (without the file's name) with line and word if a sample is not a
  /// number.
  void take(std::string_view bytes);
  /// Takes the last word.
  void end();
  /// Whether all samples so far are integers.
  bool integers() const { return integers_; }

 private:
  std::string_view without_header(std::string_view text);
  void take_words(std::string_view text);
  void judge(std::string_view word, unsigned kinds);

  double left_;
  bool in_header_ = true, integers_ = true;
  std::int64_t line_ = 1;
  std::string rest_;  // bytes that may be part of a longer word, or line of the header
};

/// Throws Error (without the file's name) if a sample of the grid in a file is not a number. Returns whether all are
/// integers.
bool has_integers_alone(const std::string& path, double count);

}  // namespace scarp
