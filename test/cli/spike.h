// SPDX-License-Identifier: MIT
// Steep ground, through which coarse marches pass.
#pragma once

#include <string>

#include "scratch.h"

namespace scarp::test {

/// Writes 33 x 33 samples of 1 m, 0 to 2 m high, with a spike of 20 m in the middle. Returns the file.
inline std::string spike_dem(const Scratch& scratch) {
  std::string text = "ncols 33\nnrows 33\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (int i = 0; i < 33 * 33; ++i) text += i == 16 * 33 + 16 ? "20 " : std::to_string(i * 7919 % 23 / 8) + " ";
  return scratch.write("spike.asc", text);
}

}  // namespace scarp::test
