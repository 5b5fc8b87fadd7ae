// SPDX-License-Identifier: MIT
// The layout of a shader's structs, read from its SPIR-V.
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

/// Whether arrays of the shader have elements of this many bytes.
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

/// Whether C++ and the shader lay out T, whose text they share, alike. Both put its members in the order of the text
/// and without gaps: C++ because no member is aligned to more than its four bytes or smaller than that; the shader if
/// this finds its structs so, and one of T's size among them.
template <class T>
bool is_laid_out_like(std::span<const std::uint32_t> spirv) {
  static_assert(alignof(T) == 4 && sizeof(T) % 4 == 0);
  constexpr std::uint32_t kTypeInt = 21, kTypeFloat = 22, kTypeVector = 23, kTypeArray = 28, kTypeRuntimeArray = 29,
                          kTypeStruct = 30, kConstant = 43, kMemberDecorate = 72, kOffset = 35, kHeaderWords = 5;
  std::map<std::uint32_t, Offsets> offsets;
  std::map<std::uint32_t, std::uint32_t> bytes, constants;
  std::vector<std::uint32_t> structs;
  bool gaps = false;
  // Decorations come before types, and types before those that have them.
  for (std::size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const std::uint32_t *word = &spirv[at], operation = word[0] & 0xffff, words = word[0] >> 16;
    if (operation == kMemberDecorate && word[3] == kOffset) {
      Offsets& of = offsets[word[1]];
      of.resize(std::max<std::size_t>(of.size(), word[2] + 1));
      of[word[2]] = word[4];
    } else if (operation == kTypeInt || operation == kTypeFloat) {
      bytes[word[1]] = word[2] / 8;
    } else if (operation == kTypeVector) {
      bytes[word[1]] = bytes[word[2]] * word[3];
    } else if (operation == kConstant) {
      constants[word[2]] = word[3];
    } else if (operation == kTypeArray) {
      bytes[word[1]] = bytes[word[2]] * constants[word[3]];
    } else if (operation == kTypeRuntimeArray) {
      bytes[word[1]] = 0;
    } else if (operation == kTypeStruct && offsets.contains(word[1])) {
      std::uint32_t size = 0;
      for (std::uint32_t member = 0; member + 2 < words; ++member) {
        gaps |= offsets[word[1]][member] != size;
        size += bytes[word[2 + member]];
      }
      bytes[word[1]] = size;
      structs.push_back(size);
    }
  }
  return !gaps && std::find(structs.begin(), structs.end(), sizeof(T)) != structs.end();
}

}  // namespace scarp::test
