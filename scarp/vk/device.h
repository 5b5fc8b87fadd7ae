// SPDX-License-Identifier: MIT
// Vulkan devices: enumerates them, selects one and opens it for computing.
//
//   Device device({.choice = "auto"});
//   DeviceBuffer numbers(device, bytes, "numbers");              memory.h
//   upload(numbers, 0, data, bytes);
//   ComputePipeline twice(device, kTwiceWords, "twice", sizeof(Push));   pipeline.h
//   Commands commands(device);                                   commands.h
//   commands.dispatch(twice, push, {groups, 1, 1});
//   commands.run();                                              waits; commands.passes() returns the timings
//   download(numbers, 0, data, bytes);
//
// Shaders access buffers only through addresses in push constants: there are no descriptors, and only the allocation
// limit bounds what one shader can access. Objects made from a device keep it open. Only one thread at a time may use a
// device and its objects. The Vulkan loader is opened on first use, so programs that do not use a device run without
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

enum class DeviceKind : std::uint8_t { discrete_gpu, integrated_gpu, virtual_gpu, cpu, other };

/// Returns "discrete GPU", "CPU" and so on.
std::string_view name_of(DeviceKind kind);

/// The features of a device that Scarp uses.
struct DeviceAbilities {
  std::uint32_t api_major = 0, api_minor = 0;
  bool compute_queue = false;
  bool scalar_block_layout = false;
  bool buffer_device_address = false;
  // Optional features.
  bool float64 = false;
  bool int64 = false;
  bool timestamps = false;
  bool draws = false;  ///< the compute queue also supports graphics
};

/// Returns the first required feature that is missing, as in "Vulkan 1.2 (it has 1.1)"; empty if none is missing.
std::string missing_ability(const DeviceAbilities& abilities);

/// Properties of a device.
struct DeviceDescription {
  std::string name;
  DeviceKind kind = DeviceKind::other;
  std::string driver;                      ///< name and version, as reported by the driver
  std::string api_version;                 ///< Vulkan version, "1.3.230"
  std::uint64_t memory_bytes = 0;          ///< size of the largest device-local heap
  std::uint64_t max_allocation_bytes = 0;  ///< maximum size of one buffer
  std::uint64_t max_storage_range =
      0;  ///< maximum bytes of one storage buffer binding; access by address is not limited by it
  std::uint32_t max_workgroup_invocations = 0;
  std::uint32_t shared_memory_bytes = 0;
  std::uint32_t subgroup_size = 0;
  DeviceAbilities abilities;
  std::string missing;  ///< missing_ability(); empty if usable

  bool usable() const { return missing.empty(); }
};

/// All devices in the loader's order. If there are none, `why_none` says whether the loader or a driver is missing.
struct DeviceList {
  std::vector<DeviceDescription> devices;
  std::string why_none;
};
DeviceList list_devices();

/// Selection and settings of a device.
struct DeviceSettings {
  /// "auto": the first usable device in the order discrete, integrated, virtual GPU, CPU, other. "gpu": the same,
  /// except CPU and other. "cpu": a CPU device. Otherwise the first device whose name contains the text, ignoring case.
  std::string choice = "auto";
  bool validation =
      false;  ///< enables the Khronos validation layer with synchronisation validation and collects its messages
  /// Time limit of one run of commands, in seconds, > 0; a device that exceeds it is given up and runs nothing more.
  /// nullopt: 60 s, 600 s on CPU devices.
  std::optional<double> timeout_s = {};
  /// Whether compiled pipelines are kept in the user's cache folder, for later processes (doc/user/devices.md).
  bool keep_pipelines = true;
};

/// Returns the index of the chosen device. Throws Error if none matches (listing all), or if those that match lack a
/// feature.
std::size_t choose_device(const std::vector<DeviceDescription>& devices, const std::string& choice);

/// An open device. Copies are cheap and share it.
class Device {
 public:
  /// Throws Error if there is no loader, no device, no match for the choice or no validation layer, or if a feature is
  /// missing.
  explicit Device(const DeviceSettings& settings = {});

  const DeviceDescription& description() const;
  /// Returns the validation layer's messages so far; empty without `validation`.
  std::vector<std::string> validation_messages() const;

  struct Impl;  // raii.h
  const std::shared_ptr<Impl>& impl() const { return impl_; }

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace scarp
