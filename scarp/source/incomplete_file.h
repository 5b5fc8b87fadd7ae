// SPDX-License-Identifier: MIT
// What is said of files that did not arrive, or not whole.
#pragma once

#include <string_view>

#include "scarp/base/error.h"

namespace scarp {

/// The end of messages about files that are cut off or damaged.
inline constexpr std::string_view kFetchAgain = "fetch or copy it again";

/// Bytes from a file's start that tell a Git LFS pointer.
inline constexpr std::string_view kLfsPointer = "version https://git-lfs";

/// What is said of one.
inline constexpr const char* kLfsAdvice = "is a Git LFS pointer, not the file itself; fetch it with: git lfs pull";

/// Throws Error (without the file's name) when a file that begins with `start` is a Git LFS pointer.
inline void refuse_lfs_pointer(std::string_view start) {
  if (start.starts_with(kLfsPointer)) throw Error(kLfsAdvice);
}

}  // namespace scarp
