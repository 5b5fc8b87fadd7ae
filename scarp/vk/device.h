// SPDX-License-Identifier: MIT
// Vulkan devices: which there are, which of them can be used, and one of them opened for computing.
//
//   Device device({.choice = "auto"});
//   DeviceBuffer numbers(device, bytes, "numbers");              memory.h
//   upload(numbers, 0, data, bytes);
//   ComputePipeline twice(device, kTwiceWords, "twice", sizeof(Push));   pipeline.h
//   Commands commands(device);                                   commands.h
//   commands.dispatch(twice, push, {groups, 1, 1});
//   commands.run();                                              waits; commands.passes() tells how long each took
//   download(numbers, 0, data, bytes);
//
// Shaders reach buffers by their addresses alone, which push constants carry: no descriptors, and no limit on the size
// of what one shader sees but that of an allocation. Everything made from a device keeps it open. A device and what
// is made from it are used by one thread at a time. The Vulkan loader is opened when it is first asked for: a program
// that never asks starts without.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

enum class DeviceKind : std::uint8_t { discrete_gpu, integrated_gpu, virtual_gpu, cpu, other };

/// "discrete GPU", "CPU" and so on.
std::string_view name_of(DeviceKind kind);

/// What a device can do, as far as Scarp asks.
struct DeviceAbilities {
  std::uint32_t api_major = 0, api_minor = 0;
  bool compute_queue = false;
  bool scalar_block_layout = false;
  bool buffer_device_address = false;
  // Used where they are there; nothing needs them.
  bool float64 = false;
  bool int64 = false;
  bool timestamps = false;
  bool draws = false;  ///< a queue that computes also draws triangles
};

/// The first thing that is needed and not there, as in "Vulkan 1.2 (it has 1.1)"; empty when nothing is missing.
std::string missing_ability(const DeviceAbilities& abilities);

struct DeviceDescription {
  std::string name;
  DeviceKind kind = DeviceKind::other;
  std::string driver;                      ///< name and version, as the driver says them
  std::string api_version;                 ///< of Vulkan, "1.3.230"
  std::uint64_t memory_bytes = 0;          ///< of the largest heap that is local to the device
  std::uint64_t max_allocation_bytes = 0;  ///< one buffer at most
  std::uint64_t max_storage_range = 0;     ///< bytes of one storage buffer binding; addresses reach further
  std::uint32_t max_workgroup_invocations = 0;
  std::uint32_t shared_memory_bytes = 0;
  std::uint32_t subgroup_size = 0;
  DeviceAbilities abilities;
  std::string missing;  ///< missing_ability(); empty: usable

  bool usable() const { return missing.empty(); }
};

/// All devices, in the order of the loader; empty where there is no loader or no driver, and `why_none` says which.
struct DeviceList {
  std::vector<DeviceDescription> devices;
  std::string why_none;
};
DeviceList list_devices();

struct DeviceSettings {
  /// "auto": the first usable one of discrete, integrated, virtual GPU, CPU, other. "gpu": the same without CPU and
  /// other. "cpu": a CPU device. Anything else: the first whose name contains it, whatever the case.
  std::string choice = "auto";
  bool validation = false;  ///< Khronos validation layer with synchronisation validation; its messages are collected
  double timeout_s = 600;   ///< what one run of commands may take, > 0
};

/// The index of the chosen one. Throws Error: none fits (which there are), those that fit lack something (what).
std::size_t choose_device(const std::vector<DeviceDescription>& devices, const std::string& choice);

/// Cheap to copy: copies are the same open device.
class Device {
 public:
  /// Throws Error: no loader, no device, none that fits the choice, a missing feature, no validation layer.
  explicit Device(const DeviceSettings& settings = {});

  const DeviceDescription& description() const;
  /// What the validation layer has said so far; empty without `validation`.
  std::vector<std::string> validation_messages() const;

  struct Impl;  // raii.h
  const std::shared_ptr<Impl>& impl() const { return impl_; }

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace scarp
