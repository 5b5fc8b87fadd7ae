// SPDX-License-Identifier: MIT
// Private to scarp/accel: encodes samples as height codes.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "scarp/accel/height_code.h"

namespace scarp {

constexpr double kTopCode = 65535;

// Encodes outwards. Floats are first moved outwards by the fraction kClear of a step, which exceeds all rounding
// errors. Let M be the greatest magnitude that codes cover: steps are at least kLeastStep * M, which even adjacent
// floats do not require. A position, at most 2^16 steps, has a relative error of 4 * 2^-53; the height of a code has an
// error of 2^-51 M, which is 2^-11 steps. All operations are in double and without branches, so that compilers
// vectorise them. Blocks of holes have -infinity here, and the lowest code.
constexpr double kClear = 0x1p-8, kLeastStep = 0x1p-40;

template <class T>
void encode(const HeightCode& code, double beyond, const T* samples, int count, std::uint16_t* codes) {
  for (int i = 0; i < count; ++i) {
    if constexpr (std::is_integral_v<T>) {
      codes[i] = static_cast<std::uint16_t>(samples[i] - std::numeric_limits<T>::lowest());
    } else {
      const double place = (static_cast<double>(samples[i]) - code.base) * code.per_step + beyond;
      const double above = place > 0 ? place : 0;
      codes[i] = static_cast<std::uint16_t>(static_cast<int>(above < kTopCode ? above : kTopCode));
    }
  }
}
template <class T>
void encode_above(const HeightCode& code, const T* samples, int count, std::uint16_t* codes) {
  encode(code, 1 + kClear, samples, count, codes);
}
template <class T>
void encode_below(const HeightCode& code, const T* samples, int count, std::uint16_t* codes) {
  encode(code, -kClear, samples, count, codes);
}

}  // namespace scarp
