// SPDX-License-Identifier: MIT
#include "scarp/accel/code_tables.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "scarp/accel/height_encode.h"
#include "scarp/accel/max_pyramid.glsl.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

using Key = std::uint32_t;

constexpr float kHighest = std::numeric_limits<float>::max();

Key key_of(float sample) { return glsl::float_key(std::bit_cast<std::uint32_t>(sample)); }
float sample_of(Key key) { return std::bit_cast<float>(glsl::float_bits(key)); }

// Key of a float near a position on the code scale.
Key key_near(const HeightCode& code, double place) {
  return key_of(static_cast<float>(std::clamp(code.base + code.step * place, -double{kHighest}, double{kHighest})));
}

// Returns the greatest key in [low, high] for which `holds` is true. It must be true for `low` and all keys up to the
// result, and false after it. Searches near `guess` first, with doubling steps.
template <class Holds>
Key last_key(Key low, Key high, Key guess, Holds holds) {
  Key step = 1;
  if (holds(guess)) {
    low = guess;
    while (low < high) {
      const Key next = high - low > step ? low + step : high;
      if (!holds(next)) {
        high = next - 1;
        break;
      }
      low = next;
      step *= 2;
    }
  } else {
    high = guess - 1;
    while (low < high) {
      const Key next = high - low > step ? high - step : low;
      if (holds(next)) {
        low = next;
        break;
      }
      high = next - 1;
      step *= 2;
    }
  }
  while (low < high) {
    const Key middle = low + (high - low + 1) / 2;
    if (holds(middle)) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

std::uint16_t code_above(const HeightCode& code, Key key) {
  const float sample = sample_of(key);
  std::uint16_t result;
  encode_above(code, &sample, 1, &result);
  return result;
}

std::uint16_t code_below(const HeightCode& code, Key key) {
  const float sample = sample_of(key);
  std::uint16_t result;
  encode_below(code, &sample, 1, &result);
  return result;
}

}  // namespace

std::vector<std::uint32_t> code_tables(const HeightCode& code) {
  constexpr int kCodes = static_cast<int>(glsl::kPyramidCodes);
  const Key least = key_of(-kHighest), greatest = key_of(kHighest);
  std::vector<std::uint32_t> tables(2 * static_cast<std::size_t>(kCodes));
  parallel_for(kCodes, 1 << 12, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t at = begin; at < end; ++at) {
      const auto wanted = static_cast<std::uint16_t>(at);
      // A block of holes has key 0, and no sample may be below the ceiling of code 0.
      const auto above = [&](Key key) { return code_above(code, key) <= wanted; };
      tables[static_cast<std::size_t>(at)] =
          above(least) ? last_key(least, greatest, key_near(code, wanted - kClear), above) : 0;
      const auto below = [&](Key key) { return code_below(code, key) < wanted; };
      tables[static_cast<std::size_t>(kCodes + at)] =
          wanted == 0    ? 0
          : below(least) ? last_key(least, greatest, key_near(code, wanted + kClear), below) + 1
                         : least;
    }
  });
  return tables;
}

}  // namespace scarp
