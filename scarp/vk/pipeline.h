// SPDX-License-Identifier: MIT
// Compute pipelines.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "scarp/vk/device.h"

namespace scarp {

struct ShaderProgram;  // shader_program.h

/// Push-constant size that every device supports, in bytes.
constexpr std::uint32_t kMaxPushBytes = 128;

/// A compute shader with its layout.
class ComputePipeline {
 public:
  /// `spirv` has the entry point main, no bindings and a push-constant block of `push_bytes` (a multiple of 4, at most
  /// kMaxPushBytes). `constants` are the specialisation constants 0, 1, 2, ..., each a 32-bit word (bit_cast floats).
  /// Throws Error if the driver rejects the shader.
  ComputePipeline(const Device& device, std::span<const std::uint32_t> spirv, const std::string& name,
                  std::uint32_t push_bytes, std::span<const std::uint32_t> constants = {});
  ComputePipeline(const Device& device, const ShaderProgram& program, const std::string& name);
  ComputePipeline(ComputePipeline&&) noexcept;
  ComputePipeline& operator=(ComputePipeline&&) noexcept;
  ~ComputePipeline();

  const std::string& name() const;

  struct Impl;  // raii.h
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp
