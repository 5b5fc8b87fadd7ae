// SPDX-License-Identifier: MIT
// One terrain function of each kind, and a random generator for tests.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "scarp/field/function_node.h"

namespace scarp::test {

struct NamedFunction {
  std::string name;
  Function function;
  bool smooth;  ///< no creases: finite differences match the gradient everywhere
};

/// All nodes, all kinds of noise; features of 10 to 3000 m, heights of some hundred metres.
std::vector<NamedFunction> terrain_functions();

class FunctionRandom {
 public:
  explicit FunctionRandom(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace scarp::test
