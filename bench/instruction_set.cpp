// SPDX-License-Identifier: MIT
#include "bench/instruction_set.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <cstdint>

#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

std::string held_to = "native";
std::string configuration;

// Lower bits are better sets.
std::int64_t best(std::int64_t targets) { return targets & -targets; }

}  // namespace

void hold_to_instruction_set(std::string_view name) {
  if (name == "native") return;
  std::int64_t targets = HWY_AVX2;
  if (name == "avx512") {
    targets = HWY_AVX3 | HWY_AVX3_DL;
  } else if (name != "avx2") {
    throw Error(fmt::format("instruction set '{}': unknown (available: native, avx2, avx512)", name));
  }
  targets &= hwy::SupportedTargets();
  if (targets == 0) throw Error(fmt::format("instruction set '{}': this machine does not have it", name));
  hwy::SetSupportedTargetsForTest(targets);
  held_to = name;
  configuration = fmt::format("isa={}", name);
}

std::string instruction_set() {
  return fmt::format("{} ({})", held_to, hwy::TargetName(best(hwy::SupportedTargets() & HWY_TARGETS)));
}

const char* embree_configuration() { return configuration.c_str(); }

}  // namespace scarp::bench
