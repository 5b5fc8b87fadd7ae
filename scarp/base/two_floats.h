// SPDX-License-Identifier: MIT
// Doubles as the sum of two floats.
#pragma once

namespace scarp {

/// A double rounded to float, as a double. The conversion goes through memory: where g++ 12 converts two doubles at
/// once (-O2 and above), it removes a conversion to float and back.
inline double as_float(double value) {
  const volatile float rounded = static_cast<float>(value);
  return static_cast<double>(rounded);
}

/// Splits a value into high + low, accurate to at least 48 bits.
inline void split(double value, float& high, float& low) {
  const double rounded = as_float(value);
  high = static_cast<float>(rounded);
  low = static_cast<float>(value - rounded);
}

}  // namespace scarp
