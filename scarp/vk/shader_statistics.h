// SPDX-License-Identifier: MIT
// Reports how a driver compiles a compute or fragment shader: instructions, registers, spills. Nothing runs and no
// memory is allocated, so a device without memory suffices, such as the null device of Mesa's RADV:
//
//   ShaderCompiler compiler;                            the first device whose driver reports statistics
//   for (const auto& [name, value] : compiler.statistics(program)) ...
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scarp/vk/shader_program.h"

namespace scarp {

/// One statistic of a compiled shader, with the driver's name for it, such as "VGPRs" or "Code size".
struct ShaderStatistic {
  std::string name;
  double value = 0;
};

/// The compiler of a Vulkan driver. Each object searches for drivers again, so the environment may change between
/// objects.
class ShaderCompiler {
 public:
  /// Throws Error if there is no loader, no device, or none whose driver reports statistics
  /// (VK_KHR_pipeline_executable_properties).
  ShaderCompiler();
  ShaderCompiler(ShaderCompiler&&) noexcept;
  ShaderCompiler& operator=(ShaderCompiler&&) noexcept;
  ~ShaderCompiler();

  const std::string& device_name() const;
  /// Returns the driver's name and version.
  const std::string& driver() const;

  /// Compiles the program and returns the statistics in the driver's order. Throws Error if the driver rejects it.
  std::vector<ShaderStatistic> statistics(const ShaderProgram& program) const;
  /// Compiles the program and returns its disassembly, which RADV reports. Throws Error if the driver rejects the
  /// program or does not report a disassembly.
  std::string disassembly(const ShaderProgram& program) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
