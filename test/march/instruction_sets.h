// SPDX-License-Identifier: MIT
// Every instruction set that the build has and the machine can run, for tests of code that is compiled once for each.
#pragma once

#include <cstdint>
#include <vector>

#include "hwy/targets.h"

namespace scarp::test {

inline std::vector<std::int64_t> instruction_sets() {
  std::vector<std::int64_t> sets;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) sets.push_back(left & -left);
  return sets;
}

/// Selects an instruction set during its lifetime; afterwards the machine's default applies again.
class InstructionSet {
 public:
  explicit InstructionSet(std::int64_t set) { hwy::SetSupportedTargetsForTest(set); }
  ~InstructionSet() { hwy::SetSupportedTargetsForTest(0); }
  InstructionSet(const InstructionSet&) = delete;
  InstructionSet& operator=(const InstructionSet&) = delete;
};

}  // namespace scarp::test
