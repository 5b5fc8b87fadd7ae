// SPDX-License-Identifier: MIT
// Private to the station: the samples of ESRI ASCII grids as text. GDAL chooses the sample type by the first samples,
// and reads words that are not numbers as zero.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace scarp {

/// Reads the words of an ASCII grid piece by piece, at about a nanosecond per byte.
class TextSamples {
 public:
  /// `count`: number of samples in the grid; any text after them is ignored, as by GDAL.
  explicit TextSamples(double count) : left_(count) {}

  /// Processes the next bytes of the file. Throws Error (without the file's name) with line and word if a sample is not
  /// a number.
  void take(std::string_view bytes);
  /// Processes the last word.
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
  std::string rest_;  // bytes that may belong to a longer word or header line
};

/// Returns whether all samples of the grid in a file are integers. Throws Error (without the file's name) if one is not
/// a number.
bool has_integers_alone(const std::string& path, double count);

}  // namespace scarp
