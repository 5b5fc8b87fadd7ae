// SPDX-License-Identifier: MIT
// A compute shader, ready to run.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "scarp/vk/device.h"

namespace scarp {

/// What every device allows.
constexpr std::uint32_t kMaxPushBytes = 128;

class ComputePipeline {
 public:
  /// `spirv` has the entry point main, no bindings and a push-constant block of `push_bytes` (a multiple of 4, at most
  /// kMaxPushBytes). `constants` are the specialisation constants 0, 1, 2, ..., each a 32-bit word (bit_cast a float).
  /// Throws Error when the driver refuses the shader.
  ComputePipeline(const Device& device, std::span<const std::uint32_t> spirv, const std::string& name,
                  std::uint32_t push_bytes, std::span<const std::uint32_t> constants = {});
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
