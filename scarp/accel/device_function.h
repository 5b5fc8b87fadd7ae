// SPDX-License-Identifier: MIT
// A terrain function in the memory of a Vulkan device: its three programs, which shaders interpret
// (march/function/function_heights.glsl.h).
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/function_words.h"
#include "scarp/field/height_function.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

class DeviceFunction {
 public:
  /// Throws Error: no memory for it, numbers that do not fit into floats.
  DeviceFunction(const Device& device, const HeightFunction& function);

  /// Of the program's first instruction.
  std::uint64_t address(FunctionUse use) const;
  /// What heights as computed on the device are off by.
  const SingleRounding& rounding(FunctionUse use) const { return rounding_[static_cast<std::size_t>(use)]; }
  /// On the device.
  std::uint64_t bytes() const { return code_.bytes(); }

 private:
  std::vector<std::size_t> begins_;  // of the programs, in instructions; and the end
  DeviceBuffer code_;
  std::vector<SingleRounding> rounding_;
};

}  // namespace scarp
