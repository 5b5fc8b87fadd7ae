// SPDX-License-Identifier: MIT
// A terrain function in device memory: its three programs, interpreted by shaders
// (march/function/function_heights.glsl.h).
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/function_words.h"
#include "scarp/field/height_function.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

/// A terrain function in device memory.
class DeviceFunction {
 public:
  /// Throws Error if the device lacks memory or a constant does not fit in single precision.
  DeviceFunction(const Device& device, const HeightFunction& function);

  /// Address of the program's first instruction.
  std::uint64_t address(FunctionUse use) const;
  /// Error bound of heights computed on the device.
  const SingleRounding& rounding(FunctionUse use) const { return rounding_[static_cast<std::size_t>(use)]; }
  /// Size on the device, in bytes.
  std::uint64_t bytes() const { return code_.bytes(); }

 private:
  std::vector<std::size_t> begins_;  // first instruction of each program, then the end
  DeviceBuffer code_;
  std::vector<SingleRounding> rounding_;
};

}  // namespace scarp
