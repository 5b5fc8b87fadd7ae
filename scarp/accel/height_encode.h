// SPDX-License-Identifier: MIT
// Private to the station: samples made into codes.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "scarp/accel/height_code.h"

namespace scarp {

constexpr double kTopCode = 65535;

// From samples to codes, outwards. For floats the quotient may be rounded to either side: what counts is the height
// that the code stands for. All in double and without branches, of which compilers make vector instructions. A block of
// holes has -infinity here, and the lowest code.
inline double code_place(const HeightCode& code, double height) {
  const double place = (height - code.base) * code.per_step;
  const double above = place > 0 ? place : 0;
  return above < kTopCode ? above : kTopCode;
}
inline double whole(double place) { return static_cast<double>(static_cast<int>(place)); }

template <class T>
void encode_above(const HeightCode& code, const T* samples, int count, std::uint16_t* codes) {
  for (int i = 0; i < count; ++i) {
    if constexpr (std::is_integral_v<T>) {
      codes[i] = static_cast<std::uint16_t>(samples[i] - std::numeric_limits<T>::lowest());
    } else {
      const double height = static_cast<double>(samples[i]), place = code_place(code, height);
      const double down = whole(place), first = down + (down < place ? 1.0 : 0.0);
      const double good = first + (code.base + code.step * first < height ? 1.0 : 0.0);
      codes[i] = static_cast<std::uint16_t>(static_cast<int>(good < kTopCode ? good : kTopCode));
    }
  }
}

template <class T>
void encode_below(const HeightCode& code, const T* samples, int count, std::uint16_t* codes) {
  for (int i = 0; i < count; ++i) {
    if constexpr (std::is_integral_v<T>) {
      codes[i] = static_cast<std::uint16_t>(samples[i] - std::numeric_limits<T>::lowest());
    } else {
      const double height = static_cast<double>(samples[i]), first = whole(code_place(code, height));
      const double good = first - (code.base + code.step * first > height ? 1.0 : 0.0);
      codes[i] = static_cast<std::uint16_t>(static_cast<int>(good > 0 ? good : 0.0));
    }
  }
}

}  // namespace scarp
