// SPDX-License-Identifier: MIT
// Private to the station: compiled pipelines of a device, kept in a file of the user's cache folder.
//
//   pipelines-VENDOR-DEVICE-DRIVER-UUID.bin:  magic, checksum, then the driver's data (VkPipelineCache)
//
// The file is only a cache: it is ignored if it cannot be read, is damaged, or belongs to another device or driver, as
// is a folder that cannot be written.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scarp {

/// A device and its driver, as in the header of the driver's data.
struct PipelineCacheKey {
  std::uint32_t vendor = 0, device = 0, driver = 0;
  std::array<std::uint8_t, 16> uuid{};
};

/// Returns $XDG_CACHE_HOME/scarp, or ~/.cache/scarp if that is not set to an absolute path. Empty if there is neither.
std::string user_cache_folder();

/// Returns the name of the file, without its folder.
std::string pipeline_cache_name(const PipelineCacheKey& key);

/// Returns the data in a file. Empty if there is none for `key`, or it is larger than kMostPipelineBytes: the next
/// write replaces it.
std::vector<std::byte> read_pipeline_cache(const std::string& path, const PipelineCacheKey& key) noexcept;

/// Writes a file atomically; makes its folder if needed. Returns whether it could.
bool write_pipeline_cache(const std::string& path, std::span<const std::byte> data) noexcept;

constexpr std::size_t kMostPipelineBytes = 64 << 20;

}  // namespace scarp
