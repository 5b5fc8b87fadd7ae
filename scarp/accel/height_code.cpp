// SPDX-License-Identifier: MIT
#include "scarp/accel/height_code.h"

#include <algorithm>
#include <cmath>

#include "scarp/accel/height_encode.h"

namespace scarp {

SampleRange code_range(const HeightField& field, const std::optional<SampleRange>& reserve) {
  SampleRange range{0, 0};
  if (!field.all_nodata()) range = {field.min_sample(), field.max_sample()};
  if (reserve) range = {std::min(range.low, reserve->low), std::max(range.high, reserve->high)};
  return range;
}

bool is_in_range(const HeightField& field, const SampleRange& range) {
  return field.sample_type() != SampleType::float32 || field.all_nodata() ||
         (field.min_sample() >= range.low && field.max_sample() <= range.high);
}

HeightCode height_code(SampleType type, const SampleRange& range) {
  if (type != SampleType::float32) return {type == SampleType::int16 ? -32768.0 : 0.0, 1, 1};
  // The lowest sample gets code 1, half a step clear of rounding, because code 0 means no minimum. The step grows until
  // the highest code is not below the highest sample.
  const double magnitude = std::max(std::abs(range.low), std::abs(range.high));
  double step = std::max((range.high - range.low) / (kTopCode - 2), kLeastStep * magnitude);
  if (!(step > 0)) step = 0x1p-20;
  HeightCode code;
  do {
    code = {range.low - 1.5 * step, step, 1 / step};
    step *= 1 + 0x1p-20;
  } while (code.height(static_cast<std::uint16_t>(kTopCode)) < range.high);
  return code;
}

}  // namespace scarp
