// SPDX-License-Identifier: MIT
// Private to the station: compiled pipelines of a device, kept in a file of the user's cache folder.
//
//   pipelines-VENDOR-DEVICE-DRIVER-UUID.bin:  magic, checksum, then the driver's data (VkPipelineCache)
//
// The file is only a cache: it is ignored if it cannot be read, is damaged, or belongs to another device or driver. A
// folder that is not writable is also ignored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scarp {

/// Identifies a device and its driver, as in the header of the driver's data.
struct PipelineCacheKey {
  std::uint32_t vendor = 0, device = 0, driver = 0;
  std::array<std::uint8_t, 16> uuid{};
};

/// Returns $XDG_CACHE_HOME/scarp, or ~/.cache/scarp if XDG_CACHE_HOME is not an absolute path. Empty if neither is
/// available.
std::string user_cache_folder();

/// Returns the name of the file, without its folder.
std::string pipeline_cache_name(const PipelineCacheKey& key);

/// Returns the data in a file. Empty if there is none for `key`, or if the file is larger than kMostPipelineBytes: the
/// next write then replaces it.
std::vector<std::byte> read_pipeline_cache(const std::string& path, const PipelineCacheKey& key) noexcept;

/// Writes a file atomically; creates its folder if needed. Returns whether it succeeded.
bool write_pipeline_cache(const std::string& path, std::span<const std::byte> data) noexcept;

constexpr std::size_t kMostPipelineBytes = 64 << 20;

}  // namespace scarp
