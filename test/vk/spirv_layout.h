// SPDX-License-Identifier: MIT
// How a shader lays out its structs, read from its SPIR-V.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace scarp::test {

using Offsets = std::vector<std::uint32_t>;

/// The offsets of the members of each struct, in their order; names do not survive optimisation.
inline std::vector<Offsets> struct_offsets(std::span<const std::uint32_t> spirv) {
  constexpr std::uint32_t kOpMemberDecorate = 72, kOffset = 35, kHeaderWords = 5;
  std::map<std::uint32_t, Offsets> structs;
  for (std::size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const std::uint32_t *word = &spirv[at], operation = word[0] & 0xffff;
    if (operation != kOpMemberDecorate || word[3] != kOffset) continue;
    Offsets& offsets = structs[word[1]];
    offsets.resize(std::max<std::size_t>(offsets.size(), word[2] + 1));
    offsets[word[2]] = word[4];
  }
  std::vector<Offsets> all;
  for (const auto& [type, offsets] : structs) all.push_back(offsets);
  return all;
}

/// Whether arrays of the shader have elements of so many bytes.
inline bool has_array_stride(std::span<const std::uint32_t> spirv, std::uint32_t stride) {
  constexpr std::uint32_t kOpDecorate = 71, kArrayStride = 6, kHeaderWords = 5;
  for (std::size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const std::uint32_t* word = &spirv[at];
    if ((word[0] & 0xffff) == kOpDecorate && word[2] == kArrayStride && word[3] == stride) return true;
  }
  return false;
}

inline bool has_struct(std::span<const std::uint32_t> spirv, const Offsets& offsets) {
  const auto structs = struct_offsets(spirv);
  return std::find(structs.begin(), structs.end(), offsets) != structs.end();
}

}  // namespace scarp::test
