// SPDX-License-Identifier: MIT
// Message texts for missing and truncated files.
#pragma once

#include <fmt/format.h>

#include <string_view>

#include "scarp/base/error.h"

namespace scarp {

/// Advice for files that are truncated or damaged.
inline constexpr std::string_view kFetchAgain = "fetch or copy it again";

/// First bytes of a Git LFS pointer.
inline constexpr std::string_view kLfsPointer = "version https://git-lfs";

/// Message for a Git LFS pointer.
inline constexpr const char* kLfsAdvice = "Git LFS pointer instead of the file (fetch it with: git lfs pull)";

/// Throws Error (without the file's name) if a file that starts with `start` is a Git LFS pointer.
inline void refuse_lfs_pointer(std::string_view start) {
  if (start.starts_with(kLfsPointer)) throw Error(kLfsAdvice);
}

/// Calls work(). Appends this advice to its errors that do not end with words in parentheses.
template <class Work>
auto advising(std::string_view advice, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string_view text = error.what();
    if (text.ends_with(')')) throw;
    throw Error(fmt::format("{} ({})", text, advice));
  }
}

}  // namespace scarp
