// SPDX-License-Identifier: MIT
#include "scarp/accel/device_function.h"

namespace scarp {
namespace {

constexpr FunctionUse kUses[] = {FunctionUse::march, FunctionUse::shadow, FunctionUse::normal};

std::vector<std::size_t> begins_of(const HeightFunction& function) {
  std::vector<std::size_t> begins{0};
  for (const FunctionUse use : kUses) begins.push_back(begins.back() + function.program(use).code.size());
  return begins;
}

}  // namespace

// The program of a plane may be empty, but buffers may not.
DeviceFunction::DeviceFunction(const Device& device, const HeightFunction& function)
    : begins_(begins_of(function)),
      code_(device, (begins_.back() + 1) * sizeof(glsl::ScarpInstruction), "a terrain function") {
  for (const FunctionUse use : kUses) {
    rounding_.emplace_back(function.program(use));
    const auto words = function_words(function.program(use));
    if (!words.empty())
      upload(code_, address(use) - code_.address(), words.data(), words.size() * sizeof(glsl::ScarpInstruction));
  }
}

std::uint64_t DeviceFunction::address(FunctionUse use) const {
  return code_.address() + begins_[static_cast<std::size_t>(use)] * sizeof(glsl::ScarpInstruction);
}

}  // namespace scarp
