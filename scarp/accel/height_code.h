// SPDX-License-Identifier: MIT
// Heights as 16-bit codes, rounded outwards: what the entries of a pyramid are made of.
#pragma once

#include <cstdint>
#include <optional>

#include "scarp/field/height_field.h"

namespace scarp {

/// Heights as 16-bit codes.
struct HeightCode {
  double base = 0;
  double step = 1;      ///< sample units, > 0
  double per_step = 1;  ///< 1 / step, rounded

  /// In sample units. Who builds codes and who reads them computes just this.
  double height(std::uint16_t code) const { return base + step * code; }
};

/// Sample values, in sample units.
struct SampleRange {
  double low = 0;
  double high = 0;
};

/// The samples that codes have to hold: those of the field and `reserve`. Means nothing for 16-bit samples.
SampleRange code_range(const HeightField& field, const std::optional<SampleRange>& reserve);
/// Whether the field's samples are still in it; always for 16-bit samples, whose codes hold all there are.
bool is_in_range(const HeightField& field, const SampleRange& range);
/// For 16-bit samples codes are the samples, whatever the range.
HeightCode height_code(SampleType type, const SampleRange& range);

}  // namespace scarp
