// SPDX-License-Identifier: MIT
// 16-bit height codes, rounded outwards: the entries of a pyramid.
#pragma once

#include <cstdint>
#include <optional>

#include "scarp/field/height_field.h"

namespace scarp {

/// A linear mapping from 16-bit codes to heights.
struct HeightCode {
  double base = 0;
  double step = 1;      ///< sample units, > 0
  double per_step = 1;  ///< 1 / step, rounded

  /// Returns the height of a code in sample units. Builders and readers of codes use exactly this expression.
  double height(std::uint16_t code) const { return base + step * code; }
  /// Returns the code of a height, plus one, for rays in codes.
  float code_over(double height) const { return static_cast<float>((height - base) * per_step + 1); }
};

/// Range of sample values, in sample units.
struct SampleRange {
  double low = 0;
  double high = 0;
};

/// Returns the range that codes must cover: the field's samples and `reserve`. Codes of 16-bit
/// samples cover all values anyway.
SampleRange code_range(const HeightField& field, const std::optional<SampleRange>& reserve);
/// Returns whether the field's samples are still in range; always true for 16-bit samples, whose codes cover all
/// values.
bool is_in_range(const HeightField& field, const SampleRange& range);
/// Returns the mapping for a range. For 16-bit samples, codes equal the samples, for any range.
HeightCode height_code(SampleType type, const SampleRange& range);

}  // namespace scarp
