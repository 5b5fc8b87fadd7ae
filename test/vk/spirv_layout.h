// SPDX-License-Identifier: MIT
// The layout of a shader's structs, read from its SPIR-V.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "test/vk/spirv_operations.h"

namespace scarp::test {

using Offsets = std::vector<std::uint32_t>;

/// Adds the offset of a member, under the id of its struct, if this operation (spirv_operations.h) decorates a member
/// with its offset.
inline void add_offset(std::uint32_t code, std::span<const std::uint32_t> words,
                       std::map<std::uint32_t, Offsets>& structs) {
  if (code != spirv_op::kMemberDecorate || words[3] != spirv_decoration::kOffset) return;
  Offsets& offsets = structs[words[1]];
  offsets.resize(std::max<std::size_t>(offsets.size(), words[2] + 1));
  offsets[words[2]] = words[4];
}

/// The offsets of the members of each struct, in member order; names do not survive optimisation.
inline std::vector<Offsets> struct_offsets(std::span<const std::uint32_t> spirv) {
  std::map<std::uint32_t, Offsets> structs;
  each_operation(spirv,
                 [&](std::uint32_t code, std::span<const std::uint32_t> words) { add_offset(code, words, structs); });
  std::vector<Offsets> all;
  for (const auto& [type, offsets] : structs) all.push_back(offsets);
  return all;
}

/// Whether arrays of the shader have elements of this many bytes.
inline bool has_array_stride(std::span<const std::uint32_t> spirv, std::uint32_t stride) {
  bool found = false;
  each_operation(spirv, [&](std::uint32_t code, std::span<const std::uint32_t> words) {
    found |= code == spirv_op::kDecorate && words[2] == spirv_decoration::kArrayStride && words[3] == stride;
  });
  return found;
}

inline bool has_struct(std::span<const std::uint32_t> spirv, const Offsets& offsets) {
  const auto structs = struct_offsets(spirv);
  return std::find(structs.begin(), structs.end(), offsets) != structs.end();
}

/// Whether C++ and the shader, which share the source of T, lay it out alike. Both put its members in source order and
/// without gaps: C++ because no member is aligned to more than its four bytes or smaller than that; the shader if all
/// its structs are found to be so, and one of them has the size of T.
template <class T>
bool is_laid_out_like(std::span<const std::uint32_t> spirv) {
  static_assert(alignof(T) == 4 && sizeof(T) % 4 == 0);
  std::map<std::uint32_t, Offsets> offsets;
  std::map<std::uint32_t, std::uint32_t> bytes, constants;
  std::vector<std::uint32_t> structs;
  bool gaps = false;
  // Decorations come before types, and types before those that have them.
  each_operation(spirv, [&](std::uint32_t code, std::span<const std::uint32_t> words) {
    using namespace spirv_op;
    add_offset(code, words, offsets);
    if (code == kTypeInt || code == kTypeFloat) {
      bytes[words[1]] = words[2] / 8;
    } else if (code == kTypeVector) {
      bytes[words[1]] = bytes[words[2]] * words[3];
    } else if (code == kConstant) {
      constants[words[2]] = words[3];
    } else if (code == kTypeArray) {
      bytes[words[1]] = bytes[words[2]] * constants[words[3]];
    } else if (code == kTypeRuntimeArray) {
      bytes[words[1]] = 0;
    } else if (code == kTypeStruct && offsets.contains(words[1])) {
      std::uint32_t size = 0;
      for (std::size_t member = 0; member + 2 < words.size(); ++member) {
        gaps |= offsets[words[1]][member] != size;
        size += bytes[words[2 + member]];
      }
      bytes[words[1]] = size;
      structs.push_back(size);
    }
  });
  return !gaps && std::find(structs.begin(), structs.end(), sizeof(T)) != structs.end();
}

}  // namespace scarp::test
