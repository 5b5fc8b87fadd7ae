// SPDX-License-Identifier: MIT
// The operations of a shader, read from its SPIR-V.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace scarp::test {

/// Codes of operations and decorations that tests look for, numbered as in the SPIR-V specification.
namespace spirv_op {
constexpr std::uint32_t kTypeInt = 21, kTypeFloat = 22, kTypeVector = 23, kTypeArray = 28, kTypeRuntimeArray = 29,
                        kTypeStruct = 30, kTypePointer = 32, kConstant = 43, kLoad = 61, kAccessChain = 65,
                        kInBoundsAccessChain = 66, kDecorate = 71, kMemberDecorate = 72, kLoopMerge = 246, kLabel = 248;
}  // namespace spirv_op
namespace spirv_decoration {
constexpr std::uint32_t kArrayStride = 6, kOffset = 35;
}  // namespace spirv_decoration

/// Calls `call(code, words)` for each operation, in order. words[0] holds the code and the number of words.
template <class Call>
void each_operation(std::span<const std::uint32_t> spirv, const Call& call) {
  constexpr std::size_t kHeaderWords = 5;
  for (std::size_t at = kHeaderWords; at < spirv.size();) {
    const std::uint32_t code = spirv[at] & 0xffff;
    const std::size_t words = spirv[at] >> 16;
    call(code, spirv.subspan(at, words));
    at += words;
  }
}

}  // namespace scarp::test
