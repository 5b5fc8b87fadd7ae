// SPDX-License-Identifier: MIT
#include "scarp/source/raster/zip_archive.h"

#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <string_view>

#include "scarp/source/raster/file_check.h"
#include "scarp/source/raster/raw_band.h"

namespace scarp {
namespace {

constexpr std::string_view kMemberMark = "PK\3\4", kEndMark = "PK\5\6";
// The end record has 22 bytes and a comment of up to 65,535.
constexpr std::uint64_t kMostEndBytes = 22 + 65535;

}  // namespace

bool is_zip(const std::string& path) {
  const std::string start = bytes_from(path, 0, kMemberMark.size());
  return start == kMemberMark || start == kEndMark;
}

bool has_zip_end(const std::string& path) {
  const auto size = static_cast<std::uint64_t>(file_bytes(path));
  const std::string end = bytes_from(path, size - std::min(size, kMostEndBytes), kMostEndBytes);
  return end.find(kEndMark) != std::string::npos;
}

std::string zip_folder(const std::string& path) { return "/vsizip/{" + full_path(path) + "}"; }

std::vector<std::string> zip_members(const std::string& path) {
  const CPLStringList entries(VSIReadDirRecursive(zip_folder(path).c_str()));
  std::vector<std::string> members;
  for (int i = 0; i < entries.size(); ++i) {
    const std::string member = entries[i];
    if (!member.ends_with('/')) members.push_back(member);
  }
  return members;
}

}  // namespace scarp
