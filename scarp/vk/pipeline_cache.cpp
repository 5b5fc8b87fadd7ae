// SPDX-License-Identifier: MIT
#include "scarp/vk/pipeline_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>

#include "scarp/base/replace_file.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

// Precedes the driver's data in the file.
struct FileHead {
  std::array<char, 8> magic;
  std::uint64_t checksum;  // checksum of the data
};
constexpr std::array<char, 8> kMagic = {'s', 'c', 'a', 'r', 'p', 'p', 'c', '1'};

// Start of the driver's data (VkPipelineCacheHeaderVersionOne).
struct DataHead {
  std::uint32_t bytes, version, vendor, device;
  std::array<std::uint8_t, 16> uuid;
};

// FNV-1a (Fowler, Noll, Vo). It detects only accidental damage, which matters because drivers trust their data.
std::uint64_t checksum_of(std::span<const std::byte> data) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::byte byte : data) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3;
  return hash;
}

bool belongs_to(std::span<const std::byte> data, const PipelineCacheKey& key) {
  if (data.size() < sizeof(DataHead)) return false;
  DataHead head;
  std::memcpy(&head, data.data(), sizeof head);
  return head.bytes >= sizeof head && head.bytes <= data.size() && head.version == 1 && head.vendor == key.vendor &&
         head.device == key.device && head.uuid == key.uuid;
}

}  // namespace

std::string user_cache_folder() {
  if (const char* caches = std::getenv("XDG_CACHE_HOME"); caches && caches[0] == '/')
    return std::string(caches) + "/scarp";
  if (const char* home = std::getenv("HOME"); home && home[0] == '/') return std::string(home) + "/.cache/scarp";
  return {};
}

std::string pipeline_cache_name(const PipelineCacheKey& key) {
  std::string uuid;
  for (const std::uint8_t byte : key.uuid) uuid += fmt::format("{:02x}", byte);
  return fmt::format("pipelines-{:x}-{:x}-{:x}-{}.bin", key.vendor, key.device, key.driver, uuid);
}

std::vector<std::byte> read_pipeline_cache(const std::string& path, const PipelineCacheKey& key) noexcept {
  try {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path, error);
    if (error || bytes < sizeof(FileHead) || bytes > sizeof(FileHead) + kMostPipelineBytes) return {};
    std::ifstream file(path, std::ios::binary);
    FileHead head{};
    std::vector<std::byte> data(bytes - sizeof head);
    file.read(reinterpret_cast<char*>(&head), sizeof head);
    file.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(data.size()));
    if (!file || head.magic != kMagic || head.checksum != checksum_of(data) || !belongs_to(data, key)) return {};
    return data;
  } catch (const std::exception&) {
    return {};
  }
}

bool write_pipeline_cache(const std::string& path, std::span<const std::byte> data) noexcept {
  try {
    const fs::path folder = fs::path(path).parent_path();
    // Accessible to the user only, as the XDG Base Directory Specification requires.
    if (fs::create_directories(folder)) fs::permissions(folder, fs::perms::owner_all);
    ReplaceFile file(path);
    const FileHead head{kMagic, checksum_of(data)};
    std::ofstream out(file.temporary_path(), std::ios::binary);
    out.write(reinterpret_cast<const char*>(&head), sizeof head);
    out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
    out.close();
    if (!out) return false;
    file.commit();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace scarp
